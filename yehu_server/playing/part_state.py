"""Reads the state of a part: values of parameters, held notes, positions of controllers, counts.

What was posted is answered until the audio side has it; then its records are.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping as Values
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from yehu_server.compile.jit import uncompiled
from yehu_server.compile.memory import with_fields
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.midi.channels import plays
from yehu_server.core.midi.record import CHANNEL_COUNT, CHANNELS_PER_PORT, NONE
from yehu_server.core.player.note_range import NoteRange
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.errors import ParameterError
from yehu_server.params.spec import Param
from yehu_server.params.table import TABLE, find
from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.sources import (
    MPE_FROM,
    NOTE,
    POLY_PRESSURE,
    STEPS,
    VELOCITY,
    is_address,
)
from yehu_server.system import clocks

UNMAPPED = Mapping("", ())
ELSEWHERE = -1  # the channel of notes that do not come from MIDI


class Key(NamedTuple):
    """A held note by its channel, a number for each source, and key, which may be fractional."""

    channel: int
    note: float

    @classmethod
    def of(cls, key: Key | float) -> Key:
        """A key; of no MIDI channel where it is a number, which is the same in single precision."""
        return key if isinstance(key, Key) else cls(ELSEWHERE, round(within_midi("note", key), 3))


def within_midi(what: str, value: float) -> float:
    """Return a number within 0 to 127; raises ParameterError for others."""
    if not 0.0 <= value <= 127.0:  # also refuses NaN
        raise ParameterError(f"{what}: {value:g} is not within 0 to 127")
    return value


@dataclass
class Pending:
    """A direct write: its value, its number among all events, and its frame."""

    value: float
    number: int
    frame: int
    is_held: bool


class PartState:
    """The state of a part, as its instruments' records and what was posted have it.

    `instruments`: who plays the part; those of a section lie one after another on the stage.
    `part`: its number, counted from 0. What all parts share is the first one's.
    """

    def __init__(self, instruments: Sequence[Instrument], part: int = 0) -> None:
        self.part = part
        self.instruments = tuple(instruments)
        self.instrument = instruments[0]  # which has the record of the part
        self.notes: NoteRange = self.instrument.spec.notes  # that it has
        self.mapping = UNMAPPED
        self.pending: dict[str, Pending] = {}

    @property
    def players(self) -> int:
        """How many players there are, whether they play or rest."""
        return len(self.instruments)

    @property
    def record(self) -> Any:
        """The part's record (``midi.record.MIDI``), with all that is posted for now."""
        self.instrument.interpret_events()
        return self.instrument.midi

    @property
    def delay(self) -> int:
        """Frames from the arrival of a message to its sound.

        Constant, and long enough that the frame has not been played yet, so that messages keep
        their rhythm.
        """
        return self.instrument.delay

    def frame_of(self, arrived_ns: int | None = None) -> int:
        """The frame for a message that arrived at this `clocks.monotonic_ns`; by default, now."""
        moment = clocks.monotonic_ns() if arrived_ns is None else arrived_ns
        return int(self.instrument.frame_at(moment)) + self.instrument.delay

    # -- parameters --------------------------------------------------------------------------

    @property
    def pitch(self) -> float | None:
        """The pitch (fractional MIDI note) while a note sounds or the bow is drawn by hand."""
        pitches = (float(instrument.meters()["pitch"]) for instrument in self.instruments)
        return next((pitch for pitch in pitches if not math.isnan(pitch)), None)

    def value(self, address: str) -> float:
        """The value that a parameter has or moves to; raises ParameterError where there is none."""
        param = find(address)
        pending = self._waiting(param)
        return self._had(param, self.record["value"]) if pending is None else pending.value

    def values(self) -> dict[str, float]:
        """The values of all parameters, by address."""
        waiting = {one: self._waiting(find(one)) for one in list(self.pending)}
        values = self.record["value"].tolist()  # now: it has what has stopped waiting
        found = {param.address: self._had(param, values) for param in TABLE}
        return found | {one: pending.value for one, pending in waiting.items() if pending}

    def _had(self, param: Param, values: Sequence[float]) -> float:
        """The value that the audio side has; `values` are those of the record."""
        if param.player_controlled:
            return self.instrument.target(param.address)
        return float(values[INDEX[param.address]])

    def keeps(self, address: str) -> bool:
        """Whether a parameter was written with ``hold``."""
        param = find(address)
        pending = self.pending.get(param.address)
        is_held = pending is not None and pending.is_held and self._waiting(param) is not None
        return is_held or bool(self.record["is_held"][INDEX[param.address]])

    def refuses(self, address: str) -> bool:
        """Whether a parameter is held, and none that plain writes take over."""
        return not find(address).player_controlled and self.keeps(address)

    def expect(self, values: Values[str, float], frame: int | None) -> None:
        """Answer with these values, but for held ones, until the audio side has what sets them."""
        for address, value in values.items():
            if not self.keeps(address):
                self._note(address, value, frame)

    def _note(
        self, address: str, value: float, frame: int | None, *, is_held: bool = False
    ) -> None:
        at = self.instrument.frame if frame is None else frame
        self.pending[address] = Pending(value, self.instrument.posted, at, is_held)

    def _waiting(self, param: Param) -> Pending | None:
        """The last direct write to a parameter, while the audio side does not have it."""
        pending = self.pending.get(param.address)
        if pending is None:
            return None
        meters = self.instrument.meters()
        is_done = meters["drained"] > pending.number and meters["next_frame"] > pending.frame
        # An instrument that is not live interprets due events whenever its record is read.
        is_read = not self.instrument.is_live and pending.frame <= self.instrument.frame
        if is_done or (is_read and not param.player_controlled):
            self.pending.pop(param.address, None)  # another thread may have done so
            return None
        return pending

    # -- notes -------------------------------------------------------------------------------

    @property
    def sounding(self) -> Key | None:
        """The key whose note sounds, if any."""
        record = self.record
        return None if record["sounding"] == NONE else self._key(record, record["sounding"])

    def held(self, channel: int | None = None) -> list[Key]:
        """The held keys, of one channel or all, in the order pressed."""
        record = self.record
        keys = (self._key(record, number) for number in range(record["held"]))
        return [key for key in keys if channel in (None, key.channel)]

    @staticmethod
    def _key(record: Any, number: int) -> Key:
        return Key(int(record["held_channel"][number]), float(record["held_key"][number]))

    @property
    def keys(self) -> int:
        """Number of keys that are held."""
        return int(self.record["held"])

    @property
    def notes_played(self) -> int:
        """Number of notes that were begun."""
        return int(self.record["notes"])

    @property
    def notes_out_of_range(self) -> int:
        """Number of notes that the instrument does not have, played or not."""
        return int(self.record["out_of_range"])

    @property
    def notes_by_channel(self) -> Counter[int]:
        """Number of notes played on each channel; -1 for those of no MIDI port."""
        counts = self.record["notes_of"].tolist()
        found = {channel: count for channel, count in enumerate(counts) if count}
        return Counter({-1 if c == CHANNEL_COUNT else c: count for c, count in found.items()})

    @property
    def seems_mpe(self) -> bool:
        """Whether a port without an MPE zone plays several channels but its first, as MPE does."""
        zones = self.record["lower"] + self.record["upper"]
        notes = self.record["notes_of"][:CHANNEL_COUNT].reshape(-1, CHANNELS_PER_PORT)
        several = (notes[:, 1:] > 0).sum(axis=1) >= MPE_FROM
        return bool(((zones == 0) & (notes[:, 0] == 0) & several).any())

    @property
    def percussion_notes(self) -> int:
        """Number of notes of the percussion channel, which are not played."""
        return int(self.record["percussion"])

    @property
    def unknown_programs(self) -> Counter[int]:
        """How often programs, from 1, were asked for that no preset has."""
        counts = self.record["unknown_program"].tolist()
        return Counter({program: count for program, count in enumerate(counts, 1) if count})

    def plays(self, channel: int) -> bool:
        """Whether the notes of a channel, counted from 0 over all ports, are played."""
        record = self.record
        tables = self.instrument.tables[record["tables"]]
        # As Python: compiling it would take longer than a short render.
        return uncompiled(plays)(with_fields(record), with_fields(tables), channel)

    # -- controllers -------------------------------------------------------------------------

    def bindings(self) -> list[tuple[Bind, float | None, float]]:
        """Each bind, the position (0 to 1) its source was last moved to, and the target's value."""
        record = self.record
        firsts: dict[str, int] = {}
        found = []
        for number, bind in enumerate(self.mapping.binds):
            first = firsts.setdefault(bind.source, number)
            position = _position(record, bind, number, first)
            found.append((bind, position, self.value(bind.target)))
        return found

    def sound(self) -> dict[str, float]:
        """What a preset keeps: parameters that the player does not move, but a note's velocity."""
        free = [
            param
            for param in TABLE
            if not (param.player_controlled or (self.part and param.is_shared))
        ]
        values = {param.address: self.value(param.address) for param in free}
        record = self.record
        for bind in self.mapping.of(VELOCITY):
            index = INDEX[find(bind.target).address]
            if bind.target in values and record["is_target"][index]:
                values[bind.target] = float(record["set_to"][index])
        return values


def _position(record: Any, bind: Bind, number: int, first: int) -> float | None:
    """Where a bind's source was last moved to, on any channel that it receives."""
    if is_address(bind.source):
        return (
            float(record["control_position"][number])
            if record["has_control_position"][number]
            else None
        )
    channels = np.arange(CHANNEL_COUNT)
    if bind.channels:
        channels = channels[np.isin(channels % CHANNELS_PER_PORT + 1, bind.channels)]
    if bind.source in (VELOCITY, NOTE):
        places = channels if bind.channels else np.arange(CHANNEL_COUNT + 1)
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
