"""Delay lines: sound is kept in a ring, and read or written some frames at a time. Compiled.

Frames that lie in a row, up to the end of the ring and then from its beginning, become vectors.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly_apart

Array = Any


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
