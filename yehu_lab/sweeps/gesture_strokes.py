"""Strokes of a study that vary a gesture file; docs/simulate.md describes these."""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.labels import ACCELERATION
from yehu_lab.regimes.judge import check_length
from yehu_lab.regimes.strokes import STROKE, ControlCurves, Instruments, control_curves_of, prepared
from yehu_lab.sweeps.axes import Axis, Value
from yehu_lab.sweeps.note_strokes import distinct
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.layout import F_HAMMER, V_B
from yehu_server.core.player.note_tables import wave_speed
from yehu_server.errors import ParameterError, did_you_mean
from yehu_server.scores.gesture import CONTROLS, Gesture, gesture_from
from yehu_server.util.documents import Fields

Array = Any

BESIDE = ("sample_rate", "duration", "instrument", "stroke")  # a gesture file has its own
LEAST, MOST = 1e-3, 1e5  # of it
MAX_INSTRUMENTS = 100_000  # and other entries of gestures; each is checked
TOUCHING = 1e-9  # N of press, above which a finger stops the strings


@dataclass(frozen=True)
class GestureBow:
    """Makes strokes of a gesture."""

    source: Mapping[str, Any]  # the data of the gesture file
    folder: Path  # where it is

    @classmethod
    def of(cls, table: Fields, folder: Path) -> GestureBow:
        """Read the entries of a study. Raises ParameterError where one is wrong."""
        for name in BESIDE:
            if name in table.data:
                table.add_error(name, "belongs into the gesture")
        gesture = table.table("gesture")
        if gesture_from(gesture, folder).fingers > 1:
            table.add_error("gesture", "a sweep has one finger")
        return cls(gesture.data, folder)

    def check(self, axes: Sequence[Axis]) -> None:
        """Refuse axes that are none, or out of bounds. Raises ParameterError where one is."""
        for axis in axes:
            if axis.name == ACCELERATION:
                self._check_acceleration(axis)
                continue
            if not _is_control(axis.name) and (hint := did_you_mean(axis.name, CONTROLS)):
                raise ParameterError(f"{axis.name}: unknown entry{hint}")
            ends: set[Value] = set(axis.values)
            numbers = [value for value in axis.values if not isinstance(value, str)]
            if _is_control(axis.name) and len(numbers) == len(axis.values):
                ends = {min(numbers), max(numbers)}
            for value in ends:
                self._gesture({axis.name: value})
        # Controls are checked at their ends, and other entries in each combination.
        others = [axis for axis in axes if not _is_control(axis.name)]
        others = [axis for axis in others if axis.name != ACCELERATION]
        count = math.prod(len(axis.values) for axis in others)
        if count > MAX_INSTRUMENTS:
            raise ParameterError(f"{count} instruments are more than {MAX_INSTRUMENTS}")
        for values in itertools.product(*(axis.values for axis in others)):
            varied = dict(zip([axis.name for axis in others], values, strict=True))
            gesture = self._gesture(varied)
            check_length(gesture.frames, gesture.sample_rate, self._frequency(gesture))

    def _check_acceleration(self, axis: Axis) -> None:
        for value in axis.values:
            if isinstance(value, str) or not LEAST <= value <= MOST:
                raise ParameterError(
                    f"{ACCELERATION}: {value} is not within {LEAST} to {MOST:g} m/s^2"
                )
        curve = self._gesture({}).controls.get("bow_velocity", ((0.0, 0.0),))
        if not any(value for _, value in curve):
            raise ParameterError(
                f"{ACCELERATION}: the gesture needs a bow_velocity, which is reached"
            )

    def varied(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """The data of the gesture file with some values."""
        data: dict[str, Any] = copy.deepcopy(dict(self.source))
        for name, value in values.items():
            _set(data, name, value)
        return data

    def _gesture(self, values: Mapping[str, Any]) -> Gesture:
        return gesture_from(self.varied(values), self.folder)

    def strokes(
        self, axes: Sequence[Axis], index: Array
    ) -> tuple[Instruments, Array, ControlCurves]:
        """Instruments, strokes and curves of some points.

        `index` [shape=(points, axes)] is the place of each point on each axis.
        """
        count = len(index)
        columns = {axis.name: axis.as_array()[index[:, i]] for i, axis in enumerate(axes)}
        others = [name for name in columns if not _is_control(name) and name != ACCELERATION]
        numbers, keys = distinct([columns[name] for name in others], count)
        gestures = [self._gesture(dict(zip(others, key, strict=True))) for key, _ in keys]
        strokes = np.zeros(count, STROKE)
        strokes["model"] = numbers
        strokes["frames"] = np.array([gesture.frames for gesture in gestures])[numbers]
        hair = np.array([int(gesture.quantities.bow.hair) for gesture in gestures])
        strokes["hair"] = hair[numbers]
        moves = strokes["moves"]
        moves["scale"], moves["pace"] = 1.0, 1.0
        base, curves = gestures[0], {}
        for name, control in CONTROLS.items():
            curve = list(base.controls.get(name, ((0.0, control.default),)))
            curves[control.column] = curve
            for path in (name, f"controls.{name}"):
                if path in columns:
                    largest = max((value for _, value in curve), key=abs) if len(curve) > 1 else 1.0
                    curves[control.column] = curve if len(curve) > 1 else [(0.0, 1.0)]
                    moves["scale"][:, control.column] = columns[path] / largest
        if ACCELERATION in columns:
            curve = curves[V_B]
            speed = max((value for _, value in curve), key=abs)
            moves["scale"][:, V_B] *= speed
            moves["pace"][:, V_B] = columns[ACCELERATION] / np.abs(moves["scale"][:, V_B])
            moves["start"][:, V_B] = curve[0][0]
            curves[V_B] = [(0.0, 0.0), (1.0, 1.0)]
        if base.hammer:
            silent = [(base.hammer[0][0], 0.0), *base.hammer, (base.hammer[-1][0], 0.0)]
            curves[F_HAMMER] = silent
        self._hear(strokes, gestures, columns)
        instruments = prepared(
            [gesture.quantities for gesture in gestures],
            [gesture.sample_rate for gesture in gestures],
            [gesture.pluck for gesture in gestures],
        )
        return instruments, strokes, control_curves_of(curves)

    def gesture(self, axes: Sequence[Axis], place: Sequence[int]) -> Gesture:
        """One of the strokes as a gesture, for `simulate`."""
        values = {axis.name: axis.values[i] for axis, i in zip(axes, place, strict=True)}
        acceleration = values.pop(ACCELERATION, None)
        data = self.varied(values)
        if acceleration is not None:
            curve = gesture_from(data, self.folder).controls["bow_velocity"]
            speed = max((value for _, value in curve), key=abs)
            begin = curve[0][0]
            ramp = [[begin, 0.0], [begin + abs(speed) / float(acceleration), speed]]
            data["controls"] = {**data["controls"], "bow_velocity": ramp}
        return gesture_from(data, self.folder)

    def _hear(
        self, strokes: Array, gestures: Sequence[Gesture], columns: Mapping[str, Array]
    ) -> None:
        """Write the frequencies (Hz) that the fingers stop at the end."""
        names = [
            name
            for name in columns
            if name.rpartition(".")[2] in {"bow_force", "finger_position", "press_force"}
        ]
        numbers, keys = distinct(
            [strokes["model"], *(columns[name] for name in names)], len(strokes)
        )
        found = []
        for key, at in keys:
            ends = {
                name.rpartition(".")[2]: value for name, value in zip(names, key[1:], strict=True)
            }
            found.append(self._frequency(gestures[strokes["model"][at]], ends))
        strokes["frequency_hz"] = np.array(found)[numbers]

    def _frequency(self, gesture: Gesture, ends: Mapping[str, float] | None = None) -> float:
        """The frequency (Hz) of an ideal string as it is stopped at the end of a gesture."""

        def end(name: str) -> float:
            curve = gesture.controls.get(name, ((0.0, CONTROLS[name].default),))
            last = curve[-1][1]
            if ends is None or name not in ends:
                return last
            largest = max((value for _, value in curve), key=abs)
            return ends[name] * (last / largest if len(curve) > 1 else 1.0)

        quantities: Quantities = gesture.quantities
        string = 0 if end("bow_force") >= 0.0 else 1
        stop = end("finger_position") if end("press_force") > TOUCHING else 0.0
        return wave_speed(quantities, string) / (2.0 * (quantities.bridge_x - stop))


def _is_control(name: str) -> bool:
    return name.removeprefix("controls.") in CONTROLS


def _set(data: Any, name: str, value: Any) -> None:
    """Set an entry of a gesture's data, in place; a curve is scaled to the value at its largest.

    Raises ParameterError where there is no such entry.
    """
    path = name.split(".")
    *tables, last = ["controls", *path] if path[0] in CONTROLS else path
    for table in tables:
        data = data.setdefault(table, {}) if isinstance(data, dict) else None
    if not isinstance(data, dict):
        raise ParameterError(f"{name}: no such entry")
    present = data.get(last)
    data[last] = _scaled(present, value, name) if isinstance(present, list) else value


def _scaled(curve: list[Any], value: Any, name: str) -> list[Any]:
    try:
        largest = max((level for _, level in curve), key=abs)
        scaled = [[time, level * value / largest] for time, level in curve]
    except (TypeError, ValueError, ZeroDivisionError):
        raise ParameterError(
            f"{name}: a curve that is varied takes numbers, and needs a point that is not 0"
        ) from None
    if not all(math.isfinite(level) for _, level in scaled):
        raise ParameterError(f"{name}: {value} is beyond all bounds")
    return scaled
