"""The random values of a data set: their distributions, and a reproducible draw for each sound.

A draw depends on the seed, the number of the sound and the name of the value alone. So it is the
same in any order, on any machine and with any library; another entry in the description, or more
sounds, change no other draw.
"""

from __future__ import annotations

import bisect
import hashlib
import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any, Protocol

from yehu_server.errors import ParameterError
from yehu_server.util.documents import Fields
from yehu_server.util.values import choice, number

MOST_CHOICES = 1000


def chance(seed: int, number: int, name: str) -> float:
    """Draw a number from 0 to below 1, evenly."""
    digest = hashlib.sha256(f"{seed}/{number}/{name}".encode()).digest()
    return (int.from_bytes(digest[:8], "big") >> 11) / 2**53


class Distribution(Protocol):
    """How a value is drawn."""

    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""
        ...

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest value."""
        ...

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers."""
        ...


@dataclass(frozen=True)
class UniformReal:
    """Even from one number to another, by their difference or by their ratio."""

    lo: float
    hi: float
    by_ratio: bool = False

    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""
        if self.by_ratio:
            return float(self.lo * (self.hi / self.lo) ** share)
        return self.lo + (self.hi - self.lo) * share

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest value."""
        return self.lo, self.hi

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers."""
        return self.lo == self.hi == int(self.lo)


@dataclass(frozen=True)
class UniformInteger:
    """Each whole number from one to another alike."""

    lo: int
    hi: int

    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""
        return float(self.lo + int(share * (self.hi - self.lo + 1)))

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest value."""
        return float(self.lo), float(self.hi)

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers."""
        return True


@dataclass(frozen=True)
class Choice:
    """One of some numbers, by their weights."""

    values: tuple[float, ...]
    upto: tuple[float, ...]  # sums of the weights, of 1 in all

    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""
        place = bisect.bisect_right(self.upto, share)
        return self.values[min(place, len(self.values) - 1)]

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest value."""
        return min(self.values), max(self.values)

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers."""
        return all(value == int(value) for value in self.values)


@dataclass(frozen=True)
class Normal:
    """Normally distributed, without what is beyond two ends."""

    mean: float
    deviation: float
    lo: float
    hi: float

    def value(self, share: float) -> float:
        """The value for a number drawn from 0 to below 1."""
        normal = NormalDist(self.mean, self.deviation)
        below, upto = normal.cdf(self.lo), normal.cdf(self.hi)
        drawn = min(max(below + (upto - below) * share, 1e-12), 1.0 - 1e-12)
        return min(max(normal.inv_cdf(drawn), self.lo), self.hi)

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest value."""
        return self.lo, self.hi

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers."""
        return False


def read_distribution(entry: Any) -> Distribution:
    """Read how a value is drawn: a number, or a table as docs/dataset.md describes.

    Raises
    ------
    ParameterError
        Where it is none of them.
    """
    if not isinstance(entry, Mapping):
        value = number(entry)
        return UniformReal(value, value)
    table, names = Fields(entry), entry.keys()
    if "choose" in names and names <= {"choose", "weights"}:
        values = table.need("choose", numbers)
        return Choice(tuple(values), table.read("weights", _weights, _even(values), len(values)))
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
    return Normal(mean, deviation, lo, hi)


def _between(lo: float, hi: float, spacing: str) -> UniformReal | UniformInteger:
    if lo > hi:
        raise ParameterError("from is above to")
    if spacing == "whole":
        if lo != int(lo) or hi != int(hi):
            raise ParameterError("from and to are whole numbers")
        return UniformInteger(int(lo), int(hi))
    if spacing == "ratio" and lo <= 0.0:
        raise ParameterError("by ratio, from is above 0")
    return UniformReal(lo, hi, by_ratio=spacing == "ratio")


def _even(values: Sequence[float]) -> tuple[float, ...]:
    return shares_of([1.0] * len(values))


def _weights(value: Any, count: int) -> tuple[float, ...]:
    weights = numbers(value)
    if len(weights) != count:
        raise ParameterError("as many as are to choose from")
    return shares_of(weights)


def shares_of(weights: Sequence[float]) -> tuple[float, ...]:
    """Sums of weights, the last of which is 1.

    Raises
    ------
    ParameterError
        Where they are no weights.
    """
    if min(weights) < 0.0 or not sum(weights) > 0.0:
        raise ParameterError("numbers from 0, not all of them 0")
    return tuple(total / sum(weights) for total in itertools.accumulate(weights))


def numbers(value: Any) -> list[float]:
    """A list of numbers, not empty.

    Raises
    ------
    ParameterError
        Where it is none.
    """
    if not isinstance(value, list) or not 0 < len(value) <= MOST_CHOICES:
        raise ParameterError(f"expected a list of 1 to {MOST_CHOICES} numbers")
    return [number(each) for each in value]
