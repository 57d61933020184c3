"""Posts MIDI messages and moves of controllers to a part, as a mapping has them.

What they mean is in compiled code (``midi``); so are pedals, zones and positions of controllers,
which are read from the part's record here.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable, Sequence
from collections.abc import Mapping as Values
from typing import Any

import mido
import numpy as np
from mido.messages import BaseMessage

from yehu_server.compile.jit import uncompiled
from yehu_server.compile.memory import with_fields
from yehu_server.core.midi import events
from yehu_server.core.midi.channels import plays
from yehu_server.core.midi.packing import packed
from yehu_server.core.midi.record import CHANNELS, IN_PORT
from yehu_server.core.midi.tables import SLOTS
from yehu_server.core.player.rows import ROW
from yehu_server.errors import YehuError
from yehu_server.params.preset_file import Preset
from yehu_server.params.table import TABLE, find
from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.sources import NOTE, POLY_PRESSURE, STEPS, VELOCITY, is_address
from yehu_server.playing.wishes import Key, WishPoster

PATIENCE_S = 1.0  # to wait until the audio side uses other tables


class MidiPoster:
    """Sends MIDI channel messages to a part: notes directly, controllers through a mapping.

    `channels`: channels to receive, counted from 0; by default all. Notes of the percussion channel
    are played only if it is chosen, or a member of an MPE zone.
    `start` (iterable of (address, value)): start values of parameters, over those of the mapping.
    `programs`: the presets of MIDI programs, from 1. Without it program changes are ignored.
    """

    def __init__(
        self,
        wishes: WishPoster,
        mapping: Mapping,
        channels: set[int] | None = None,
        *,
        start: Iterable[tuple[str, float]] = (),
        programs: Values[int, Preset] | None = None,
    ) -> None:
        self._wishes = wishes
        self._channels = channels
        self._start = tuple(start)
        self._programs = programs
        self.mapping = mapping
        self._slot = 0
        wishes.instrument.set_tables(self._tables())
        wishes.post(events.START, None)

    def _tables(self) -> Any:
        return self._wishes.tables(
            self.mapping, start=self._start, received=self._channels, programs=self._programs
        )

    # -- messages ----------------------------------------------------------------------------

    def receive(
        self, message: mido.Message | Sequence[int], *, frame: int | None = None, port: int = 0
    ) -> None:
        """Send a channel message or a system reset, or its bytes; others change nothing.

        Each port, counted from 0, has 16 channels of its own.
        """
        data = message.bytes() if isinstance(message, BaseMessage) else message
        self._wishes.post(events.MESSAGE, frame, packed(data, port))

    def move(self, address: str, argument: float, *, frame: int | None = None) -> None:
        """Move the targets of an OSC address of the mapping, for all channels."""
        number = self._wishes.controls.number(address)
        self._wishes.post(events.CONTROL, frame, number, argument)

    def write(self, address: str, value: float, *, frame: int | None = None) -> float:
        """Set a parameter for all channels, until a controller moves it; see `WishPoster.write`."""
        return self._wishes.set(address, value, frame=frame)

    def load(self, values: Values[str, float], *, frame: int | None = None) -> None:
        """Set the parameters of a preset, except held ones."""
        for address, value in values.items():
            if not self._wishes.keeps(address):
                self._wishes.write(address, value, frame=frame, kind=events.LOAD)

    def end_port_notes(self, port: int, *, frame: int | None = None) -> None:
        """End the notes of a port that is gone, and forget its moves, but those for all notes."""
        self._wishes.post(events.DISCONNECT, frame, port)

    def reset_to_start_values(self, *, frame: int | None = None) -> None:
        """Set every parameter to its start value."""
        defaults = {param.address: param.default for param in TABLE}
        values = defaults | dict(self.mapping.start) | dict(self._start)
        self._wishes.expect(values, frame)
        self._wishes.post(events.START, frame, value=1.0)

    def reset(self, *, frame: int | None = None) -> None:
        """End all notes, and forget pedals, zones and moves."""
        self._wishes.post(events.RELEASE_ALL, frame, value=1.0)

    def end_all(self, *, frame: int | None = None) -> None:
        """End all notes, whatever pedals hold."""
        self._wishes.end_all(frame=frame)

    def note_on(self, key: Key, velocity: float, frame: int | None) -> None:
        """Begin a note; `velocity` is 0 to 1."""
        self._wishes.post(events.NOTE_ON, frame, key.channel, key.note, velocity)

    def note_off(self, key: Key, frame: int | None) -> None:
        """End a note, unless a pedal keeps it."""
        self._wishes.post(events.NOTE_OFF, frame, key.channel, key.note)

    # -- the mapping -------------------------------------------------------------------------

    def remap(self, mapping: Mapping, *, frame: int | None = None) -> None:
        """Take another mapping while notes sound.

        Moves stay where their source is still bound. A parameter whose start value differs takes
        the new one, unless it was moved since. Raises YehuError where others were taken just
        before, and are not in use yet.
        """
        self.mapping = mapping
        self._change_tables(frame)

    @property
    def has_programs(self) -> bool:
        """Whether program changes select presets."""
        return self._programs is not None

    def know_programs(self, programs: Values[int, Preset], *, frame: int | None = None) -> None:
        """Take other presets of MIDI programs, where program changes select presets."""
        if self._programs is not None and programs != self._programs:
            self._programs = programs
            self._change_tables(frame)

    def _change_tables(self, frame: int | None) -> None:
        tables = self._tables()
        slot = (self._slot + 1) % SLOTS
        until = time.monotonic() + PATIENCE_S
        while int(self._wishes.record["tables"]) == slot:  # the others are not in use yet
            if time.monotonic() > until:
                raise YehuError("the mapping was changed too often at a time")
            time.sleep(0.001)
        self._wishes.instrument.tables[slot] = tables[0]
        self._slot = slot
        self._wishes.post(events.TABLES_TO, frame, slot)

    # -- what the record holds ---------------------------------------------------------------

    @property
    def notes_by_channel(self) -> Counter[int]:
        """Number of notes played on each channel; -1 for those of no MIDI port."""
        counts = self._wishes.record["notes_of"].tolist()
        found = {channel: count for channel, count in enumerate(counts) if count}
        return Counter({-1 if c == CHANNELS else c: count for c, count in found.items()})

    @property
    def percussion_notes(self) -> int:
        """Number of notes of the percussion channel, which are not played."""
        return int(self._wishes.record["percussion"])

    @property
    def unknown_programs(self) -> Counter[int]:
        """How often programs, from 1, were asked for that no preset has."""
        counts = self._wishes.record["unknown_program"].tolist()
        return Counter({program: count for program, count in enumerate(counts, 1) if count})

    def plays(self, channel: int) -> bool:
        """Whether the notes of a channel, counted from 0 over all ports, are played."""
        record = self._wishes.record
        tables = self._wishes.instrument.tables[record["tables"]]
        # As Python: compiling it would take longer than a short render.
        return uncompiled(plays)(with_fields(record), with_fields(tables), channel)

    def positions(self) -> list[tuple[Bind, float | None]]:
        """Each bind, and the position (0 to 1) of its source, if that was ever moved."""
        record = self._wishes.record
        firsts: dict[str, int] = {}
        found = []
        for number, bind in enumerate(self.mapping.binds):
            first = firsts.setdefault(bind.source, number)
            found.append((bind, _position(record, bind, number, first)))
        return found

    def sound(self) -> dict[str, float]:
        """All parameters that the player does not move, without the velocity of one note."""
        free = [param.address for param in TABLE if not param.player_controlled]
        values = {address: self._wishes.value(address) for address in free}
        record = self._wishes.record
        for bind in self.mapping.of(VELOCITY):
            row = ROW[find(bind.target).address]
            if record["is_target"][row]:
                values[bind.target] = float(record["set_to"][row])
        return values


def _position(record: Any, bind: Bind, number: int, first: int) -> float | None:
    """Where a bind's source was last moved to, on any channel that it receives."""
    if is_address(bind.source):
        return float(record["fader"][number]) if record["has_fader"][number] else None
    channels = np.arange(CHANNELS)
    if bind.channels:
        channels = channels[np.isin(channels % IN_PORT + 1, bind.channels)]
    if bind.source in (VELOCITY, NOTE):
        places = channels if bind.channels else np.arange(CHANNELS + 1)
        numbers = record["strike_number"][places]
        name = "strike_velocity" if bind.source == VELOCITY else "strike_key"
        positions = record[name][places] / (1.0 if bind.source == VELOCITY else STEPS)
    elif bind.source == POLY_PRESSURE:
        numbers, positions = (
            record[name][channels].ravel() for name in ("pressure_number", "pressure")
        )
    else:
        numbers, positions = (
            record["move_number"][channels, first],
            record["position"][channels, first],
        )
    latest = int(np.argmax(numbers)) if len(numbers) else 0
    return float(positions[latest]) if len(numbers) and numbers[latest] else None
