"""Gestures in physical units, straight into the model: for whoever studies it.

A gesture file (docs/simulate.md) gives bow and finger as piecewise linear curves in SI
units; `simulate` runs the same kernel that plays notes and keeps every signal.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server import __version__
from yehu_server.errors import OutputError, ParameterError, ScoreError
from yehu_server.files import read_text, replacing
from yehu_server.physics import kernel, layout
from yehu_server.physics.bow import friction_bound
from yehu_server.physics.energy import stored_energy
from yehu_server.physics.grid import check_rate
from yehu_server.physics.layout import GHOST, LEDGER, STRINGS
from yehu_server.physics.quantities import Quantities, override
from yehu_server.physics.stencil import read
from yehu_server.physics.string import support

Floats = np.ndarray[Any, np.dtype[np.float64]]
Curve = tuple[tuple[float, float], ...]

MAX_DURATION_S = 3600.0
MAX_BYTES = 8 * 2**30
CHUNK = 1 << 14  # frames between two progress reports


@dataclass(frozen=True)
class Control:
    """One control of a gesture: its column, bounds, and value when not given."""

    column: int
    lo: float
    hi: float
    default: float
    unit: str


CONTROLS = {
    "bow_force": Control(layout.F_N, -50.0, 50.0, 0.0, "N"),
    "bow_velocity": Control(layout.V_B, -10.0, 10.0, 0.0, "m/s"),
    "bow_position": Control(layout.X_B, 0.0, 1.0, 0.255, "m"),
    "finger_position": Control(layout.FINGER_CONTROLS, 0.0, 1.0, 0.1, "m"),
    "press_force": Control(layout.FINGER_CONTROLS + 1, 0.0, 100.0, 0.0, "N"),
}
HAMMER_LIMIT = 1e4  # N


@dataclass(frozen=True)
class Pluck:
    """A string let go from a triangle: string 1 or 2, position and amplitude in metres."""

    string: int
    position: float
    amplitude: float


@dataclass(frozen=True)
class Gesture:
    """What a gesture file says. Curves are ((time in s, value), ...), linear between."""

    sample_rate: float = 44100.0
    duration: float = 1.0
    quantities: Quantities = field(default_factory=Quantities)
    controls: Mapping[str, Curve] = field(default_factory=dict)
    pluck: Pluck | None = None
    hammer: Curve = ()

    @property
    def frames(self) -> int:
        """Number of samples."""
        return round(self.duration * self.sample_rate)

    def control_rows(self) -> Floats:
        """The kernel's control array [shape=(frames, control columns)]."""
        time = np.arange(self.frames) / self.sample_rate
        rows = np.zeros((self.frames, layout.control_columns(fingers=1)))
        for name, control in CONTROLS.items():
            curve = self.controls.get(name, ((0.0, control.default),))
            times, values = zip(*curve, strict=True)
            rows[:, control.column] = np.interp(time, times, values)
        if self.hammer:
            times, forces = zip(*self.hammer, strict=True)
            rows[:, layout.F_HAMMER] = np.interp(time, times, forces, left=0.0, right=0.0)
        return rows


def read_gesture(path: Path) -> Gesture:
    """Read a gesture file.

    Errors: ScoreError or ParameterError, naming the file and what is wrong in it.
    """
    try:
        text = read_text(path)
    except OSError as error:
        raise ScoreError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ScoreError(f"{path}: not a gesture file (not text)") from error
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ScoreError(f"{path}: not a gesture file ({error})") from error
    try:
        return gesture_from(data)
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error


def gesture_from(data: Any) -> Gesture:
    """Build a gesture from the nested names and values of a gesture file.

    Errors: ParameterError.
    """
    known = ("sample_rate", "duration", "instrument", "controls", "pluck", "hammer")
    data = _names(data, "gesture", known)
    rate = _number(data.get("sample_rate", 44100.0), "sample_rate")
    check_rate(rate)
    duration = _number(data.get("duration", 1.0), "duration")
    if not 1.0 / rate <= duration <= MAX_DURATION_S:
        raise ParameterError(f"duration: {duration} s is not within one sample to 1 hour")
    quantities = override(Quantities(), data.get("instrument", {}))
    curves = {
        name: _curve(value, name, CONTROLS[name].lo, CONTROLS[name].hi, CONTROLS[name].unit)
        for name, value in _names(data.get("controls", {}), "controls", tuple(CONTROLS)).items()
    }
    shortest = min(string.L for string in quantities.strings)
    ends = (("bow_position", quantities.bridge_x, "bridge"), ("finger_position", shortest, "stub"))
    for name, end, what in ends:
        _stays_within(curves.get(name, ((0.0, CONTROLS[name].default),)), name, end, what)
    pluck = None
    if data.get("pluck") is not None:
        fields = _names(data["pluck"], "pluck", ("string", "position", "amplitude"))
        pluck = Pluck(
            string=int(_number(fields.get("string", 1), "pluck.string")),
            position=_number(fields.get("position", 0.1), "pluck.position"),
            amplitude=_number(fields.get("amplitude", 0.001), "pluck.amplitude"),
        )
        if fields.get("string", 1) not in (1, 2):
            raise ParameterError(f"pluck.string: 1 or 2, not {fields['string']!r}")
        if not 0.0 < pluck.position < shortest or pluck.position == quantities.bridge_x:
            raise ParameterError(f"pluck.position: {pluck.position} m is not on the free string")
        if not abs(pluck.amplitude) <= 0.1:
            raise ParameterError(f"pluck.amplitude: {pluck.amplitude} m is beyond 0.1 m")
    hammer: Curve = ()
    if data.get("hammer") is not None:
        hammer = _curve(data["hammer"], "hammer", -HAMMER_LIMIT, HAMMER_LIMIT, "N")
    return Gesture(rate, duration, quantities, curves, pluck, hammer)


def _names(value: Any, where: str, known: tuple[str, ...]) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise ParameterError(f"{where}: expected names and values in braces")
    for name in value:
        if name not in known:
            raise ParameterError(f"{where}: unknown name {name!r} (known: {', '.join(known)})")
    return value


def _number(value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ParameterError(f"{where}: expected a number, got {value!r}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ParameterError(f"{where}: {value} is not finite")
    return number


def _curve(value: Any, where: str, lo: float, hi: float, unit: str) -> Curve:
    if isinstance(value, int | float) and not isinstance(value, bool):
        value = [[0.0, value]]
    if not isinstance(value, list) or not value:
        raise ParameterError(f"{where}: expected a list of [time, value] pairs")
    points = []
    last = -math.inf
    for point in value:
        if not isinstance(point, list) or len(point) != 2:
            raise ParameterError(f"{where}: expected [time, value], got {point!r}")
        time, level = _number(point[0], where), _number(point[1], where)
        if time < last:
            raise ParameterError(f"{where}: times must not go back ({time} s after {last} s)")
        if not lo <= level <= hi:
            raise ParameterError(f"{where}: {level} is not within {lo:g} to {hi:g} {unit}")
        points.append((time, level))
        last = time
    return tuple(points)


def _stays_within(curve: Curve, name: str, end: float, what: str) -> None:
    for _, position in curve:
        if not 0.0 < position < end:
            raise ParameterError(
                f"{name}: {position} m is not between the loop (0) and the {what} ({end} m)"
            )


def pluck_string(model: Any, state: Any, pluck: Pluck) -> None:
    """Pull one string into a triangle, at rest, between the loop or stub and the bridge.

    The nodes at the bridge are moved by what it takes to leave the bridge at rest, so
    that the constraint of [Yehu] eq. (12) holds from the first sample.
    """
    m, s = model[0], state[0]
    i = pluck.string - 1
    intervals, h = int(m["N"][i]), float(m["h"][i])
    x, x_c, x_p = np.arange(intervals + 1) * h, float(m["bridge_x"]), pluck.position
    foot = (0.0, x_c) if x_p < x_c else (x_c, intervals * h)
    shape = pluck.amplitude * np.interp(x, [foot[0], x_p, foot[1]], [0.0, 1.0, 0.0])
    shape[[0, -1]] = 0.0
    u = np.zeros(layout.POINTS)
    u[GHOST : GHOST + intervals + 1] = shape
    first, weights = int(m["bridge_first"][i]), m["bridge_weights"][i]
    at_bridge = read(u, first, weights) / float(weights @ weights)
    u[GHOST + first : GHOST + first + len(weights)] -= weights * at_bridge
    support(u, intervals)
    s["u"][:, i, :] = u


@dataclass(frozen=True)
class Simulation:
    """The signals of one run, by name, one value a sample; and its meta data."""

    arrays: Mapping[str, Floats]
    meta: Mapping[str, Any]

    def save(self, target: Path) -> None:
        """Write an uncompressed ``.npz``; ``meta`` is JSON text within it.

        Errors: OutputError.
        """
        with replacing(target) as partial, partial.open("wb") as file:
            np.savez(
                file,
                allow_pickle=False,
                meta=np.array(json.dumps(self.meta)),
                **self.arrays,
            )


def simulate(
    gesture: Gesture,
    *,
    energy: bool = False,
    strings_every: int = 0,
    progress: Callable[[float, float], None] | None = None,
) -> Simulation:
    """Run the model through a gesture.

    Parameters
    ----------
    energy : bool
        Keep the energy ledger too: energy (J), power and losses (W), energy_error (W).
    strings_every : int
        Keep the shapes of both strings every so many samples; 0 for never.
    progress : callable
        Told seconds done and seconds in all.

    Errors: ParameterError where the quantities make no stable model at this rate.
    """
    model = kernel.prepare(gesture.quantities, gesture.sample_rate)
    m = model[0]
    frames = gesture.frames
    columns = layout.probe_columns(1) + layout.control_columns(1) + len(LEDGER) * energy
    shapes = (frames // strings_every) * int(m["N"].sum() + STRINGS) if strings_every else 0
    if 8 * (frames * columns + shapes) > MAX_BYTES:
        raise OutputError(
            f"{frames} samples would take more than {MAX_BYTES >> 30} GiB: "
            "shorten the gesture or keep the strings less often"
        )
    state = kernel.at_rest(model)
    if gesture.pluck is not None:
        pluck_string(model, state, gesture.pluck)
    state["stored"] = stored_energy(m, state[0], 0, 2)

    controls = gesture.control_rows()
    probes = np.zeros((frames, layout.probe_columns(1)))
    ledger = np.zeros((frames if energy else 0, len(LEDGER)))
    kept: list[list[Floats]] = [[], []]
    hop = strings_every or CHUNK
    for start in range(0, frames, hop):
        if strings_every:
            now = state["u"][0, int(state["level"][0])]
            for i in range(STRINGS):
                kept[i].append(now[i, GHOST : GHOST + int(m["N"][i]) + 1].copy())
        part = slice(start, min(start + hop, frames))
        kernel.advance(model, state, controls[part], probes[part], ledger[part])
        if progress is not None:
            progress(part.stop / gesture.sample_rate, gesture.duration)

    at = layout.FINGER_PROBES
    arrays: dict[str, Floats] = {
        "time": np.arange(frames) / gesture.sample_rate,
        "bridge_force": probes[:, layout.BRIDGE_FORCE],
        "bridge_force_1": probes[:, layout.BRIDGE_FORCE_1],
        "bridge_force_2": probes[:, layout.BRIDGE_FORCE_2],
        "bridge_velocity": probes[:, layout.BRIDGE_VELOCITY],
        "pressure": probes[:, layout.PRESSURE],
        "finger_displacement": probes[:, at],
        "contact_force": probes[:, at + 1 : at + 3],
        "friction_force": probes[:, layout.FRICTION_FORCE],
        "relative_velocity": probes[:, layout.RELATIVE_VELOCITY],
        "iterations": probes[:, layout.ITERATIONS].astype(np.int64),
    }
    arrays |= {name: controls[:, control.column] for name, control in CONTROLS.items()}
    if energy:
        arrays |= {name: ledger[:, column] for column, name in enumerate(LEDGER)}
    if strings_every:
        arrays["strings_time"] = arrays["time"][::strings_every]
        for i in range(STRINGS):
            arrays[f"string_{i + 1}"] = np.array(kept[i])
            length = gesture.quantities.strings[i].L
            arrays[f"x_{i + 1}"] = np.linspace(0.0, length, int(m["N"][i]) + 1)
    meta = {
        "version": __version__,
        "sample_rate": gesture.sample_rate,
        "frames": frames,
        "grid_intervals": [int(N) for N in m["N"]],
        "grid_spacing_m": [float(h) for h in m["h"]],
        "bridge_x_m": float(m["bridge_x"]),
        "friction_bound": friction_bound(m),
        "unconverged_solves": int(state["unconverged"][0]),
        "lost_states": int(state["lost"][0]),
    }
    return Simulation(arrays, meta)
