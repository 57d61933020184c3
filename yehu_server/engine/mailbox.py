"""Lock-free queues of events to the instrument, and of reports of applied ones. Compiled.

Players post events to a ring; the audio side moves them to a heap in the order of their frames,
and reports applied events in a second ring. Each ring has one writer and one reader. Each moves
only its own cursor, after it has written or read the entry, so neither waits. Events for a full
ring are dropped and counted.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled

Array = Any

RING = 1 << 16  # events; powers of two
HEAP = 1 << 14
# Limits on the work of a callback: events moved to the heap for each 64 frames, and events applied
# at one frame. The rest waits for the next.
LIVE_BUDGET, APPLIED_AT_ONCE = 1 << 10, 64

EVENT = np.dtype(
    [("frame", np.int64), ("index", np.int64), ("target", np.float64), ("ramp", np.int64)]
)
WAITING = np.dtype([*EVENT.descr, ("order", np.int64)])
LINE = 8  # words of a cache line: the two sides' cursors lie in different ones

MAIL = np.dtype(
    [
        ("posted", np.int64, LINE),  # number of events posted; written by players, as the next
        ("dropped", np.int64, LINE),
        ("read", np.int64, LINE),  # number of reports read; written by their reader
        ("drained", np.int64, LINE),  # written by the audio side, as all below
        ("reported", np.int64, LINE),
        ("unreported", np.int64),
        ("late", np.int64),
        ("applied", np.int64),
        ("waiting", np.int64),  # entries in the heap
        ("reporting", np.int64),
        ("budget", np.int64),  # events moved to the heap at a time
    ],
    align=True,
)


@compiled
def wait(
    heap: Array, waiting: int, frame: int, index: int, target: float, ramp: int, order: int
) -> None:
    """Add an event to a heap of `waiting` entries. Real time: safe; log(waiting) steps."""
    hole = waiting
    while hole > 0:
        parent = (hole - 1) // 2
        if heap[parent].frame <= frame:  # at one frame, the older event comes first
            break
        heap[hole] = heap[parent]
        hole = parent
    entry = heap[hole]
    entry.frame, entry.index, entry.target, entry.ramp = frame, index, target, ramp
    entry.order = order


@compiled
def leave(heap: Array, waiting: int) -> None:
    """Remove the first event from a heap of `waiting` entries. Real time: safe."""
    end = waiting - 1
    last = heap[end]
    hole = 0
    while 2 * hole + 1 < end:
        child = 2 * hole + 1
        if child + 1 < end and is_before(heap[child + 1], heap[child]):
            child += 1
        if not is_before(heap[child], last):
            break
        heap[hole] = heap[child]
        hole = child
    heap[hole] = last


@compiled
def is_before(one: Any, other: Any) -> bool:
    """Whether one event comes before another: by frame, then in the order posted."""
    return bool(one.frame < other.frame or (one.frame == other.frame and one.order < other.order))
