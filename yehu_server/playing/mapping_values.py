"""Readers of the values in a mapping file; all raise ParameterError for a wrong one."""

from __future__ import annotations

import itertools
import math
from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import find
from yehu_server.playing.bind import Breakpoints
from yehu_server.playing.sources import CHANNELS
from yehu_server.util.documents import Fields
from yehu_server.util.values import brief, choice, number, whole

LONGEST_SMOOTHING_MS = 5000.0
MOST_POINTS = 1024


def settable_param(address: str, instead: str) -> Param:
    """Find a parameter that the player does not move; `instead` begins the advice in the error."""
    param = find(address)
    if param.owned:
        raise ParameterError(f"{address} is moved by the player; {instead} under /playing")
    return param


def settings(table: Fields) -> tuple[tuple[str, float], ...]:
    """Read a table of addresses and the values that they start with."""
    return tuple(table.each(_start).items())


def _start(address: str, value: Any) -> float:
    return settable_param(address, "set one").within(value)


def span(value: Any, param: Param | None) -> tuple[float, float]:
    """Read two values within the range of a parameter, if that is known."""
    lo, hi = (param.lo, param.hi) if param else (-math.inf, math.inf)
    return pair(value, "[from, to]", lo, hi)


def input_range(value: Any) -> tuple[float, float]:
    """Read two different numbers."""
    lo, hi = pair(value, "[from, to]")
    if not 0.0 < abs(hi - lo) < math.inf:
        raise ParameterError(f"expected two different numbers, got {brief(value)}")
    return lo, hi


def pair(value: Any, form: str, lo: float = -math.inf, hi: float = math.inf) -> tuple[float, float]:
    """Read a list of two numbers within bounds."""
    if not isinstance(value, list) or len(value) != 2:
        raise ParameterError(f"expected {form}, got {brief(value)}")
    return number(value[0], lo, hi), number(value[1], lo, hi)


def curve(value: Any) -> Curve | Breakpoints:
    """Read a curve by its name or by its points."""
    if isinstance(value, list):
        return _breakpoints(value)
    return Curve(choice(value, [known.value for known in Curve]))


def _breakpoints(value: list[Any]) -> Breakpoints:
    points = tuple(pair(point, "points [from, to]", 0.0, 1.0) for point in value)
    positions = [position for position, _ in points]
    if len(positions) < 2 or (positions[0], positions[-1]) != (0.0, 1.0):
        raise ParameterError("the points have to begin at 0 and end at 1")
    if any(later <= position for position, later in itertools.pairwise(positions)):
        raise ParameterError("each point has to lie beyond the one before it")
    if len(points) > MOST_POINTS:
        raise ParameterError(f"{len(points)} points are more than {MOST_POINTS}")
    return Breakpoints(points)


def channels(value: Any) -> tuple[int, ...]:
    """Read one MIDI channel or several."""
    numbers = value if isinstance(value, list) else [value]
    if not numbers:
        raise ParameterError("expected a channel or several, got []")
    return tuple(sorted({whole(each, 1, CHANNELS) for each in numbers}))
