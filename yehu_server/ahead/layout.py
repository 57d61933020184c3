"""The layout of what `look` sees and of an interpreter, for programs that have no header: pages."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from yehu_server.ahead.interpreter import TABLES_AT, WORD
from yehu_server.engine.look import LOOK
from yehu_server.midi.record import MIDI
from yehu_server.midi.tables import SLOTS, TABLES

# What a page reads and writes of the record of a part.
OF_RECORD = (
    "tables", "value", "found_value", "out_kind", "out_index", "out_value", "out_other",
)  # fmt: skip


def look_layout() -> dict[str, list[int]]:
    """Tell where each field of a look begins and how long it is, in float64 numbers."""
    return _layout(LOOK, LOOK.names or ())


def look_length() -> int:
    """Length of a look, in float64 numbers."""
    return LOOK.itemsize // WORD


def interpreter_layout() -> dict[str, Any]:
    """Tell the same of an interpreter's record, and of its tables.

    There are `slots` of them, one after another from `tablesAt`, each of `length` words.
    """
    return {
        "record": _layout(MIDI, OF_RECORD),
        "tables": _layout(TABLES, TABLES.names or ()),
        "tablesAt": TABLES_AT // WORD,
        "length": TABLES.itemsize // WORD,
        "slots": SLOTS,
    }


def _layout(dtype: Any, names: Iterable[str]) -> dict[str, list[int]]:
    return {name: [dtype.fields[name][1] // WORD, math.prod(dtype[name].shape)] for name in names}
