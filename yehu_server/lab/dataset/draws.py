"""The random values of a data set: their distributions, and a reproducible draw for each sound.

A draw depends on the seed, the number of the sound and the name of the value alone. So it is the
same in any order, on any machine and with any library; another entry in the description, or more
sounds, change no other draw.
"""

from __future__ import annotations

import bisect
import hashlib
import itertools
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.util.documents import Fields
from yehu_server.util.values import choice, number

MOST_CHOICES = 1000


def chance(seed: int, number: int, name: str) -> float:
    """Draw a number from 0 to below 1, evenly."""
    digest = hashlib.sha256(f"{seed}/{number}/{name}".encode()).digest()
    return (int.from_bytes(digest[:8], "big") >> 11) / 2**53


@dataclass(frozen=True)
class Distribution(ABC):
    """How a value is drawn: from one number to another."""

    lo: float
    hi: float

    @abstractmethod
    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers."""
        return self.lo == self.hi == int(self.lo)


@dataclass(frozen=True)
class Uniform(Distribution):
    """Even by the difference ("even") or the ratio ("ratio"), or each "whole" number alike."""

    spacing: str = "even"

    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""
        if self.spacing == "whole":
            return self.lo + int(share * (self.hi - self.lo + 1))
        if self.spacing == "ratio":
            return float(self.lo * (self.hi / self.lo) ** share)
        return self.lo + (self.hi - self.lo) * share

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers."""
        return self.spacing == "whole" or super().is_whole


@dataclass(frozen=True)
class Choice(Distribution):
    """One of some numbers, by their weights."""

    values: tuple[float, ...]
    upto: tuple[float, ...]  # sums of the weights, of 1 in all

    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""
        place = bisect.bisect_right(self.upto, share)
        return self.values[min(place, len(self.values) - 1)]

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers."""
        return all(value == int(value) for value in self.values)


@dataclass(frozen=True)
class Normal(Distribution):
    """Normally distributed, without what is beyond two ends."""

    mean: float
    deviation: float

    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""
        normal = NormalDist(self.mean, self.deviation)
        below, upto = normal.cdf(self.lo), normal.cdf(self.hi)
        drawn = min(max(below + (upto - below) * share, 1e-12), 1.0 - 1e-12)
        return min(max(normal.inv_cdf(drawn), self.lo), self.hi)


def read_distribution(entry: Any) -> Distribution:
    """Read how a value is drawn: a number, or a table as docs/dataset.md describes.

    Raises ParameterError where it is none of them.
    """
    if not isinstance(entry, Mapping):
        value = number(entry)
        return Uniform(value, value)
    table, names = Fields(entry), entry.keys()
    if "choose" in names and names <= {"choose", "weights"}:
        values = table.need("choose", numbers)
        even = shares_of([1.0] * len(values))
        upto = table.read("weights", _weights, even, len(values))
        return Choice(min(values), max(values), tuple(values), upto)
    if names == set(NORMAL):
        return _normal(*(table.need(name, number) for name in NORMAL))
    if not {"from", "to"} <= names <= {"from", "to", "spacing"}:
        raise ParameterError(
            "expected a number, {from, to}, {from, to, spacing}, {choose}, "
            "{choose, weights} or {mean, deviation, from, to}"
        )
    spacing = table.read("spacing", choice, "even", ("even", "ratio", "whole"))
    return _between(table.need("from", number), table.need("to", number), spacing)


NORMAL = ("mean", "deviation", "from", "to")


def _normal(mean: float, deviation: float, lo: float, hi: float) -> Normal:
    if not (deviation > 0.0 and lo < hi):
        raise ParameterError("deviation above 0, and from below to")
    if not NormalDist(mean, deviation).cdf(hi) > NormalDist(mean, deviation).cdf(lo):
        raise ParameterError("nothing is drawn so far from the mean")
    return Normal(lo, hi, mean, deviation)


def _between(lo: float, hi: float, spacing: str) -> Uniform:
    if lo > hi:
        raise ParameterError("from is above to")
    if spacing == "whole" and (lo != int(lo) or hi != int(hi)):
        raise ParameterError("from and to are whole numbers")
    if spacing == "ratio" and lo <= 0.0:
        raise ParameterError("by ratio, from is above 0")
    return Uniform(lo, hi, spacing)


def _weights(value: Any, count: int) -> tuple[float, ...]:
    weights = numbers(value)
    if len(weights) != count:
        raise ParameterError("as many as are to choose from")
    return shares_of(weights)


def shares_of(weights: Sequence[float]) -> tuple[float, ...]:
    """Sums of weights, the last of which is 1. Raises ParameterError where they are no weights."""
    if min(weights) < 0.0 or not sum(weights) > 0.0:
        raise ParameterError("numbers from 0, not all of them 0")
    return tuple(total / sum(weights) for total in itertools.accumulate(weights))


def numbers(value: Any) -> list[float]:
    """A list of numbers, not empty. Raises ParameterError where it is none."""
    if not isinstance(value, list) or not 0 < len(value) <= MOST_CHOICES:
        raise ParameterError(f"expected a list of 1 to {MOST_CHOICES} numbers")
    return [number(each) for each in value]
