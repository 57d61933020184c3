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
    wanted. A corner that was not computed is taken to be as in `fill`.

    Parameters
    ----------
    shape : sequence of int
        Of the finest grid.
    refine : sequence of int
        Axes that are refined.
    levels, halved : int
        How often steps may be halved, and how often they were.
    known, kinds : ndarray
        Numbers of the points that are known, and the kind of each.
    """
    filled = fill(shape, refine, levels, known, kinds, halved)
    step = 2 ** (levels - halved)
    grid = _grid(filled, refine, step)
    numbers = np.arange(math.prod(shape)).reshape(shape)
    corners = [_shifted(grid, refine, offset) for offset in _offsets(refine)]
    differs = np.zeros(corners[0].shape, bool)
    for other in corners[1:]:
        differs |= other != corners[0]
    lowest = _shifted(_grid(numbers, refine, step), refine, (0,) * len(refine))[differs]
    places = [math.prod(shape[axis + 1 :]) for axis in refine]
    half = step // 2
    wanted = [
        lowest + sum(part * half * place for part, place in zip(parts, places, strict=True))
        for parts in itertools.product((0, 1, 2), repeat=len(refine))
    ]
    return np.setdiff1d(np.concatenate(wanted), known)


def fill(
    shape: Sequence[int],
    refine: Sequence[int],
    levels: int,
    known: Array,
    values: Array,
    halved: int | None = None,
) -> Array:
    """The values on the finest grid: a point that is not known is as the known one below it.

    Parameters
    ----------
    halved : int
        How often steps were halved so far; points of finer grids are left 0.

    Returns: ndarray [shape=shape].
    """
    source = np.full(math.prod(shape), -1, np.int64)
    source[known] = np.arange(len(known))
    source = source.reshape(shape)
    for level in range(levels if halved is None else halved):
        grid = _grid(source, refine, 2 ** (levels - level - 1))
        for axis in refine:
            odd, even = [slice(None)] * grid.ndim, [slice(None)] * grid.ndim
            odd[axis], even[axis] = slice(1, None, 2), slice(0, -1, 2)
            here = grid[tuple(odd)]
            here[...] = np.where(here < 0, grid[tuple(even)], here)
    found = np.asarray(values)[source]
    found[source < 0] = 0
    return found


def _grid(dense: Array, refine: Sequence[int], step: int) -> Array:
    """A view of every so many points along the refined axes."""
    part = [slice(None)] * dense.ndim
    for axis in refine:
        part[axis] = slice(None, None, step)
    return dense[tuple(part)]


def _offsets(refine: Sequence[int]) -> list[tuple[int, ...]]:
    return list(itertools.product((0, 1), repeat=len(refine)))


def _shifted(grid: Array, refine: Sequence[int], offset: Sequence[int]) -> Array:
    """One corner of each cell of a grid: the lowest, moved along some axes."""
    part = [slice(None)] * grid.ndim
    for axis, move in zip(refine, offset, strict=True):
        part[axis] = slice(move, grid.shape[axis] - 1 + move)
    return grid[tuple(part)]
