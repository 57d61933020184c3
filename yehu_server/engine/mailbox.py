"""Events on their way to the instrument and back, without locks. Compiled.

Whoever plays posts events into one ring; the audio side drains it into a heap in order of
frames, and reports what it applied in a second ring. Each ring has one writer and one reader,
each of whom moves only its own cursor, and only after it has touched the entry: so neither
ever waits. A full ring drops what comes and counts it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled

Array = Any

RING = 1 << 16  # events; powers of two
HEAP = 1 << 14
# Bounds on what one callback does: events drained for each 64 frames, and events applied on
# one frame. The rest follows with the next.
LIVE_BUDGET, APPLIED_AT_ONCE = 1 << 10, 64

EVENT = np.dtype(
    [("frame", np.int64), ("index", np.int64), ("target", np.float64), ("ramp", np.int64)]
)
WAITING = np.dtype([*EVENT.descr, ("order", np.int64)])
LINE = 8  # words in a cache line, so that the two sides' cursors do not share one

MAIL = np.dtype(
    [
        ("posted", np.int64, LINE),  # written by who posts
        ("dropped", np.int64, LINE),
        ("read", np.int64, LINE),  # written by who reads the reports
        ("drained", np.int64, LINE),  # written by the audio side, as all that follows
        ("reported", np.int64, LINE),
        ("unreported", np.int64),
        ("late", np.int64),
        ("applied", np.int64),
        ("waiting", np.int64),  # entries in the heap
        ("reporting", np.int64),
        ("budget", np.int64),  # events to drain in one go
    ],
    align=True,
)


@compiled
def wait(
    heap: Array, waiting: int, frame: int, index: int, target: float, ramp: int, order: int
) -> None:
    """Put an event into the heap of `waiting` entries. Real time: safe; log(waiting) steps."""
    hole = waiting
    while hole > 0:
        parent = (hole - 1) // 2
        if heap[parent].frame <= frame:  # of one frame, the older comes first
            break
        heap[hole] = heap[parent]
        hole = parent
    entry = heap[hole]
    entry.frame, entry.index, entry.target, entry.ramp = frame, index, target, ramp
    entry.order = order


@compiled
def leave(heap: Array, waiting: int) -> None:
    """Take the first event out of the heap of `waiting` entries. Real time: safe."""
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
    """Whether one event is due before another: by frame, then as posted."""
    return bool(one.frame < other.frame or (one.frame == other.frame and one.order < other.order))
