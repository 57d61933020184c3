"""Which points of a study to compute: a coarse grid first, then halves of steps at borders."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

Array = Any


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
