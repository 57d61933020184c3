"""Compute samples of an instrument, and keep what its model was given and did at each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from yehu_server.api.checks import setting
from yehu_server.core.controls.record import CHUNK
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG
from yehu_server.core.physics.layout import MAX_FINGERS, STRINGS, control_columns, probe_columns
from yehu_server.errors import ParameterError
from yehu_server.params.table import SLOT
from yehu_server.playing.player import Player
from yehu_server.simulation import run

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Curve:
    """Values of a parameter, equally spaced from the beginning of a run to its end.

    Between them, it moves in straight lines.
    """

    address: str
    values: Floats

    def at(self, share: float) -> float:
        """Return the value at a share of the time."""
        places = np.linspace(0.0, 1.0, len(self.values))
        return float(np.interp(share, places, self.values))


def curves_of(controls: Mapping[str, ArrayLike] | None) -> list[Curve]:
    """Return what moves during a run; raises ParameterError for a wrong address or value."""
    if controls is not None and not isinstance(controls, Mapping):
        raise ParameterError("controls: expected addresses and values, such as {'/bow/speed': 0.2}")
    curves = []
    for address, given in (controls or {}).items():
        try:
            values = np.atleast_1d(np.asarray(given, np.float64))
        except (TypeError, ValueError):
            raise ParameterError(f"{address}: expected a number or an array of numbers") from None
        if values.ndim != 1 or len(values) == 0:
            raise ParameterError(f"{address}: expected one value after another, got {values.shape}")
        for value in (values.min(), values.max()):  # NaN too
            setting(address, float(value))
        curves.append(Curve(address, values))
    return curves


class Run:
    """A run of an instrument from now on.

    `stage`: what computes samples: `instrument`, or the stage that it plays on.
    `curves`: parameters that move meanwhile.
    """

    def __init__(
        self,
        instrument: Instrument,
        stage: Ensemble | Instrument,
        commands: Player,
        curves: Sequence[Curve] = (),
    ) -> None:
        self._instrument, self._stage, self._commands = instrument, stage, commands
        self._curves = curves
        self._rig = np.frombuffer(instrument.memory, RIG, count=1)[0]

    def sound(self, frames: int, channels: int) -> NDArray[np.float32]:
        """Compute samples, ndarray [shape=(frames,) or (frames, 2), float32]."""
        out = np.zeros(frames if channels == 1 else (frames, channels), np.float32)
        if not self._curves:
            self._stage.process(out)
            return out
        self._take_over()
        for start in range(0, frames, CHUNK):
            end = min(start + CHUNK, frames)
            self._move(start, end, frames)
            self._stage.process(out[start:end])
        return out

    def signals(self, frames: int, channels: int, strings_every: int) -> run.Simulation:
        """Compute samples and keep all signals; see `api.instrument.Instrument.record`.

        Raises ParameterError where the arrays would take more than MAX_BYTES.
        """
        model, state = self._rig["model"], self._rig["state"]
        every = strings_every or CHUNK
        nodes = int(model["N"].sum()) + STRINGS
        columns = probe_columns(MAX_FINGERS) + control_columns(MAX_FINGERS) + channels
        shapes = frames // strings_every * nodes if strings_every else 0
        if 8 * (frames * columns + shapes) > run.MAX_BYTES:
            raise ParameterError(
                f"{frames} samples would take more than {run.MAX_BYTES >> 30} GiB: "
                "record less at a time, or the strings less often"
            )
        out = np.zeros(frames if channels == 1 else (frames, channels), np.float32)
        probes = np.zeros((frames, probe_columns(MAX_FINGERS)))
        controls = np.zeros((frames, control_columns(MAX_FINGERS)))
        kept: list[list[Floats]] = [[] for _ in range(STRINGS)]
        self._take_over()
        start = 0
        while start < frames:
            if strings_every and start % every == 0:
                for i in range(STRINGS):
                    kept[i].append(run.shape_of(model, state["motion"], i))
            end = min(start + CHUNK, start - start % every + every, frames)
            self._move(start, end, frames)
            self._stage.process(out[start:end])
            output = self._rig["output"]
            probes[start:end] = output["probes"][: end - start]
            controls[start:end] = output["controls"][: end - start]
            start = end
        arrays: dict[str, NDArray[Any]] = {"sound": out} | run.signals(
            probes, controls, self._instrument.rate
        )
        quantities = self._instrument.spec.quantities
        if strings_every:
            arrays |= run.shapes_of(kept, model, quantities, arrays["time"][::strings_every])
        metadata = run.metadata_of(model, state, frames, quantities, self._rig["refined"])
        return run.Simulation(arrays, {"seed": self._instrument.seed} | metadata)

    def _take_over(self) -> None:
        """Take the parameters of the curves from the player, and put them to their first values."""
        for curve in self._curves:
            self._commands.write(curve.address, curve.at(0.0))
            if curve.address in SLOT:
                self._instrument.write(curve.address, curve.at(0.0), ramp_ms=0.0)

    def _move(self, start: int, end: int, frames: int) -> None:
        """Let the parameters of the curves move to their values at a frame's end."""
        for curve in self._curves:
            value = curve.at(end / frames)
            if curve.address in SLOT:
                ramp_ms = 1e3 * (end - start) / self._instrument.rate
                self._instrument.write(curve.address, value, ramp_ms=ramp_ms)
            else:
                self._commands.write(curve.address, value)
