"""What compiled code makes of a bind: its curve both ways, its channels, its soft take-over."""

import math
from functools import lru_cache
from typing import Any

import numpy as np

from yehu_server.core.midi import curves, values
from yehu_server.core.midi.events import CONTROL
from yehu_server.core.midi.interpret_events import interpret
from yehu_server.core.midi.record import MIDI, prepare_midi
from yehu_server.core.midi.tables import TABLE_SLOTS, TABLES
from yehu_server.params.table import TABLE
from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, RangePolicy

RATE = 48000.0


@lru_cache(maxsize=16)
def tables_of(bind: Bind) -> Any:
    """Tables with one bind: ndarray [shape=(1,), dtype=TABLES]."""
    mapping, how = Mapping("", (bind,)), {"policy": RangePolicy.TRANSPOSE}
    return make_tables(mapping, Controls(), tuning=EQUAL, a4=440.0, **how)


def from_unit(bind: Bind, position: float) -> float:
    """The target's value at a position of the source, 0 to 1."""
    return float(curves.from_unit(tables_of(bind)[0], 0, float(position)))


def to_unit(bind: Bind, value: float) -> float:
    """The position, 0 to 1, that `from_unit` maps to a value, clamped to the span."""
    return float(curves.to_unit(tables_of(bind)[0], 0, float(value)))


def picks_up(bind: Bind, position: float, before: float | None, value: float) -> bool:
    """Whether a source that moves to a position reaches or passes the target's value.

    `before` is where the source was, if it was ever moved.
    """
    was = math.nan if before is None else before
    return bool(curves.picks_up(tables_of(bind)[0], 0, float(position), was, float(value)))


def receives(bind: Bind, channel: int) -> bool:
    """Whether it receives on a channel, counted from 0 over all ports; negative: no channel."""
    return bool(values.receives(tables_of(bind)[0], 0, channel))


def input_to_unit(bind: Bind, argument: float) -> float:
    """The position, 0 to 1, of a named control that was sent an argument."""
    record, tables = np.zeros(1, MIDI), np.zeros(TABLE_SLOTS, TABLES)
    prepare_midi(record, RATE, {param.address: param.default for param in TABLE})
    tables[0] = tables_of(bind)[0]
    addresses = record.ctypes.data, tables.ctypes.data
    interpret.call(*addresses, 0, CONTROL, 0, float(argument), 0.0)
    return float(record["control_position"][0, 0])
