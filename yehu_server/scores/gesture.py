"""Read gesture files: motion of bow and finger in physical units; see docs/simulate.md."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.controls.record import PARK_AFTER_S
from yehu_server.core.physics import layout
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.grid import MIN_RATE
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.util.documents import Document, Fields
from yehu_server.util.values import brief, number

Floats = np.ndarray[Any, np.dtype[np.float64]]
Curve = tuple[tuple[float, float], ...]

HIGHEST_RATE = 1e6  # Hz, of the model alone, to see how it converges; players end at 192 kHz
MAX_DURATION_S = 3600.0
MAX_BYTES = 16 * 2**20


@dataclass(frozen=True)
class Control:
    """One control of a gesture: its column in the kernel's array, bounds, default, unit, meaning.

    scripts/generate writes the table of docs/simulate.md from them.
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
_FINGER = ("finger_position", "press_force")
# Of finger 2, `finger_position_2` and `press_force_2`; and so on.
ALL_CONTROLS = CONTROLS | {
    f"{name}_{finger}": replace(
        CONTROLS[name], column=CONTROLS[name].column + layout.CONTROLS_PER_FINGER * (finger - 1)
    )
    for finger in range(2, layout.MAX_FINGERS + 1)
    for name in ("finger_position", "press_force")
}
HAMMER_LIMIT = 1e4  # N
ROCKING_POINTS = 48  # of a curve in each turn of a rocking finger


@dataclass(frozen=True)
class Pluck:
    """A string released from a triangle: string 1 or 2, position and amplitude in metres.

    `angle` (degrees) is that from the bow's direction, towards the player's fingers.
    """

    string: int
    position: float
    amplitude: float
    angle: float = 0.0


@dataclass(frozen=True)
class Rocking:
    """A fingertip that rolls to and fro along the strings: vibrato by the first finger.

    At `rate` (Hz) its contact goes `reach` (m) to either side, from `start` (s) on, and its press
    rises by the share `lean` towards the bridge, and falls by it towards the loop.
    """

    rate: float
    reach: float
    lean: float
    start: float


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

    @property
    def fingers(self) -> int:
        """Number of fingers: up to the last that has a control."""
        columns = [ALL_CONTROLS[name].column - layout.FINGER_CONTROLS for name in self.controls]
        return max(0, *columns, 0) // layout.CONTROLS_PER_FINGER + 1

    def control_rows(self) -> Floats:
        """The kernel's control array [shape=(frames, control columns)]."""
        time = np.arange(self.frames) / self.sample_rate
        rows = np.zeros((self.frames, layout.control_columns(self.fingers)))
        for name, control in ALL_CONTROLS.items():
            if control.column >= rows.shape[1]:
                continue
            curve = self.controls.get(name, ((0.0, control.default),))
            times, values = zip(*curve, strict=True)
            rows[:, control.column] = np.interp(time, times, values)
        rows[:, layout.Y_B] = np.cumsum(rows[:, layout.V_B]) / self.sample_rate
        for at in range(layout.FINGER_CONTROLS, rows.shape[1], layout.CONTROLS_PER_FINGER):
            parked = parked_frames(rows[:, at + 1], self.sample_rate)
            rows[parked, at] = self.quantities.bridge_x
        if self.hammer:
            times, forces = zip(*self.hammer, strict=True)
            rows[:, layout.F_HAMMER] = np.interp(time, times, forces, left=0.0, right=0.0)
        return rows


def parked_frames(press: Floats, rate: float) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Where a finger without press (N) waits over the bridge: a swinging string would touch it.

    It is lifted where it was, and goes there as soon as a player's does.
    """
    frame, wait = np.arange(len(press)), int(PARK_AFTER_S * rate)
    pressed = np.maximum.accumulate(np.where(press > 0.0, frame, -wait))
    return frame - pressed >= wait


def read_gesture(path: Path, instrument: Path | None = None) -> Gesture:
    """Read a gesture file, for an instrument file where one is given.

    Raises ScoreError where it cannot be read or is not JSON; ParameterError where an entry is
    wrong.
    """
    document = Document(path, "a gesture file", unreadable=ScoreError).read(path, MAX_BYTES)
    table = document.json()
    return gesture_from(Fields(on_instrument(table.data, instrument), document), path.parent)


def on_instrument(data: Mapping[str, Any], path: Path | None) -> Mapping[str, Any]:
    """The data of a gesture or study, whose `instrument` is changed from that of a file."""
    own = data.get("instrument", {})
    if path is None or not isinstance(own, Mapping):
        return data
    return {**data, "instrument": {**own, "base": str(path.absolute())}}


def gesture_from(data: Any, folder: Path = Path()) -> Gesture:
    """Build a gesture from the data of a file in `folder`; raises ParameterError."""
    table = Fields.of(data, "gesture")
    rate = table.read("sample_rate", sample_rate, 44100.0)
    duration = table.read("duration", number, 1.0, 1.0 / rate, MAX_DURATION_S, "s")
    quantities = override(Quantities(), table.table("instrument"), folder)
    controls = table.table("controls")
    curves = {
        name: controls.read(name, _curve, (), control.lo, control.hi, control.unit)
        for name, control in ALL_CONTROLS.items()
        if name in controls.data
    }
    controls.refuse_others(*ALL_CONTROLS)
    for name, control in ALL_CONTROLS.items():
        if not name.startswith(("bow_position", "finger_position")):
            continue
        with controls.at(name):
            for _, position in curves.get(name, ((0.0, control.default),)):
                if not 0.0 < position < quantities.bridge_x:
                    bridge = f"the bridge ({quantities.bridge_x} m)"
                    raise ParameterError(f"{position} m is not between the loop (0) and {bridge}")
    has_pluck, has_hammer = (table.data.get(name) is not None for name in ("pluck", "hammer"))
    pluck = _pluck(table.table("pluck"), quantities) if has_pluck else None
    hammer: Curve = ()
    if table.data.get("rocking") is not None:
        _rock(curves, _rocking(table.table("rocking")), duration, quantities.bridge_x, table)
    if has_hammer:
        hammer = table.read("hammer", _curve, (), -HAMMER_LIMIT, HAMMER_LIMIT, "N")
    table.refuse_others("pluck", "hammer", "rocking")
    return Gesture(rate, duration, quantities, curves, pluck, hammer, table.data)


def _rocking(table: Fields) -> Rocking:
    rocking = Rocking(
        rate=table.read("rate", number, 6.0, 0.1, 50.0, "Hz"),
        reach=table.read("reach", number, 1e-3, 0.0, 0.02, "m"),
        lean=table.read("lean", number, 0.0, -1.0, 1.0),
        start=table.read("start", number, 0.0, 0.0, MAX_DURATION_S, "s"),
    )
    table.refuse_others()
    return rocking


def _rock(
    curves: dict[str, Curve], rocking: Rocking, duration: float, bridge_x: float, table: Fields
) -> None:
    """Add the motion of a rocking finger to the curves of the first; steps of them become ramps."""
    first = [min(rocking.start, duration)]
    step = 1.0 / (rocking.rate * ROCKING_POINTS)
    steps = np.arange(first[0], duration + step, step)
    own = {name: curves.get(name, ((0.0, CONTROLS[name].default),)) for name in _FINGER}
    times = np.unique([time for curve in own.values() for time, _ in curve] + [*first, *steps])
    turn = np.sin(2.0 * np.pi * rocking.rate * np.maximum(times - rocking.start, 0.0))
    points = [np.array(own[name]).T for name in _FINGER]
    place, press = (np.interp(times, at, values) for at, values in points)
    place, press = place + rocking.reach * turn, press * (1.0 + rocking.lean * turn)
    if not 0.0 < place.min() <= place.max() < bridge_x:
        table.add_error("rocking", "takes the finger beyond the loop or the bridge")
    for name, values in zip(_FINGER, (place, press), strict=True):
        curves[name] = tuple(zip(times.tolist(), values.tolist(), strict=True))


def sample_rate(value: Any) -> float:
    """A sample rate (Hz) that the model runs at; raises ParameterError."""
    return number(value, MIN_RATE, HIGHEST_RATE, "Hz")


def _pluck(table: Fields, quantities: Quantities) -> Pluck:
    bridge, shortest = quantities.bridge_x, min(string.L for string in quantities.strings)
    pluck = Pluck(
        string=int(table.read("string", number, 1, 1, 2)),
        position=table.read("position", number, 0.1, 0.0, shortest, "m"),
        amplitude=table.read("amplitude", number, 0.001, -0.1, 0.1, "m"),
        angle=table.read("angle", number, 0.0, -360.0, 360.0, "degrees"),
    )
    table.refuse_others()
    if pluck.string != table.data.get("string", 1):
        table.add_error("string", f"expected 1 or 2, got {table.data['string']}")
    if pluck.angle != 0.0 and quantities.directions == "one":
        table.add_error("angle", 'needs an instrument with directions = "two"')
    if pluck.position in (0.0, bridge, shortest):
        table.add_error("position", f"{pluck.position} m is not on the free string")
    return pluck


def _curve(value: Any, lo: float, hi: float, unit: str) -> Curve:
    if isinstance(value, int | float) and not isinstance(value, bool):
        value = [[0.0, value]]
    if not isinstance(value, list) or not value:
        raise ParameterError(f"expected a list of [time, value] pairs, got {brief(value)}")
    points = []
    last = -math.inf
    for point in value:
        if not isinstance(point, list) or len(point) != 2:
            raise ParameterError(f"expected [time, value], got {brief(point)}")
        time, level = number(point[0]), number(point[1], lo, hi, unit)
        if time < last:
            raise ParameterError(f"times must not go back ({time} s after {last} s)")
        points.append((time, level))
        last = time
    return tuple(points)
