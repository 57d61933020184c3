"""Strokes of a study that are given as a player thinks of them: a note, a force, a speed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.regimes.judge import check_length
from yehu_lab.regimes.strokes import STROKE, ControlCurves, Instruments, control_curves_of, prepared
from yehu_lab.sweeps.axes import Axis
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.elementary import log
from yehu_server.core.physics.grid import check_rate
from yehu_server.core.physics.layout import F_N, FINGER_CONTROLS, TEXTURE, V_B, X_B
from yehu_server.core.player import note_tables
from yehu_server.errors import ParameterError, did_you_mean
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.stringing import notes_of
from yehu_server.playing.tuning import STANDARD_A4
from yehu_server.scores.gesture import CONTROLS, Gesture
from yehu_server.util.documents import Fields
from yehu_server.util.values import brief, number

Array = Any
# s: finger and hair are on the string before the bow moves.
FINGER_DOWN, HAIR_ON, HAIR_DOWN, BOW_MOVES = 0.01, 0.01, 0.02, 0.03
LONGEST = 60.0  # s
SLACK = 1.5  # by which a note may be lowered
HANDS = control_curves_of(
    {
        F_N: [(HAIR_ON, 0.0), (HAIR_DOWN, 1.0)],
        V_B: [(0.0, 0.0), (1.0, 1.0)],
        X_B: [(0.0, 1.0)],
        TEXTURE: [(0.0, 1.0)],
        FINGER_CONTROLS: [(0.0, 1.0)],
        FINGER_CONTROLS + 1: [(0.0, 0.0), (FINGER_DOWN, 1.0)],
    }
)


@dataclass(frozen=True)
class Entry:
    """A value of a stroke: default, bounds, unit, and whether it is a whole number."""

    default: float
    lo: float
    hi: float
    unit: str
    whole: bool = False


ENTRIES = {
    "string": Entry(1, 1, 2, "", whole=True),
    "note": Entry(70, 0, 127, "MIDI note"),
    "force": Entry(0.5, 1e-3, 50.0, "N"),
    "position": Entry(0.13, 0.01, 0.9, "of the sounding length"),
    "speed": Entry(0.2, 1e-3, 5.0, "m/s"),
    "acceleration": Entry(5.0, 1e-2, 1e3, "m/s^2"),
    "press": Entry(1.5, 0.01, 50.0, "N"),
    "place": Entry(0.0, -300.0, 300.0, "cents"),
    "tension": Entry(1.0, 0.5, 1.5, ""),
    "noise": Entry(0.0, 0.0, 1.0, ""),
    "seed": Entry(0, 0, 65535, "", whole=True),
}


@dataclass(frozen=True, eq=False)
class Tuned:
    """An instrument that is tuned.

    `calibration`: by which fingers are placed.
    `quantities`: as it is bowed.
    `measured`: the instrument that was calibrated, before it was tuned.
    """

    calibration: note_tables.NoteTables
    quantities: Quantities
    measured: Quantities

    @cache  # noqa: B019 - a study has one for as long as it lives
    def fingering(self, string: int, note: float, speed: float) -> tuple[float, float]:
        """Where a finger stops a note (m), as the player's tables say; its frequency (Hz)."""
        tuned = self.calibration
        frequency = note_tables.frequency_hz(note, STANDARD_A4)
        rows = np.array(tuned.sharpening[string])
        logarithm = log(speed)
        at_speed = [float(np.interp(logarithm, np.log(note_tables.SPEEDS), row)) for row in rows]
        in_tables = note - (tuned.open_notes[string] - note_tables.OPEN_NOTES[string])
        sharp = float(np.interp(in_tables, note_tables.PITCHES[string], at_speed))
        ideal = frequency * 2.0 ** (-sharp / 1200.0)
        return note_tables.ideal_position(tuned.tuned(self.measured), string, ideal), frequency


@dataclass(frozen=True)
class NoteBow:
    """Makes strokes of notes on the tuned instrument."""

    rate: float
    duration: float
    instrument: Mapping[str, Any]
    fixed: Mapping[str, float]  # the values that are not varied
    folder: Path

    @classmethod
    def of(cls, table: Fields, folder: Path) -> NoteBow:
        """Read the entries of a study. Raises ParameterError where one is wrong."""
        rate = table.read("sample_rate", played_rate, 44100.0)
        duration = table.read("duration", number, 0.3, BOW_MOVES, LONGEST, "s")
        if duration == BOW_MOVES:
            table.add_error("duration", f"expected more than {BOW_MOVES} s")
        fixed = {name: entry.default for name, entry in ENTRIES.items()}
        fixed |= table.table("stroke").each(_checked)
        instrument = table.table("instrument")
        override(Quantities(), instrument, folder)
        return cls(rate, duration, instrument.data, fixed, folder)

    def check(self, axes: Sequence[Axis]) -> None:
        """Refuse axes that are none, or out of bounds. Raises ParameterError where one is."""
        values: dict[str, Sequence[Any]] = {name: [value] for name, value in self.fixed.items()}
        for axis in axes:
            if axis.name.startswith("instrument."):
                continue
            for value in axis.values:
                Fields({axis.name: value}).each(_checked)
            values[axis.name] = axis.values
        for string in values["string"]:
            lowest = self._tuned.calibration.open_notes[int(string) - 1]
            for note in values["note"]:
                if not lowest <= note <= lowest + 24:
                    raise ParameterError(
                        f"note: {note:g} is not within {lowest} to {lowest + 24}, "
                        f"which are on string {string:g}"
                    )
        models = [axis for axis in axes if _is_of_model(axis.name)]
        for axis in models:
            for value in axis.values:
                self._quantities({axis.name: value})
        deepest = float(min(values["note"]))
        bowed = round((self.duration - BOW_MOVES) * self.rate)
        check_length(bowed, self.rate, note_tables.frequency_hz(deepest, STANDARD_A4) / SLACK)

    def strokes(
        self, axes: Sequence[Axis], index: Array
    ) -> tuple[Instruments, Array, ControlCurves]:
        """Instruments, strokes and curves of some points.

        `index` [shape=(points, axes)] is the place of each point on each axis.
        """
        count = len(index)
        columns = {axis.name: axis.as_array()[index[:, i]] for i, axis in enumerate(axes)}
        value = {
            name: columns.get(name, np.full(count, fixed)) for name, fixed in self.fixed.items()
        }
        names = [name for name in columns if _is_of_model(name)]
        numbers, keys = distinct([columns[name] for name in names], count)
        instruments = [
            self._quantities(dict(zip(names, key, strict=True)), int(value["string"][at]))
            for key, at in keys
        ]
        made = prepared(instruments, [self.rate] * len(instruments))
        strokes = np.zeros(count, STROKE)
        strokes["model"], strokes["hair"] = numbers, value["seed"]
        strokes["frames"] = round(self.duration * self.rate)
        place, press, frequency = self._fingering(value, [instruments[i] for i in numbers])
        strokes["frequency_hz"] = frequency
        moves = strokes["moves"]
        moves["pace"] = 1.0
        scale = moves["scale"]
        bridge = np.array([quantities.bridge_x for quantities in instruments])[numbers]
        scale[:, F_N] = np.where(value["string"] == 1, value["force"], -value["force"])
        scale[:, V_B] = value["speed"]
        moves["start"][:, V_B] = BOW_MOVES
        moves["pace"][:, V_B] = value["acceleration"] / value["speed"]
        stop = np.where(press > 0.0, place, 0.0)
        scale[:, X_B] = bridge - value["position"] * (bridge - stop)
        scale[:, TEXTURE] = value["noise"]
        scale[:, FINGER_CONTROLS], scale[:, FINGER_CONTROLS + 1] = place, press
        return made, strokes, HANDS

    def gesture(self, axes: Sequence[Axis], place: Sequence[int]) -> Gesture:
        """One of the strokes as a gesture, for `simulate`."""
        index = np.array([place])
        _, strokes, hands = self.strokes(axes, index)
        values = {axis.name: axis.values[i] for axis, i in zip(axes, place, strict=True)}
        varied = {name: value for name, value in values.items() if _is_of_model(name)}
        string = int(values.get("string", self.fixed["string"]))
        quantities = self._quantities(varied, string)
        hair = float(strokes["hair"][0])
        controls = {}
        for name, control in CONTROLS.items():
            move = strokes["moves"][0, control.column]
            begin, end = hands.first[control.column : control.column + 2]
            points = zip(hands.times[begin:end], hands.values[begin:end], strict=True)
            if begin < end:
                controls[name] = tuple(
                    (float(time / move["pace"] + move["start"]), float(move["scale"] * value))
                    for time, value in points
                )
        bow = replace(quantities.bow, hair=hair)
        source = {"stroke": dict(self.fixed) | values, "instrument": dict(self.instrument)}
        changed = replace(quantities, bow=bow)
        return Gesture(self.rate, self.duration, changed, controls, source=source)

    @cached_property
    def _tuned(self) -> Tuned:
        """The instrument as it is tuned.

        What a study changes of a yehu leaves its player's tables as they are. A fiddle whose
        strings are for other notes is calibrated itself.
        """
        own = override(Quantities(), self.instrument, self.folder)
        try:
            is_yehu = notes_of(own).open_notes == note_tables.OPEN_NOTES
        except ParameterError:  # strings that no fiddle has
            is_yehu = True
        if not is_yehu:
            found = calibration_for(self.rate, own)
            return Tuned(found, found.tuned(own), own)
        usual = calibration_for(self.rate)
        tensions = {
            f"string_{i + 1}": {"T": tension}
            for i, tension in enumerate(usual.tensions)
            if own.strings[i].T == Quantities().strings[i].T
        }
        return Tuned(usual, override(own, tensions), Quantities())

    def _quantities(self, varied: Mapping[str, Any], string: int = 1) -> Quantities:
        """The tuned instrument, with what the study changes, and some values of its axes."""
        changed = self._tuned.quantities
        tension = float(varied.get("tension", self.fixed["tension"]))
        for name, value in varied.items():
            if name.startswith("instrument."):
                for part in reversed(name.split(".")[1:]):
                    value = {part: value}  # noqa: PLW2901 - nested as in a file
                changed = override(changed, value, self.folder)
        if tension != 1.0:
            section = f"string_{string}"
            own = changed.strings[string - 1].T * tension
            changed = override(changed, {section: {"T": own}})
        return changed

    def _fingering(
        self, value: Mapping[str, Array], instruments: Sequence[Quantities]
    ) -> tuple[Array, Array, Array]:
        """Finger positions (m), finger forces (N; 0 where the string is open), frequencies (Hz)."""
        count = len(instruments)
        place, press, frequency = np.empty(count), np.empty(count), np.empty(count)
        for i, quantities in enumerate(instruments):
            string, note = int(value["string"][i]) - 1, float(value["note"][i])
            x, sounding = self._tuned.fingering(string, note, float(value["speed"][i]))
            tuned = self._tuned.calibration.tensions[string]
            quicker = math.sqrt(quantities.strings[string].T / tuned)
            if note == self._tuned.calibration.open_notes[string]:
                place[i], press[i] = quantities.bridge_x, 0.0
                frequency[i] = sounding * quicker
                continue
            shift = 2.0 ** (float(value["place"][i]) / 1200.0)
            bridge = quantities.bridge_x
            place[i], press[i] = bridge - (bridge - x) / shift, value["press"][i]
            frequency[i] = sounding * shift * quicker
        return place, press, frequency


def played_rate(value: Any) -> float:
    """A sample rate (Hz) that a tuned instrument plays at; raises ParameterError."""
    rate = number(value)
    check_rate(rate)
    return rate


def _is_of_model(name: str) -> bool:
    return name.startswith("instrument.") or name in {"tension", "string"}


def distinct(columns: Sequence[Array], count: int) -> tuple[Array, list[tuple[Any, int]]]:
    """Number the combinations of some columns; the values of each, and where it is first."""
    rows = zip(*(column.tolist() for column in columns), strict=True) if columns else [()] * count
    found: dict[tuple[Any, ...], int] = {}
    numbers = np.array([found.setdefault(row, len(found)) for row in rows], np.int64)
    first = np.unique(numbers, return_index=True)[1].tolist()
    return numbers, list(zip(found, first, strict=True))


def _checked(name: str, value: Any) -> Any:
    entry = ENTRIES.get(name)
    if entry is None:
        hint = did_you_mean(name, ENTRIES)
        raise ParameterError(f"unknown entry{hint} (known: {', '.join(ENTRIES)}, instrument....)")
    found = number(value, entry.lo, entry.hi, entry.unit)
    if entry.whole and found != int(found):
        raise ParameterError(f"{brief(value)} is not a whole number")
    return value
