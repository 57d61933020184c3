"""An interpreter of events without an instrument, for who posts wishes to one elsewhere. Compiled.

A page gives its memory (`interpreter_size` bytes, aligned to 8), prepares it, writes tables into a
slot, and has events interpreted; what each comes to is in the part's record (``midi.record``).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.ahead.images import runs
from yehu_server.engine.atomics import at
from yehu_server.jit import Native, native
from yehu_server.memory import carray
from yehu_server.midi.interpret import interpret as interpret_event
from yehu_server.midi.record import MIDI, prepare_midi
from yehu_server.midi.tables import SLOTS, TABLES
from yehu_server.params.table import TABLE

Array = Any

WORD = 8  # bytes
TABLES_AT = MIDI.itemsize
BYTES = TABLES_AT + SLOTS * TABLES.itemsize
ANY_RATE = 48000.0  # Hz; only sections ask for theirs

interpret_one = interpret_event.symbol


def _image() -> Array:
    """The record of a part of one player that was sent nothing: see ``images``."""
    midi = np.zeros(1, MIDI)
    prepare_midi(midi, ANY_RATE, {param.address: param.default for param in TABLE})
    return np.concatenate(list(runs(np.frombuffer(midi.tobytes(), np.int64))))


IMAGE = _image()


@native("int64()")
def interpreter_size() -> int:
    """Bytes that an interpreter takes."""
    return BYTES


@native("void(voidptr)")
def interpreter_prepare(interpreter: Any) -> None:
    """Make an interpreter of a part that was sent nothing; its tables are all zero."""
    words = carray(interpreter, (BYTES // WORD,), np.int64)
    for word in range(BYTES // WORD):
        words[word] = 0
    place = 0
    while place < len(IMAGE):
        first, count = IMAGE[place], IMAGE[place + 1]
        for word in range(count):
            words[first + word] = IMAGE[place + 2 + word]
        place += 2 + count


@native(
    "int64(voidptr, int64, int64, int64, float64, float64)",
    calls=[interpret_event],
)
def interpreter_take(
    interpreter: Any, frame: int, kind: int, index: int, value: float, other: float
) -> int:
    """Interpret an event (``midi.events``); return the number of wishes that it comes to."""
    interpret_one(interpreter, at(interpreter, TABLES_AT), frame, kind, index, value, other)
    return int(carray(interpreter, (1,), MIDI)[0].wishes)


INTERPRETER: tuple[Native, ...] = (interpreter_size, interpreter_prepare, interpreter_take)
