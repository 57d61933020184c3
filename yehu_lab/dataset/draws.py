"""The random values of a data set: their distributions, and a reproducible draw for each sound.

A draw depends on the seed, the number of the sound and the name of the value alone. So it is the
same in any order, on any machine and with any library; another entry in the description, or more
sounds, change no other draw.
"""

import bisect
import hashlib
import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import NormalDist
from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.util.documents import Fields
from yehu_server.util.values import choice, number

MAX_CHOICES = 1000
NORMAL = ("mean", "deviation", "from", "to")


def chance(seed: int, number: int, name: str) -> float:
    """Draw a number from 0 to below 1, evenly."""
    digest = hashlib.sha256(f"{seed}/{number}/{name}".encode()).digest()
    return (int.from_bytes(digest[:8], "big") >> 11) / 2**53


@dataclass(frozen=True)
class Distribution:
    """How a value is drawn: its bounds, and its value for a number drawn from 0 to below 1."""

    lo: float
    hi: float
    value: Callable[[float], float]
    is_whole: bool  # whether all values are whole numbers


def constant(value: float) -> Distribution:
    """A value that is always the same."""
    return Distribution(value, value, partial(_even, value, value), value == int(value))


# They travel to other processes with the description, as closures could not.


def _even(lo: float, hi: float, share: float) -> float:
    return lo + (hi - lo) * share


def _whole(lo: float, hi: float, share: float) -> float:
    return lo + int(share * (hi - lo + 1))


def _by_ratio(lo: float, hi: float, share: float) -> float:
    return float(lo * (hi / lo) ** share)


def _chosen(values: Sequence[float], upto: Sequence[float], share: float) -> float:
    return values[min(bisect.bisect_right(upto, share), len(values) - 1)]


def _normal(normal: NormalDist, lo: float, hi: float, share: float) -> float:
    below, upto = normal.cdf(lo), normal.cdf(hi)
    drawn = min(max(below + (upto - below) * share, 1e-12), 1.0 - 1e-12)
    return min(max(normal.inv_cdf(drawn), lo), hi)


SPACINGS = {"even": _even, "ratio": _by_ratio, "whole": _whole}


def read_distribution(entry: Any) -> Distribution:
    """Read how a value is drawn, as docs/dataset.md describes; raises ParameterError."""
    if not isinstance(entry, Mapping):
        return constant(number(entry))
    table, names = Fields(entry), entry.keys()
    if "choose" in names and names <= {"choose", "weights"}:
        values = table.need("choose", numbers)
        even = shares_of([1.0] * len(values))
        upto = table.read("weights", _weights, even, len(values))
        is_whole = all(value == int(value) for value in values)
        return Distribution(min(values), max(values), partial(_chosen, values, upto), is_whole)
    if names == set(NORMAL):
        mean, deviation, lo, hi = (table.need(name, number) for name in NORMAL)
        if not (deviation > 0.0 and lo < hi):
            raise ParameterError("deviation must be above 0, and from below to")
        normal = NormalDist(mean, deviation)
        if not normal.cdf(hi) > normal.cdf(lo):
            raise ParameterError("from and to are too far from the mean")
        return Distribution(lo, hi, partial(_normal, normal, lo, hi), is_whole=False)
    if not {"from", "to"} <= names <= {"from", "to", "spacing"}:
        raise ParameterError(
            "expected a number, {from, to}, {from, to, spacing}, {choose}, "
            "{choose, weights} or {mean, deviation, from, to}"
        )
    spacing = table.read("spacing", choice, "even", tuple(SPACINGS))
    lo, hi = table.need("from", number), table.need("to", number)
    if lo > hi:
        raise ParameterError("from is above to")
    if spacing == "whole" and (lo != int(lo) or hi != int(hi)):
        raise ParameterError("from and to must be whole numbers")
    if spacing == "ratio" and lo <= 0.0:
        raise ParameterError("by ratio, from must be above 0")
    is_whole = spacing == "whole" or lo == hi == int(lo)
    return Distribution(lo, hi, partial(SPACINGS[spacing], lo, hi), is_whole)


def _weights(value: Any, count: int) -> tuple[float, ...]:
    weights = numbers(value)
    if len(weights) != count:
        raise ParameterError(f"expected {count} weights, one for each choice")
    return shares_of(weights)


def shares_of(weights: Sequence[float]) -> tuple[float, ...]:
    """Sums of weights, the last of which is 1. Raises ParameterError where they are no weights."""
    if min(weights) < 0.0 or not sum(weights) > 0.0:
        raise ParameterError("weights must be 0 or more, and not all 0")
    return tuple(total / sum(weights) for total in itertools.accumulate(weights))


def numbers(value: Any) -> list[float]:
    """A list of numbers, not empty. Raises ParameterError where it is none."""
    if not isinstance(value, list) or not 0 < len(value) <= MAX_CHOICES:
        raise ParameterError(f"expected a list of 1 to {MAX_CHOICES} numbers")
    return [number(each) for each in value]
