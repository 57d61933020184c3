"""Run the model with a gesture (docs/simulate.md), by the kernel that plays; keep all signals."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_server.compile.machine_code import SIMULATING
from yehu_server.core.physics import kernel, layout, planes, time_loop
from yehu_server.core.physics.bow import friction_bound
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.layout import GHOST, LEDGER, STRINGS
from yehu_server.core.physics.modal_string import largest_compliance, modal_shape, pull_modal
from yehu_server.core.physics.pluck import pluck_string, pull_string
from yehu_server.errors import OutputError
from yehu_server.scores.gesture import CONTROLS, Gesture, Pluck
from yehu_server.simulation.labels import as_data, as_json, dimensions, hash_of, label_of
from yehu_server.util import __version__
from yehu_server.util.hints import require_package
from yehu_server.util.npz_file import read_npz, writing_npz

if TYPE_CHECKING:
    import xarray

Floats = np.ndarray[Any, np.dtype[np.float64]]

MAX_BYTES = 8 * 2**30
# What is called, but for what playing calls, by the file that its machine code is kept in.
COMPILED = {
    SIMULATING: (
        time_loop.advance_refined,
        time_loop.advance_in_two_directions,
        time_loop.advance_modal,
        time_loop.advance_with_ledger,
    )
}
CHUNK = 1 << 14  # frames between two progress reports


@dataclass(frozen=True)
class Simulation:
    """The signals of one run, and what it was.

    Attributes
    ----------
    arrays : mapping of ndarray
        By name, with a value for each sample; docs/simulate.md lists them.
    meta : mapping
        The gesture, all quantities of the instrument, the version, the sample rate, the grid, and
        counts of what went wrong.
    """

    arrays: Mapping[str, Floats]
    meta: Mapping[str, Any]

    def __repr__(self) -> str:
        seconds = self.meta["frames"] / self.meta["sample_rate"]
        rate = self.meta["sample_rate"]
        return (
            f"<yehu_server.Simulation of {seconds:g} s at {rate:g} Hz, {len(self.arrays)} arrays>"
        )

    def to_xarray(self) -> xarray.Dataset:
        """Everything as a data set with units, coordinates, and where it came from.

        Its attributes are text and numbers, so that any format holds them: the version, all
        quantities of the instrument and the gesture as JSON, the rate, and the hash of the values.

        Raises
        ------
        ParameterError
            Where xarray is missing.

        Examples
        --------
        >>> import yehu_server as yehu
        >>> controls = {"bow_force": 0.7, "bow_velocity": 0.3}
        >>> data = yehu.simulate({"duration": 0.1, "controls": controls}).to_xarray()
        >>> data.bridge_force.attrs["units"], data.sel(time=0.05, method="nearest").sizes
        ('N', Frozen({'string': 2}))
        """
        require_package("xarray", "to_xarray", "lab")
        import xarray

        found = {
            name: (dimensions(name, values), values, label_of(name).attributes)
            for name, values in self.arrays.items()
        }
        coordinates = {name: each for name, each in found.items() if each[0] == (name,)}
        sizes = {
            name: n
            for dims, values, _ in found.values()
            for name, n in zip(dims, values.shape, strict=True)
        }
        coordinates |= {
            name: ((name,), np.arange(1, sizes[name] + 1), {})
            for name in ("finger", "string")
            if name in sizes
        }
        metadata = dict(self.meta)
        version = metadata.pop("version", __version__)
        plain = {
            name: value if isinstance(value, str | int | float) else as_json(value)
            for name, value in metadata.items()
        }
        source = {"source": f"yehu-server {version}", "sha256": hash_of(self.arrays)}
        others = {name: each for name, each in found.items() if name not in coordinates}
        return xarray.Dataset(others, coords=coordinates, attrs=source | plain)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Simulation:
        """Read a file that `save`, or the command, wrote.

        Raises
        ------
        ScoreError
            Where it cannot be read, or is none.
        """
        return read_npz(Path(path), cls._of, "the result of a simulation")

    @classmethod
    def _of(cls, arrays: dict[str, Floats]) -> Simulation:
        meta = json.loads(str(arrays.pop("meta")))
        if len(arrays["time"]) != meta["frames"] or not meta["sample_rate"] > 0.0:
            raise ValueError("something is missing")
        return cls(arrays, meta)

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write an uncompressed ``.npz``; ``meta`` is JSON text within it.

        Parameters
        ----------
        overwrite : bool
            Replace a file that is there.

        Raises
        ------
        OutputError
            Where it cannot be written.
        """
        with writing_npz(Path(path), overwrite=overwrite) as file:
            np.savez(file, allow_pickle=False, meta=np.array(json.dumps(self.meta)), **self.arrays)


def simulate(
    gesture: Gesture,
    *,
    energy: bool = False,
    strings_every: int = 0,
    progress: Callable[[float, float], None] | None = None,
) -> Simulation:
    """Run the model with a gesture; see `api.simulated.simulate`.

    Raises ParameterError where the quantities make no stable model at this rate; OutputError where
    the arrays would take more than MAX_BYTES.
    """
    fingers = gesture.fingers
    model = kernel.prepare(gesture.quantities, gesture.sample_rate, fingers)
    more = planes.prepare(gesture.quantities, gesture.sample_rate)
    m = model[0]
    frames = gesture.frames
    columns = layout.probe_columns(fingers) + layout.control_columns(fingers)
    columns += len(LEDGER) * energy
    shapes = (frames // strings_every) * int(m["N"].sum() + STRINGS) if strings_every else 0
    if 8 * (frames * columns + shapes) > MAX_BYTES:
        raise OutputError(
            f"{frames} samples would take more than {MAX_BYTES >> 30} GiB: "
            "shorten the gesture or keep the strings less often"
        )
    state = kernel.at_rest(model)
    if gesture.pluck is not None:
        pull(model, state, more, gesture.pluck)

    controls = gesture.control_rows()
    probes = np.zeros((frames, layout.probe_columns(fingers)))
    ledger = np.zeros((frames if energy else 0, len(LEDGER)))
    shaped: list[list[Floats]] = [[], []]
    kind = time_loop.kind_of(more)
    has_two = kind == time_loop.IN_TWO_DIRECTIONS
    shaped_normal: list[list[Floats]] = [[], []]
    hop = strings_every or CHUNK
    for start in range(0, frames, hop):
        if strings_every:
            for i in range(STRINGS):
                level = int(state["motion"]["level"][0])
                if kind == time_loop.IS_MODAL:
                    shaped[i].append(modal_shape(more[0], more[0]["a"][level], i, int(m["N"][i])))
                    continue
                shaped[i].append(shape_of(m, state["motion"][0], i))
                if has_two:
                    shaped_normal[i].append(nodes_of(m, more[0]["normal"]["u"][level], i))
        part = slice(start, min(start + hop, frames))
        kept = ledger[part] if energy else None
        time_loop.run(model, state, more, controls[part], probes[part], kept)
        if progress is not None:
            progress(part.stop / gesture.sample_rate, gesture.duration)

    arrays = signals(probes, controls, gesture.sample_rate)
    if energy:
        arrays |= {name: ledger[:, column] for column, name in enumerate(LEDGER)}
    if strings_every:
        arrays |= shapes_of(shaped, m, gesture.quantities, arrays["time"][::strings_every])
        if has_two:
            arrays |= {f"string_{i + 1}_normal": np.array(shaped_normal[i]) for i in range(STRINGS)}
    asked = {"gesture": dict(gesture.source), "seed": int(gesture.quantities.bow.hair)}
    own = None if more is None else more[0]["refined"] if "refined" in more.dtype.names else more[0]
    facts = metadata_of(m, state[0], frames, gesture.quantities, own)
    if kind == time_loop.IS_MODAL:
        facts["friction_bound"] = friction_bound(m, own, largest_compliance(more[0]))
    return Simulation(arrays, asked | facts)


def pull(model: Any, state: Any, more: Any, pluck: Pluck) -> None:
    """Pull a string of an instrument at rest into a triangle, to be let go."""
    i, turn = pluck.string - 1, math.radians(pluck.angle)
    if time_loop.kind_of(more) == time_loop.IS_MODAL:
        x_c = float(model[0]["bridge_x"])
        pull_modal(more[0], x_c, i, pluck.position, pluck.amplitude)
        return
    pluck_string(model, state, i, pluck.position, pluck.amplitude * math.cos(turn))
    if pluck.angle != 0.0:
        normal = pluck.amplitude * math.sin(turn)
        pull_string(model[0], more[0]["normal"], i, pluck.position, normal)


def shapes_of(
    kept: list[list[Floats]], m: Any, quantities: Quantities, time: Floats
) -> dict[str, Floats]:
    """The arrays of both strings, whose shapes (see `shape_of`) were kept at some times (s)."""
    found = {"strings_time": time}
    for i, string in enumerate(quantities.strings):
        found[f"string_{i + 1}"] = np.array(kept[i])
        found[f"x_{i + 1}"] = np.linspace(0.0, string.L, int(m["N"][i]) + 1)
    return found


def signals(probes: Floats, controls: Floats, sample_rate: float) -> dict[str, Floats]:
    """Name the columns of what the kernel gave and was given.

    Of probes and controls [shape=(frames, columns)] as ``physics.layout`` has them, with one finger
    or more: arrays by name, their first axis frames. With more than one finger, those of fingers
    have one axis more.
    """
    fingers = (controls.shape[1] - layout.FINGER_CONTROLS) // layout.CONTROLS_PER_FINGER
    shape = (len(probes), fingers, layout.PROBES_PER_FINGER)
    touch = probes[:, layout.FINGER_PROBES :].reshape(shape)
    hands = controls[:, layout.FINGER_CONTROLS :].reshape(len(controls), fingers, -1)
    if fingers == 1:
        touch, hands = touch[:, 0], hands[:, 0]
    arrays: dict[str, Floats] = {
        "time": np.arange(len(probes)) / sample_rate,
        "bridge_force": probes[:, layout.BRIDGE_FORCE],
        "bridge_force_1": probes[:, layout.BRIDGE_FORCE_1],
        "bridge_force_2": probes[:, layout.BRIDGE_FORCE_2],
        "bridge_velocity": probes[:, layout.BRIDGE_VELOCITY],
        "pressure": probes[:, layout.PRESSURE],
        "finger_displacement": touch[..., 0],
        "contact_force": touch[..., 1:],
        "friction_force": probes[:, layout.FRICTION_FORCE],
        "relative_velocity": probes[:, layout.RELATIVE_VELOCITY],
        "iterations": probes[:, layout.ITERATIONS].astype(np.int64),
    }
    for name, control in CONTROLS.items():
        place = control.column - layout.FINGER_CONTROLS
        arrays[name] = controls[:, control.column] if place < 0 else hands[..., place]
    return arrays


def metadata_of(
    m: Any, state: Any, frames: int, quantities: Quantities, more: Any = None
) -> dict[str, Any]:
    """The metadata of a run, of its model (MODEL, REFINED) and its state (STATE) at the end."""
    return {
        "version": __version__,
        "instrument": as_data(quantities),
        "sample_rate": float(m["rate"]),
        "frames": frames,
        "grid_intervals": [int(N) for N in m["N"]],
        "grid_spacing_m": [float(h) for h in m["h"]],
        "bridge_x_m": float(m["bridge_x"]),
        "friction_bound": friction_bound(m, more),
        "unconverged_solves": int(state["unconverged"]),
        "lost_states": int(state["lost"]),
    }


def faults_of(meta: Mapping[str, Any]) -> str:
    """What went wrong in a run, by its metadata; empty where nothing did."""
    unconverged, lost = meta["unconverged_solves"], meta["lost_states"]
    return f"{unconverged} unconverged solves, {lost} lost states" if unconverged or lost else ""


def shape_of(m: Any, motion: Any, string: int) -> Floats:
    """Displacement (m) of the nodes of string 0 or 1 now, from its end at the loop.

    `m` and `motion` are records of ``layout.MODEL`` and ``layout.MOTION``.
    """
    return nodes_of(m, motion["u"][int(motion["level"])], string)


def nodes_of(m: Any, u: Floats, string: int) -> Floats:
    """Displacement (m) of the nodes of string 0 or 1, from those of both [shape=(2, points)]."""
    return u[string, GHOST : GHOST + int(m["N"][string]) + 1].copy()
