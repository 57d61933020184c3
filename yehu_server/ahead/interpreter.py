"""An interpreter of events without an instrument, for pages, and its layout. Compiled.

A page gives its memory (`interpreter_size` bytes, aligned to 8), prepares it, writes tables into a
slot, and has events interpreted; what each comes to is in the part's record (``midi.record``).
"""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from yehu_server.ahead.memory_images import runs
from yehu_server.compile.jit import Native, native
from yehu_server.compile.memory import WORD, carray
from yehu_server.core.engine.atomics import at
from yehu_server.core.engine.snapshot import SNAPSHOT
from yehu_server.core.midi.interpret_events import interpret
from yehu_server.core.midi.record import MIDI, prepare_midi
from yehu_server.core.midi.tables import TABLE_SLOTS, TABLES
from yehu_server.params.table import TABLE

Array = Any

TABLES_AT = MIDI.itemsize
BYTES = TABLES_AT + TABLE_SLOTS * TABLES.itemsize
ANY_RATE = 48000.0  # Hz; only sections ask for theirs


def _image() -> Array:
    """The record of a part of one player that was sent nothing: see ``memory_images``."""
    midi = np.zeros(1, MIDI)
    prepare_midi(midi, ANY_RATE, {param.address: param.default for param in TABLE})
    return np.concatenate(list(runs(np.frombuffer(midi.tobytes(), np.int64))))


IMAGE = _image()


@native
def interpreter_size() -> int:
    """Bytes that an interpreter takes."""
    return BYTES


@native
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


@native
def interpreter_take(
    interpreter: Any, frame: int, kind: int, index: int, value: float, other: float
) -> int:
    """Interpret an event (``midi.events``); return the number of commands that it comes to."""
    m = carray(interpreter, (1,), MIDI)[0]
    interpret(m, at(interpreter, TABLES_AT), frame, kind, index, value, other)
    return int(m.commands)


INTERPRETER: tuple[Native, ...] = (interpreter_size, interpreter_prepare, interpreter_take)


# What a page reads and writes of the record of a part.
OF_RECORD = (
    "tables", "value", "resolved_value", "is_target",
    "out_kind", "out_index", "out_value", "out_other",
)  # fmt: skip


def snapshot_layout() -> dict[str, list[int]]:
    """Where each field of a snapshot begins and how long it is, in float64 numbers."""
    return _layout(SNAPSHOT, SNAPSHOT.names or ())


def snapshot_length() -> int:
    """Length of a snapshot, in float64 numbers."""
    return SNAPSHOT.itemsize // WORD


def interpreter_layout() -> dict[str, Any]:
    """The same of an interpreter's record, and of its tables.

    There are `slots` of them, one after another from `tablesAt`, each of `length` words.
    """
    return {
        "record": _layout(MIDI, OF_RECORD),
        "tables": _layout(TABLES, TABLES.names or ()),
        "tablesAt": TABLES_AT // WORD,
        "length": TABLES.itemsize // WORD,
        "slots": TABLE_SLOTS,
    }


def _layout(dtype: Any, names: Iterable[str]) -> dict[str, list[int]]:
    return {name: [dtype.fields[name][1] // WORD, math.prod(dtype[name].shape)] for name in names}
