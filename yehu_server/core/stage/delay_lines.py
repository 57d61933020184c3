"""The arithmetic of a room's delay lines: rings, filters, and the matrix that mixes. Compiled.

Each function works on rows: what one line gives in each of the frames that are computed at once.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, compiled_exactly_apart

Array = Any

LINES = 16


@compiled_exactly_apart
def read_ring(row: Array, ring: Array, start: int, mask: int, frames: int) -> None:
    """Read frames of a ring into a row, from a frame on."""
    at, count = np.uint64(start & mask), np.uint64(frames)
    before_end = min(count, np.uint64(mask + 1) - at)
    for n in range(before_end):
        row[n] = ring[at + n]
    for n in range(before_end, count):
        row[n] = ring[n - before_end]


@compiled_exactly_apart
def add_ring(row: Array, ring: Array, start: int, mask: int, gain: float, frames: int) -> None:
    """Add frames of a ring to a row, from a frame on."""
    at, count = np.uint64(start & mask), np.uint64(frames)
    before_end = min(count, np.uint64(mask + 1) - at)
    for n in range(before_end):
        row[n] += gain * ring[at + n]
    for n in range(before_end, count):
        row[n] += gain * ring[n - before_end]


@compiled_exactly_apart
def write_ring(ring: Array, row: Array, start: int, mask: int, frames: int) -> None:
    """Write a row into a ring, from a frame on."""
    at, count = np.uint64(start & mask), np.uint64(frames)
    before_end = min(count, np.uint64(mask + 1) - at)
    for n in range(before_end):
        ring[at + n] = row[n]
    for n in range(before_end, count):
        ring[n - before_end] = row[n]


@compiled_exactly_apart
def blend(row: Array, was: Array, share: Array, frames: int) -> None:
    """Blend a row with what it was, by a share for each frame."""
    for n in range(np.uint64(frames)):
        row[n] += share[n] * (was[n] - row[n])


@compiled_exactly_apart
def absorb(row: Array, b_0: Array, b_1: Array, a_1: Array, state: Array, frames: int) -> None:
    """Apply the absorption of air and walls to each line's output: a first-order filter."""
    for n in range(np.uint64(frames)):
        for i in range(LINES):
            x = row[i, n]
            y = b_0[i] * x + state[i]
            state[i] = b_1[i] * x - a_1[i] * y
            row[i, n] = y


@compiled_exactly_apart
def read_lines(row: Array, gain: Array, heard: Array, frames: int) -> None:
    """Write the output for both ears: the left has the even lines, the right the odd ones."""
    for n in range(np.uint64(frames)):
        for ear in range(2):
            plus = (row[ear, n] + row[ear + 2, n]) + (row[ear + 4, n] + row[ear + 6, n])
            minus = (row[ear + 8, n] + row[ear + 10, n]) + (row[ear + 12, n] + row[ear + 14, n])
            heard[n, ear] = gain[n] * (plus - minus)


@compiled_exactly
def mix(row: Array, frames: int) -> None:
    """Multiply LINES rows by an orthogonal matrix, in place: all its entries are 1/4 or -1/4.

    It is the Kronecker product of two Householder reflections of four values, so that each line
    feeds all lines alike.
    """
    for j in range(4):
        reflect(row[j], row[4 + j], row[8 + j], row[12 + j], frames)
    for i in range(0, LINES, 4):
        reflect(row[i], row[i + 1], row[i + 2], row[i + 3], frames)


@compiled_exactly_apart
def reflect(a: Array, b: Array, c: Array, d: Array, frames: int) -> None:
    """Reflect four rows about their mean, in place."""
    for n in range(np.uint64(frames)):
        half = 0.5 * ((a[n] + b[n]) + (c[n] + d[n]))
        a[n] -= half
        b[n] -= half
        c[n] -= half
        d[n] -= half
