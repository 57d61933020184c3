"""What a study varies, and which points to compute: a coarse grid, then finer ones at borders."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.errors import ParameterError
from yehu_server.util.documents import Fields
from yehu_server.util.values import brief, choice, number, whole

Array = Any

MAX_VALUES = 100_000  # of an axis
SPREADS = ("linear", "log")
Value = float | str


@dataclass(frozen=True)
class Axis:
    """A name that is varied, and its values in order."""

    name: str
    values: tuple[Value, ...]
    # How values lie between each other: "linear", "log", or "" for a list, between whose values
    # there are no others.
    spread: str = ""

    def refined(self, levels: int) -> Axis:
        """The axis with 2**levels steps where it has one. Raises ParameterError for a list."""
        if levels == 0:
            return self
        if not self.spread:
            raise ParameterError(f"{self.name}: a list of values cannot be refined; give a range")
        first, last = (float(value) for value in (self.values[0], self.values[-1]))
        steps = (len(self.values) - 1) * 2**levels + 1
        return spread_axis(self.name, first, last, steps, self.spread)

    def as_array(self) -> Array:
        """The values as an array [shape=(values,)], of numbers or text."""
        return np.array(self.values)


def spread_axis(name: str, first: float, last: float, steps: int, spread: str) -> Axis:
    """An axis of values from `first` to `last`, both with; raises ParameterError."""
    whole(steps, 2, MAX_VALUES)
    choice(spread, SPREADS)
    if not (math.isfinite(first) and math.isfinite(last)):
        raise ParameterError(f"{first} to {last} is not finite")
    if spread == "log" and first * last <= 0.0:
        raise ParameterError(f"a log spread from {first:g} to {last:g} is impossible")
    part = np.arange(steps) / (steps - 1)
    values = first * (last / first) ** part if spread == "log" else first + (last - first) * part
    values[-1] = last
    return Axis(name, tuple(values.tolist()), spread)


def axis_of(text: str) -> Axis:
    """Read --vary: ``NAME=V1,V2,...``, ``NAME=FROM:TO:STEPS`` or ``NAME=FROM:TO:STEPS:log``.

    Raises ParameterError where the text has another form.
    """
    name, equals, values = (part.strip() for part in text.partition("="))
    if not equals or not all(name.split(".")):
        raise ParameterError(
            f"--vary {text}: expected NAME=V1,V2,... or NAME=FROM:TO:STEPS, or with :log after it"
        )
    parts = values.split(":")
    try:
        if len(parts) in {3, 4}:
            spread = parts[3] if len(parts) == 4 else "linear"
            return spread_axis(name, float(parts[0]), float(parts[1]), int(parts[2]), spread)
        return Axis(name, tuple(_value(value) for value in values.split(",")))
    except ParameterError as error:
        raise ParameterError(f"--vary {text}: {error}") from error
    except ValueError:
        raise ParameterError(f"--vary {text}: expected numbers after {name}=") from None


def _value(text: str) -> Value:
    """A number, or a word such as the name of a friction law."""
    text = text.strip()
    return text if text.replace("-", "").isalpha() else float(text)


def axis_from(name: str, entry: Any) -> Axis:
    """Read an axis of a study: a list, or from, to, steps and spread; raises ParameterError."""
    if isinstance(entry, list):
        if not 1 <= len(entry) <= MAX_VALUES:
            raise ParameterError(f"expected 1 to {MAX_VALUES} values")
        return Axis(name, tuple(x if isinstance(x, str) else number(x) for x in entry))
    if not isinstance(entry, Mapping):
        raise ParameterError(f"expected a list, or from, to and steps, got {brief(entry)}")
    table = Fields(entry)
    table.refuse_others("from", "to", "steps", "spread")
    first, last = table.need("from", number), table.need("to", number)
    steps = table.need("steps", whole, 2, MAX_VALUES)
    return spread_axis(name, first, last, steps, table.read("spread", choice, "linear", SPREADS))


def coarse_points(shape: Sequence[int], refine: Sequence[int], levels: int) -> Array:
    """Numbers of the points before any step is halved, in order [dtype=int64].

    A point's number is that of its place on the finest grid, the last axis changing fastest.
    """
    grid = _grid(np.arange(math.prod(shape)).reshape(shape), refine, 2**levels)
    return grid.reshape(-1).copy()


def finer_points(
    shape: Sequence[int],
    refine: Sequence[int],
    levels: int,
    halved: int,
    known: Array,
    kinds: Array,
) -> Array:
    """Numbers of the points that halve a step once more where kinds differ, in order.

    Wherever the corners of a cell are not all of one kind, all points that halve its edges are
    wanted. A corner that was not computed is taken to be as in `fill`. The shape is that of the
    finest grid, of which some axes are refined; steps may be halved `levels` times, and were
    `halved`. The points of some numbers are known, and the kind of each.
    """
    step = 2 ** (levels - halved)
    least = most = _grid(fill(shape, refine, levels, known, kinds, halved), refine, step)
    for axis in refine:
        lower, upper = _along(axis, slice(None, -1)), _along(axis, slice(1, None))
        least = np.minimum(least[lower], least[upper])
        most = np.maximum(most[lower], most[upper])
    differs = least != most
    wanted = np.zeros(shape, bool)
    halves = _grid(wanted, refine, step // 2)
    for offset in itertools.product((0, 1, 2), repeat=len(refine)):
        corner = halves
        for axis, move in zip(refine, offset, strict=True):
            corner = corner[_along(axis, slice(move, move + 2 * differs.shape[axis] - 1, 2))]
        corner |= differs
    return np.setdiff1d(np.flatnonzero(wanted), known)


def fill(
    shape: Sequence[int],
    refine: Sequence[int],
    levels: int,
    known: Array,
    values: Array,
    halved: int | None = None,
) -> Array:
    """The values on the finest grid: a point that is not known is as the known one below it.

    Steps were `halved` so often so far; points of finer grids are left 0. Returns an ndarray
    [shape=shape].
    """
    source = np.full(math.prod(shape), -1, np.int64)
    source[known] = np.arange(len(known))
    source = source.reshape(shape)
    for level in range(levels if halved is None else halved):
        grid = _grid(source, refine, 2 ** (levels - level - 1))
        for axis in refine:
            here = grid[_along(axis, slice(1, None, 2))]
            here[...] = np.where(here < 0, grid[_along(axis, slice(0, -1, 2))], here)
    found = np.asarray(values)[source]
    found[source < 0] = 0
    return found


def _grid(dense: Array, refine: Sequence[int], step: int) -> Array:
    """A view of every so many points along the refined axes."""
    for axis in refine:
        dense = dense[_along(axis, slice(None, None, step))]
    return dense


def _along(axis: int, part: slice) -> tuple[slice, ...]:
    """The index of a part of an array along one axis."""
    return (slice(None),) * axis + (part,)
