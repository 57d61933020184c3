"""Check and convert the values in a mapping file; all raise ParameterError for a wrong one."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import find
from yehu_server.playing.binds import Breakpoints

LONGEST_SMOOTHING_MS = 5000.0
MOST_POINTS = 1024


def line_of_text(name: str) -> Callable[[Any], Any]:
    """Make a reader of a line of text."""

    def read(value: Any) -> str:
        if not isinstance(value, str) or not value.isprintable():
            raise ParameterError(f"{name}: expected a line of text, got {_brief(value)}")
        return value

    return read


def boolean(name: str) -> Callable[[Any], Any]:
    """Make a reader of true or false."""

    def read(value: Any) -> bool:
        if not isinstance(value, bool):
            raise ParameterError(f"{name}: expected true or false, got {_brief(value)}")
        return value

    return read


def settable_param(address: str, instead: str) -> Param:
    """Find a parameter that the player does not move; `instead` begins the advice in the error."""
    param = find(address)
    if param.owned:
        raise ParameterError(f"{address} is moved by the player; {instead} under /playing")
    return param


def start(address: str, value: Any) -> float:
    """Read the value that a parameter starts with."""
    param = settable_param(address, "set one")
    if param.accept(value) != value:
        raise ParameterError(f"{address}: {value} is not within {param.range_text}")
    return float(value)


def _number(value: Any) -> float | None:
    """A finite number; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def span(value: Any, param: Param | None) -> tuple[float, float]:
    """Read two values within the range of a parameter, if that is known."""
    ends = _pair(value, "span: expected [from, to]")
    for end in ends:
        if param is not None and not param.lo <= end <= param.hi:  # also refuses NaN
            within = f"{param.lo:g} to {param.hi:g}"
            raise ParameterError(f"span: {_brief(end)} is not within {within}")
    return (float(ends[0]), float(ends[1])) if param else (0.0, 0.0)


def input_range(value: Any) -> tuple[float, float]:
    """Read two different numbers."""
    numbers = [_number(end) for end in _pair(value, "input: expected [from, to]")]
    lo, hi = numbers
    if lo is None or hi is None or not 0.0 < abs(hi - lo) < math.inf:
        raise ParameterError(f"input: expected two different numbers, got {_brief(value)}")
    return lo, hi


def _pair(value: Any, expected: str) -> list[Any]:
    is_numbers = isinstance(value, list) and all(
        isinstance(end, int | float) and not isinstance(end, bool) for end in value
    )
    if not is_numbers or len(value) != 2:
        raise ParameterError(f"{expected}, got {_brief(value)}")
    return list(value)


def curve(value: Any) -> Curve | Breakpoints:
    """Read a curve by its name or by its points."""
    if isinstance(value, list):
        return _breakpoints(value)
    try:
        return Curve(value)
    except ValueError:
        names = ", ".join(known.value for known in Curve)
        raise ParameterError(
            f"unknown curve {_brief(value)} (known: {names}, or a table of points)"
        ) from None


def _breakpoints(value: list[Any]) -> Breakpoints:
    points: list[tuple[float, float]] = []
    for point in value:
        pair = [_number(part) for part in point] if isinstance(point, list) else []
        if len(pair) != 2 or pair[0] is None or pair[1] is None:
            raise ParameterError(f"curve: expected points [from, to], got {_brief(point)}")
        if not 0.0 <= min(pair[0], pair[1]) <= max(pair[0], pair[1]) <= 1.0:
            raise ParameterError(f"curve: {_brief(point)} is not within 0 to 1")
        points.append((pair[0], pair[1]))
    positions = [position for position, _ in points]
    if len(positions) < 2 or (positions[0], positions[-1]) != (0.0, 1.0):
        raise ParameterError("curve: the points have to begin at 0 and end at 1")
    if any(later <= position for position, later in itertools.pairwise(positions)):
        raise ParameterError("curve: each point has to lie beyond the one before it")
    if len(points) > MOST_POINTS:
        raise ParameterError(f"curve: {len(points)} points are more than {MOST_POINTS}")
    return Breakpoints(tuple(points))


def smoothing(value: Any) -> float:
    """Read a time (ms)."""
    number = _number(value)
    if number is None or not 0.0 <= number <= LONGEST_SMOOTHING_MS:
        raise ParameterError(
            f"smoothing: expected 0 to {LONGEST_SMOOTHING_MS:g} ms, got {_brief(value)}"
        )
    return number


def channels(value: Any) -> tuple[int, ...]:
    """Read one MIDI channel or several, 1 to 16."""
    numbers = value if isinstance(value, list) else [value]
    is_right = bool(numbers) and all(
        isinstance(number, int) and not isinstance(number, bool) and 1 <= number <= 16
        for number in numbers
    )
    if not is_right:
        raise ParameterError(f"channel: expected 1 to 16, or a list of such, got {_brief(value)}")
    return tuple(sorted(set(numbers)))


def _brief(value: Any) -> str:
    """A value for an error message, cut short."""
    try:
        text = repr(value)
    except ValueError:  # more digits than Python prints
        return "a very large number"
    return text if len(text) <= 80 else f"{text[:77]}..."
