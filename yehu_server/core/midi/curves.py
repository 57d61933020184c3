"""From the position of a source to the value of a target, and back. Compiled."""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi.tables import EXPONENTIAL, POINTS, S
from yehu_server.core.physics.elementary import asin, log, power, sin

# Distance from the target's value within which a soft bind takes over, as a fraction of the span.
PICKUP_WINDOW = 1.0 / 64.0


@compiled_exactly
def inverted(t: Any, bind: int, position: float) -> float:
    """A position as the curve has it."""
    return 1.0 - position if t.invert[bind] != 0.0 else position


@compiled_exactly
def along_curve(t: Any, bind: int, unit: float, lo: float, hi: float) -> float:
    """Map 0 to 1 to `lo` to `hi`, along a bind's curve."""
    curve = int(t.curve[bind])
    if curve == EXPONENTIAL:
        return float(lo * power(hi / lo, unit))
    if curve == POINTS:
        unit = fraction_at(t, bind, unit)
    elif curve == S:
        unit = unit * unit * (3.0 - 2.0 * unit)
    return lo + (hi - lo) * unit


@compiled_exactly
def from_unit(t: Any, bind: int, position: float) -> float:
    """Map a source's position, 0 to 1, to the target's value."""
    return along_curve(t, bind, inverted(t, bind, position), t.lo[bind], t.hi[bind])


@compiled_exactly
def to_unit(t: Any, bind: int, value: float) -> float:
    """Find the position, 0 to 1, that `from_unit` maps to a value, clamped to the span."""
    lo, hi = t.lo[bind], t.hi[bind]
    if int(t.curve[bind]) == POINTS:
        return inverted(t, bind, position_of(t, bind, fraction_of(t, bind, value)))
    return inverted(t, bind, unit_of(int(t.curve[bind]), value, lo, hi))


@compiled_exactly
def unit_of(curve: int, value: float, lo: float, hi: float) -> float:
    """Find the unit that a named curve maps to a value, clamped to the range."""
    if lo == hi:
        return 0.0
    value = min(max(value, min(lo, hi)), max(lo, hi))
    if curve == EXPONENTIAL:
        return log(value / lo) / log(hi / lo)
    unit = (value - lo) / (hi - lo)
    if curve == S:
        return 0.5 - sin(asin(1.0 - 2.0 * unit) / 3.0)
    return float(unit)


# -- curves by points -----------------------------------------------------------------------------


@compiled_exactly
def fraction_at(t: Any, bind: int, position: float) -> float:
    """Fraction of the span at a position; points may fall or stay the same."""
    first, points = int(t.first_point[bind]), int(t.points[bind])
    after = 1
    while after < points - 1 and t.x[first + after] <= position:
        after += 1
    x0, y0 = t.x[first + after - 1], t.y[first + after - 1]
    x1, y1 = t.x[first + after], t.y[first + after]
    return float(y1 if position >= x1 else y0 + (y1 - y0) * (position - x0) / (x1 - x0))


@compiled_exactly
def fraction_of(t: Any, bind: int, value: float) -> float:
    """Fraction of the span at a value, clamped to the fractions that the points reach."""
    first, points = int(t.first_point[bind]), int(t.points[bind])
    lo, hi = t.y[first], t.y[first]
    for i in range(1, points):
        lo, hi = min(lo, t.y[first + i]), max(hi, t.y[first + i])
    return float(min(max(unit_of(0, value, t.lo[bind], t.hi[bind]), lo), hi))


@compiled_exactly
def position_of(t: Any, bind: int, fraction: float) -> float:
    """The lowest position that the points map to a fraction of the span."""
    first, points = int(t.first_point[bind]), int(t.points[bind])
    for i in range(first, first + points - 1):
        x0, y0, x1, y1 = t.x[i], t.y[i], t.x[i + 1], t.y[i + 1]
        if y0 == fraction:
            return float(x0)
        if min(y0, y1) <= fraction <= max(y0, y1):
            return float(min(x0 + (x1 - x0) * (fraction - y0) / (y1 - y0), x1))
    return 1.0  # by rounding, past the last point


# -- soft take-over -------------------------------------------------------------------------------


@compiled_exactly
def picks_up(t: Any, bind: int, position: float, before: float, value: float) -> bool:
    """Whether a source moved from `before` (NaN: nowhere) reaches or passes a target's value."""
    here, there = fraction(t, bind, position), fraction_of_value(t, bind, value)
    if abs(here - there) <= PICKUP_WINDOW or t.lo[bind] == t.hi[bind]:
        return True
    if math.isnan(before):
        return False
    return bool((fraction(t, bind, before) - there) * (here - there) < 0.0)


@compiled_exactly
def fraction(t: Any, bind: int, position: float) -> float:
    """A position, by which two can be compared: points may fall or stay the same."""
    unit = inverted(t, bind, position)
    return fraction_at(t, bind, unit) if int(t.curve[bind]) == POINTS else unit


@compiled_exactly
def fraction_of_value(t: Any, bind: int, value: float) -> float:
    """A value, as `fraction` has positions."""
    if int(t.curve[bind]) == POINTS:
        return fraction_of(t, bind, value)
    return unit_of(int(t.curve[bind]), value, t.lo[bind], t.hi[bind])
