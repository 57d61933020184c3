"""Stands for an instrument that leads a part: events come to commands, and nothing sounds."""

from typing import Any

import numpy as np

from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.events import EVENTS
from yehu_server.core.midi.interpret_events import interpret
from yehu_server.core.midi.record import CHANNELS_PER_PORT, MIDI, prepare_midi
from yehu_server.core.midi.tables import TABLE_SLOTS, TABLES
from yehu_server.core.player.commands import KINDS
from yehu_server.params.table import TABLE

ALL_KINDS = (*KINDS, *EVENTS)
DEFAULTS = {param.address: param.default for param in TABLE}
Requested = tuple[int, int, float, float]  # kind, index, value, other


class Leader:
    """The side of ``engine.instrument.Instrument`` that interprets what is posted."""

    rate = 48000.0
    spec = InstrumentSpec(rate)
    seed = 0
    address = 0
    is_live = True

    def __init__(self) -> None:
        self.gaps: list[tuple[int, int]] = []
        self._midi = np.zeros(1, MIDI)
        self.tables = np.zeros(TABLE_SLOTS, TABLES)

    @property
    def midi(self) -> Any:
        return self._midi[0]

    def begin_part(self, tables: Any, players: int = 1) -> None:
        is_mpe = bool(tables["mpe"][0])
        prepare_midi(self._midi, self.rate, DEFAULTS, players=players, mpe=is_mpe)
        self.tables[0] = tables[0]

    def set_tables(self, tables: Any) -> None:
        self.tables[self.midi["tables"]] = tables[0]
        self.midi["lower"] = CHANNELS_PER_PORT - 1 if tables["mpe"][0] else 0

    def interpret_events(self) -> None:
        """Each event is interpreted as it comes."""

    def frames(self, ms: float) -> int:
        return round(ms * 1e-3 * self.rate)

    def interpret(self, frame: int, kind: int, *fields: float) -> list[Requested]:
        """What an event comes to, all at its frame."""
        midi = self.midi
        interpret.call(self._midi.ctypes.data, self.tables.ctypes.data, frame, kind, *fields)
        count = int(midi["commands"])
        assert (midi["out_frame"][:count] == frame).all()
        assert midi["lost"] == 0
        names = ("out_kind", "out_index", "out_value", "out_other")
        return list(zip(*(midi[name][:count].tolist() for name in names), strict=True))
