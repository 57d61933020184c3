"""Read gesture files: motion of bow and finger in physical units; see docs/simulate.md."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.physics import layout
from yehu_server.core.physics.grid import check_rate
from yehu_server.core.physics.quantities import Quantities, override
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.util.documents import parse_json
from yehu_server.util.files import read_text

Floats = np.ndarray[Any, np.dtype[np.float64]]
Curve = tuple[tuple[float, float], ...]

MAX_DURATION_S = 3600.0
MOST_BYTES = 16 * 2**20


@dataclass(frozen=True)
class Control:
    """One control of a gesture: its column in the kernel's array, bounds, default, unit, meaning.

    scripts/generate.py writes the table of docs/simulate.md from them.
    """

    column: int
    lo: float
    hi: float
    default: float
    unit: str
    doc: str


# fmt: off
CONTROLS = {
    "bow_force": Control(layout.F_N, -50.0, 50.0, 0.0, "N",
        "above zero on string 1 (F4), below on string 2 (C5), under 1 mN lifted"),
    "bow_velocity": Control(layout.V_B, -10.0, 10.0, 0.0, "m/s",
        "of the bow"),
    "bow_position": Control(layout.X_B, 0.0, 1.0, 0.255, "m",
        "from the restraining loop; kept one grid node off the bridge"),
    "bow_noise": Control(layout.TEXTURE, 0.0, 1.0, 0.0, "1",
        "how much friction varies along the bow's hair, as a fraction of it"),
    "pluck_force": Control(layout.F_PLUCK, -50.0, 50.0, 0.0, "N",
        "on a string, its sign choosing which as `bow_force` does; let go at 0"),
    "pluck_position": Control(layout.X_PLUCK, 0.0, 1.0, 0.2, "m",
        "from the restraining loop"),
    "finger_position": Control(layout.FINGER_CONTROLS, 0.0, 1.0, 0.1, "m",
        "from the restraining loop"),
    "press_force": Control(layout.FINGER_CONTROLS + 1, 0.0, 100.0, 0.0, "N",
        "of the finger; 0 lifts it off the strings"),
}
# fmt: on
HAMMER_LIMIT = 1e4  # N


@dataclass(frozen=True)
class Pluck:
    """A string released from a triangle: string 1 or 2, position and amplitude in metres."""

    string: int
    position: float
    amplitude: float


@dataclass(frozen=True)
class Gesture:
    """The contents of a gesture file. Curves are ((time in s, value), ...), linear between."""

    sample_rate: float = 44100.0
    duration: float = 1.0
    quantities: Quantities = field(default_factory=Quantities)
    controls: Mapping[str, Curve] = field(default_factory=dict)
    pluck: Pluck | None = None
    hammer: Curve = ()
    source: Mapping[str, Any] = field(default_factory=dict)  # the data of the file

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
        rows[:, layout.Y_B] = np.cumsum(rows[:, layout.V_B]) / self.sample_rate
        if self.hammer:
            times, forces = zip(*self.hammer, strict=True)
            rows[:, layout.F_HAMMER] = np.interp(time, times, forces, left=0.0, right=0.0)
        return rows


def read_gesture(path: Path) -> Gesture:
    """Read a gesture file.

    Raises
    ------
    ScoreError
        Where it cannot be read or is not JSON.
    ParameterError
        Where an entry is wrong.
    """
    try:
        text = read_text(path, MOST_BYTES)
    except OSError as error:
        raise ScoreError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ScoreError(f"{path}: not a gesture file (not text)") from error
    try:
        data = parse_json(text)
    except ValueError as error:
        raise ScoreError(f"{path}: not a gesture file ({error})") from error
    try:
        return gesture_from(data, path.parent)
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error


def gesture_from(data: Any, folder: Path = Path()) -> Gesture:
    """Build a gesture from the data of a gesture file in `folder`.

    Raises
    ------
    ParameterError
        Where an entry is wrong.
    """
    known = ("sample_rate", "duration", "instrument", "controls", "pluck", "hammer")
    data = _names(data, "gesture", known)
    rate = _number(data.get("sample_rate", 44100.0), "sample_rate")
    check_rate(rate)
    duration = _number(data.get("duration", 1.0), "duration")
    if not 1.0 / rate <= duration <= MAX_DURATION_S:
        raise ParameterError(f"duration: {duration} s is not within one sample to 1 hour")
    quantities = override(Quantities(), data.get("instrument", {}), folder)
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
    return Gesture(rate, duration, quantities, curves, pluck, hammer, data)


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
