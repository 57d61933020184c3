"""Lock-free queues of wishes to the instrument, and of reports of fulfilled ones. Compiled.

Players post wishes to a ring; the audio side moves them to a heap in the order of their frames,
and reports fulfilled ones in a second ring. Each ring has one writer and one reader. Each moves
only its own cursor, after it has written or read the entry, so neither waits. Wishes for a full
ring are dropped and counted.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.player.wishes import WISH

Array = Any

RING = 1 << 16  # wishes; powers of two
HEAP = 1 << 14
# Limits on the work of a callback: wishes moved to the heap for each 64 frames, and wishes
# fulfilled at one frame. The rest waits for the next.
LIVE_BUDGET, APPLIED_AT_ONCE = 1 << 10, 64

WAITING = np.dtype([("wish", WISH), ("order", np.int64)])
LINE = 8  # words of a cache line: the two sides' cursors lie in different ones

MAIL = np.dtype(
    [
        ("posted", np.int64, LINE),  # number of wishes posted; written by players, as the next
        ("dropped", np.int64, LINE),
        ("read", np.int64, LINE),  # number of reports read; written by their reader
        ("drained", np.int64, LINE),  # written by the audio side, as all below
        ("reported", np.int64, LINE),
        ("unreported", np.int64),
        ("late", np.int64),
        ("applied", np.int64),
        ("waiting", np.int64),  # entries in the heap
        ("reporting", np.int64),
        ("budget", np.int64),  # wishes moved to the heap at a time
    ],
    align=True,
)


def mend(heap: Array, mail: Any) -> None:
    """Put a heap in order again that a process left while it moved an entry, in place."""
    entries = heap[: int(mail["waiting"])]
    _, first = np.unique(entries["order"], return_index=True)  # one may be there twice
    entries = entries[first]
    entries = entries[np.lexsort((entries["order"], entries["wish"]["frame"]))]
    heap[: len(entries)] = entries
    mail["waiting"] = len(entries)


@compiled
def wait(heap: Array, waiting: int, wish: Any, order: int) -> None:
    """Add a wish to a heap of `waiting` entries. Real time: safe; log(waiting) steps."""
    hole = waiting
    while hole > 0:
        parent = (hole - 1) // 2
        if heap[parent].wish.frame <= wish.frame:  # at one frame, the older wish comes first
            break
        heap[hole] = heap[parent]
        hole = parent
    entry = heap[hole]
    copy_wish(wish, entry.wish)
    entry.order = order


@compiled
def copy_wish(wish: Any, into: Any) -> None:
    """Copy the fields of a wish from one record to another."""
    into.frame, into.kind, into.index = wish.frame, wish.kind, wish.index
    into.value, into.other = wish.value, wish.other


@compiled
def leave(heap: Array, waiting: int) -> None:
    """Remove the first wish from a heap of `waiting` entries. Real time: safe."""
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
    """Whether one wish comes before another: by frame, then in the order posted."""
    first, second = one.wish.frame, other.wish.frame
    return bool(first < second or (first == second and one.order < other.order))
