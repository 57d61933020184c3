"""Lock-free queues of events to the instrument, and of reports of applied commands. Compiled.

Whoever plays posts events (``midi.events``) to a ring of its own; the audio side moves them to a
queue of the writer, a heap in the order of their frames, interprets them, and reports applied
commands in a further ring. Each ring has one writer and one reader. Each moves only its own cursor,
after it has written or read the entry, so neither waits. Events for a full ring, or for a full
queue of a page or of a sender of OSC, are dropped and counted.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.midi.events import FINGER_ON, NOTE_ON
from yehu_server.core.player.commands import BEGIN, COMMAND

Array = Any

RING = 1 << 16  # events of the server, or of the program that plays; powers of two
SMALL_RING = 1 << 12  # of each other writer
HEAP = 1 << 14
ROOM = 1 << 12  # entries that a heap of commands has room for before another event is interpreted
APPLIED_AT_ONCE = 64  # commands at one frame; the rest waits for the next
# What a live instrument does at once: events moved from each ring for each 64 frames, and the cost
# of commands (`ready_at`). Without limit offline.
LIVE_INTAKE, LIVE_BUDGET, BUDGET_PER_FRAME = 1 << 10, 192, 14
UNLIMITED = 1 << 40
# The writers of events. Inputs give the time of arrival (ns) in place of a frame; pages put their
# number above the KIND_BITS of a kind, and the server that of the sender (0: itself).
MIDI_INPUTS, SERVER, SOUND_INPUT, PAGES = range(4)
WRITERS = 4
KIND_BITS = 8
# Events to come: a queue of each writer, of each page and of senders of OSC, so that none fills
# another's.
PAGE_QUEUES, PAGE_QUEUE = 64, 1 << 8
SENDER_QUEUES, SENDER_QUEUE = 32, 1 << 10
STARTS = (NOTE_ON, FINGER_ON, BEGIN)  # kinds of events that begin a note
RESERVE = 8  # entries of these, for the ends of what a page or sender played
FIRST_SENDER = PAGES + PAGE_QUEUES
QUEUES = FIRST_SENDER + SENDER_QUEUES
QUEUE_SIZES = np.array(
    [SMALL_RING, HEAP, SMALL_RING, *[PAGE_QUEUE] * PAGE_QUEUES, *[SENDER_QUEUE] * SENDER_QUEUES]
)
QUEUE_STARTS = np.cumsum(QUEUE_SIZES) - QUEUE_SIZES

WAITING = np.dtype([("command", COMMAND), ("order", np.int64)])
LINE = 8  # words of a cache line: the two sides' cursors lie in different ones

BUDGET = np.dtype([("used", np.int64), ("frame", np.int64)], align=True)  # at that frame
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
        ("pending", np.int64, QUEUES),  # events in each queue, and the frame of the first
        ("first", np.int64, QUEUES),
        ("pending_events", np.int64),  # events in all queues
        # Fair queueing (`next_queue`), by cost: finish tag of each queue, and virtual time.
        ("finish_tag", np.int64, QUEUES),
        ("virtual_time", np.int64),
        ("released", np.int64),  # note-ons that were posted before this one are not played
        ("secret", np.int64),  # of the index of note-ons (`note_index`)
        ("waiting", np.int64),  # entries in the heap of commands
        ("reporting", np.int64),
        ("intake", np.int64),  # events moved from each ring at a time
        ("at_once", np.int64),  # cost of commands at once, by either budget
        ("interpreting", BUDGET),
        ("applying", BUDGET),
    ],
    align=True,
)


def repair(heap: Array, count: int) -> int:
    """Put a heap in order again that a process left while it moved an entry, in place.

    Returns the number of its entries, of which there were `count`.
    """
    entries = heap[:count]
    _, first = np.unique(entries["order"], return_index=True)  # one may be there twice
    entries = entries[first]
    entries = entries[np.lexsort((entries["order"], entries["command"]["frame"]))]
    heap[: len(entries)] = entries
    return len(entries)


def repair_queues(events: Array, notes: Array, mail: Any) -> None:
    """Put all queues of events in order again, without note-ons that were cancelled.

    It empties the index of note-ons (``note_index``); see `repair`.
    """
    slots = len(notes) // len(events)
    for queue in range(QUEUES):
        start, size = QUEUE_STARTS[queue], QUEUE_SIZES[queue]
        heap = events[start : start + size]
        count = repair(heap, int(mail["pending"][queue]))
        keys = notes[slots * start : slots * (start + size)]
        for key in keys[(keys["waiting"] > 0) & (keys["ended"] > 0)]:
            command, order = heap["command"][:count], heap["order"][:count]
            its = (command["index"] == key["channel"]) & (command["value"] == key["key"])
            its &= np.isin(command["kind"], STARTS) & (order < key["ended"])
            count -= its.sum()
            heap[:count] = heap[: len(its)][~its]
        mail["pending"][queue], mail["first"][queue] = count, heap["command"]["frame"][0]
    mail["pending_events"] = mail["pending"].sum()
    notes[:] = np.zeros(1, notes.dtype)


@compiled
def is_ready(budget: Any, at_once: int, frame: int) -> bool:
    """Whether a budget has something left at a frame; see `ready_at`."""
    return bool(budget.used - BUDGET_PER_FRAME * (frame - budget.frame) < at_once)


@compiled
def ready_at(budget: Any, at_once: int) -> int:
    """The first frame at which a budget has something left.

    It is that of a token bucket of the cost of commands (``player.commands.cost``), which one event
    may overdraw: `at_once`, and BUDGET_PER_FRAME more each frame. As it counts frames, what it
    defers does not depend on the size of blocks.
    """
    over = budget.used - at_once + 1
    return int(budget.frame + max(0, (over + BUDGET_PER_FRAME - 1) // BUDGET_PER_FRAME))


@compiled
def spend(budget: Any, frame: int, cost: int) -> None:
    """Take the cost of commands from a budget at a frame, no earlier than those before."""
    budget.used = max(0, budget.used - BUDGET_PER_FRAME * (frame - budget.frame)) + cost
    budget.frame = frame


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
