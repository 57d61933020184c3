"""Check values in documents. All raise ParameterError for a wrong one, without its place."""

import math
from collections.abc import Callable, Collection
from datetime import date, time
from typing import Any

from yehu_server.errors import ParameterError, did_you_mean

MAX_SHOWN = 80  # characters of a value in an error


def number(value: Any, lo: float = -math.inf, hi: float = math.inf, unit: str = "") -> float:
    """A finite number within bounds; raises ParameterError."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ParameterError(f"expected a number, got {brief(value)}")
    try:
        found = float(value)
    except OverflowError:
        found = math.inf
    if not math.isfinite(found):
        raise ParameterError(f"{brief(value)} is not finite")
    if not lo <= found <= hi:
        unit = f" {unit}" if unit not in ("", "1") else ""
        raise ParameterError(f"{brief(value)} is not within {lo:g} to {hi:g}{unit}")
    return found


def whole(value: Any, lo: int, hi: int) -> int:
    """A whole number within bounds; raises ParameterError."""
    if isinstance(value, bool) or not isinstance(value, int) or not lo <= value <= hi:
        raise ParameterError(f"expected a whole number from {lo} to {hi}, got {brief(value)}")
    return value


def line(value: Any) -> str:
    """A line of text; raises ParameterError."""
    if not isinstance(value, str) or not value.isprintable():
        raise ParameterError(f"expected a line of text, got {brief(value)}")
    return value


def words(value: Any) -> str:
    """A text with single spaces in place of line ends and spaces; raises ParameterError."""
    if not isinstance(value, str):
        raise ParameterError(f"expected a line of text, got {brief(value)}")
    return " ".join(value.split())


def flag(value: Any) -> bool:
    """True or false; raises ParameterError."""
    if not isinstance(value, bool):
        raise ParameterError(f"expected true or false, got {brief(value)}")
    return value


def choice(value: Any, known: Collection[str]) -> str:
    """One of some words; raises ParameterError, with a similar one if there is one."""
    if not isinstance(value, str) or value not in known:
        hint = did_you_mean(value, known)
        raise ParameterError(f"{brief(value)} is not one of {', '.join(known)}{hint}")
    return value


def choices(value: Any, known: Collection[str]) -> list[str]:
    """A list of such words; raises ParameterError."""
    if not isinstance(value, list):
        raise ParameterError(f"expected a list of some of {', '.join(known)}, got {brief(value)}")
    return [choice(each, known) for each in value]


def _shown(value: Any) -> str:
    """A value as files write it, not as Python does."""
    if isinstance(value, bool | date | time):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(_shown, value[:MAX_SHOWN]))}]"
    if isinstance(value, dict):
        return "a table"
    return repr(value)


def brief(value: Any, text_of: Callable[[Any], str] = _shown) -> str:
    """A value for an error, cut short."""
    try:
        text = text_of(value)
    except ValueError:  # more digits than Python prints
        return "a very large number"
    return text if len(text) <= MAX_SHOWN else f"{text[: MAX_SHOWN - 3]}..."
