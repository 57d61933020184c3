"""Finds the note-ons of a key that wait in a queue of events, however much waits there. Compiled.

Each queue has a hash table of the keys whose note-ons wait in it, by linear probing, at most half
full. An end cancels them by its order alone; each is left out as it leaves the queue. A secret is
part of the hash, so that no sender knows which keys meet: each step takes constant time on average.

Source: Knuth, The Art of Computer Programming, vol. 3, 6.4, algorithms L and R.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import pseudorandom

Array = Any

SLOTS_PER_EVENT = 2
NOTES = np.dtype(
    [
        ("channel", np.int64),
        ("key", np.float64),
        ("waiting", np.int64),  # note-ons of the key; 0: the slot is free
        ("ended", np.int64),  # order of the last end, which cancels those before it
    ]
)


@compiled_exactly
def home(notes: Array, secret: int, channel: int, key: float) -> int:
    """The slot where the search for a key begins."""
    number = np.float64(key + 0.0).view(np.int64) ^ secret  # 0.0 and -0.0 are one key
    number = np.float64(pseudorandom(number)).view(np.int64) ^ secret ^ channel  # type: ignore[arg-type]
    return int((pseudorandom(number) + 1.0) * (len(notes) // 2))  # type: ignore[arg-type]


@compiled_exactly
def find_slot(notes: Array, secret: int, channel: int, key: float) -> int:
    """The slot of a key, or the free one where it would be."""
    slot = home(notes, secret, channel, key)
    for _ in range(len(notes)):
        note = notes[slot]
        if note.waiting == 0 or (note.channel == channel and note.key == key):
            break
        slot = (slot + 1) & (len(notes) - 1)
    return int(slot)


@compiled_exactly
def add_note(notes: Array, secret: int, channel: int, key: float) -> None:
    """Count a note-on that comes into the queue. What is no number is no key."""
    if not math.isnan(key):
        note = notes[find_slot(notes, secret, channel, key)]
        if note.waiting == 0:
            note.channel, note.key, note.ended = channel, key, 0
        note.waiting += 1


@compiled_exactly
def end_notes(notes: Array, secret: int, order: int, channel: int, key: float) -> None:
    """Cancel the note-ons of a key that wait and were posted before its end."""
    note = notes[find_slot(notes, secret, channel, key)]
    if note.waiting > 0:
        note.ended = max(note.ended, order)


@compiled_exactly
def take_note(notes: Array, secret: int, order: int, channel: int, key: float) -> bool:
    """Count a note-on that leaves the queue no longer; return whether it was cancelled."""
    hole, last = find_slot(notes, secret, channel, key), len(notes) - 1
    if notes[hole].waiting == 0:
        return False
    is_cancelled = notes[hole].ended > order
    notes[hole].waiting -= 1
    if notes[hole].waiting == 0:  # keys after it move nearer to their home
        slot = (hole + 1) & last
        while notes[slot].waiting > 0:
            start = home(notes, secret, notes[slot].channel, notes[slot].key)
            if (slot - start) & last >= (slot - hole) & last:
                notes[hole] = notes[slot]
                notes[slot].waiting = 0
                hole = slot
            slot = (slot + 1) & last
    return bool(is_cancelled)
