"""Lock-free queues of events to the instrument, and of reports of applied commands. Compiled.

Whoever plays posts events (``midi.events``) to a ring of its own; the audio side moves them to a
heap in the order of their frames, interprets them, and reports applied commands in a further ring.
Each ring has one writer and one reader. Each moves only its own cursor, after it has written or
read the entry, so neither waits. Events for a full ring are dropped and counted.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.player.commands import COMMAND

Array = Any

RING = 1 << 16  # events of the server, or of the program that plays; powers of two
SMALL_RING = 1 << 12  # of each other writer
HEAP = 1 << 14
ROOM = 1 << 12  # entries that a heap of commands has room for before another event is interpreted
# Limits on the work of a callback: events moved to the heap for each 64 frames, and commands
# applied at one frame. The rest waits for the next.
LIVE_BUDGET, APPLIED_AT_ONCE = 1 << 8, 64
# The writers of events. Those of inputs have the time of their arrival (ns) in place of a frame.
SERVER, MIDI_INPUTS, PAGES, SOUND_INPUT = range(4)
WRITERS = 4

WAITING = np.dtype([("command", COMMAND), ("order", np.int64)])
LINE = 8  # words of a cache line: the two sides' cursors lie in different ones

MAIL = np.dtype(
    [
        # Number of events posted; written by each writer, as the next.
        ("posted", np.int64, (WRITERS, LINE)),
        ("dropped", np.int64, (WRITERS, LINE)),
        ("read", np.int64, LINE),  # number of reports read; written by their reader
        ("delay", np.int64, LINE),  # frames from the arrival of a message to its sound
        # Written by the audio side, as all below.
        ("drained", np.int64, (WRITERS, LINE)),
        ("reported", np.int64, LINE),
        ("unreported", np.int64),
        # By writer: events that came after their frame, and by how many frames at most.
        ("late", np.int64, WRITERS),
        ("most_late", np.int64, WRITERS),
        ("arrived", np.int64),  # frame of the latest message
        ("applied", np.int64),
        ("ordered", np.int64),  # number of events and commands that came into a heap
        ("pending_events", np.int64),  # entries in the heap of events, and in that of commands
        ("waiting", np.int64),
        ("reporting", np.int64),
        ("budget", np.int64),  # events moved to the heap at a time
    ],
    align=True,
)


def repair(heap: Array, mail: Any, count: str) -> None:
    """Put a heap in order again that a process left while it moved an entry, in place.

    Parameters
    ----------
    count : str
        Field of `mail` that has the number of its entries.
    """
    entries = heap[: int(mail[count])]
    _, first = np.unique(entries["order"], return_index=True)  # one may be there twice
    entries = entries[first]
    entries = entries[np.lexsort((entries["order"], entries["command"]["frame"]))]
    heap[: len(entries)] = entries
    mail[count] = len(entries)


@compiled
def push(
    heap: Array,
    waiting: int,
    frame: int,
    kind: int,
    index: int,
    value: float,
    other: float,
    order: int,
) -> None:
    """Add a command, by its fields, to a heap of `waiting` entries. Real time: safe, O(log)."""
    hole = waiting
    while hole > 0:
        parent = (hole - 1) // 2
        if heap[parent].command.frame <= frame:  # at one frame, the older command comes first
            break
        heap[hole] = heap[parent]
        hole = parent
    entry = heap[hole]
    command = entry.command
    command.frame, command.kind, command.index, command.value, command.other = (
        frame,
        kind,
        index,
        value,
        other,
    )
    entry.order = order


@compiled
def copy_command(command: Any, into: Any) -> None:
    """Copy the fields of a command from one record to another."""
    into.frame, into.kind, into.index = command.frame, command.kind, command.index
    into.value, into.other = command.value, command.other


@compiled
def pop(heap: Array, waiting: int) -> None:
    """Remove the first command from a heap of `waiting` entries. Real time: safe."""
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
    """Whether one command comes before another: by frame, then in the order posted."""
    first, second = one.command.frame, other.command.frame
    return bool(first < second or (first == second and one.order < other.order))
