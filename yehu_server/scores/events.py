"""The events of a score in columns: objects of a million messages take seconds to make.

An event is an object where something asks for one.
"""

from __future__ import annotations

import contextlib
import gc
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, NamedTuple, overload

import mido
import numpy as np

from yehu_server.scores.octaves import NoteSpans

Array = Any

BEND = "/playing/bend"  # address of what lies between keys


class Setting(NamedTuple):
    """A parameter that a score sets, among the messages of its events."""

    address: str  # of `params/table.py`
    value: float | None  # None: what it was before the score set it
    channel: int = 0  # of the part, counted from 0; where that is not played, nothing is set
    is_passing: bool = False  # holds until the next note begins, which ends it without a move

    @property
    def type(self) -> str:
        """Its type, as messages have one."""
        return "setting"


class ScoreEvent(NamedTuple):
    """One channel-voice message at its time (s) from the start of the score.

    `beat` is its time in quarter notes; NaN where the file counts frames of a film. `track` is
    counted from 1; 0 where there are no tracks.
    """

    time_s: float
    message: Any  # mido.Message, or Setting
    beat: float = math.nan
    track: int = 0


# Kinds of channel messages: the upper half of the status. By kind, mido's names of it and its data.
NOTE_OFF, NOTE_ON, POLYTOUCH, CONTROL, PROGRAM, AFTERTOUCH, PITCHWHEEL = range(8, 15)
NAMES: dict[int, tuple[str, ...]] = {
    NOTE_OFF: ("note_off", "note", "velocity"),
    NOTE_ON: ("note_on", "note", "velocity"),
    POLYTOUCH: ("polytouch", "note", "value"),
    CONTROL: ("control_change", "control", "value"),
    PROGRAM: ("program_change", "program"),
    AFTERTOUCH: ("aftertouch", "value"),
    PITCHWHEEL: ("pitchwheel", "pitch"),
}
CHANNEL_MESSAGES = {name for name, *_ in NAMES.values()}
CENTRE = 8192  # of a pitch wheel
KEY = 1 << 8  # a key's place in a code


def code_of(message: Any) -> int | None:
    """A channel message as a number, status and data bytes; None for other messages."""
    if message.type not in CHANNEL_MESSAGES:
        return None
    data: list[int] = [*message.bytes(), 0]
    return data[0] << 16 | data[1] << 8 | data[2]


@contextlib.contextmanager
def uncollected() -> Iterator[None]:
    """Let no collector look for garbage among the million objects of a large score."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


class _Messages(dict[int, Any]):
    """Messages by code, each made once, and without mido's checks, which take long."""

    def __missing__(self, code: int) -> mido.Message:
        name, first, *second = NAMES[code >> 20]
        message = self[code] = object.__new__(mido.Message)
        own = vars(message)
        own["type"], own["time"], own["channel"] = name, 0, code >> 16 & 15
        own[first] = code >> 8 & 127
        if second:
            own[second[0]] = code & 127
        elif name == "pitchwheel":
            own[first] += (code & 127) * 128 - CENTRE
        return message


class NoteColumns(NamedTuple):
    """Notes as of `ScoreNote`, in columns [shape=(notes,)]."""

    begins: Array
    ends: Array
    channel: Array
    key: Array
    velocity: Array
    start_s: Array
    end_s: Array
    beat: Array
    track: Array

    def where(self, chosen: Array) -> NoteColumns:
        """Those of a mask."""
        return NoteColumns(*(column[chosen] for column in self))

    def spans(self, part: Any = 0, sharper: Any = 0.0) -> NoteSpans:
        """When they sound and their pitches, so many semitones above the keys, as of some parts."""
        pitch, part = self.key + sharper, np.broadcast_to(part, self.key.shape)
        return NoteSpans(self.start_s, self.end_s, pitch, pitch, part)


@dataclass(frozen=True, eq=False)
class Events(Sequence[ScoreEvent]):
    """Events in order, in columns [shape=(events,)]: time (s), beat, track, and code."""

    time_s: Array
    beat: Array
    track: Array
    code: Array  # of `code_of`; of another message -1 less its place in `others`
    others: tuple[Any, ...] = ()

    @classmethod
    def of(cls, rows: Iterable[ScoreEvent]) -> Events:
        """Events that are objects already."""
        rows = tuple(rows)
        codes, others = [], []
        for _, message, *_ in rows:
            code = code_of(message)
            if code is None:
                others.append(message)
                code = -len(others)
            codes.append(code)
        times, _, beats, tracks = zip(*rows, strict=True) if rows else ((),) * 4
        columns = np.array(times, float), np.array(beats, float), np.array(tracks, np.int64)
        found = cls(*columns, np.array(codes, np.int64), tuple(others))
        vars(found)["rows"] = rows
        return found

    @cached_property
    def rows(self) -> tuple[ScoreEvent, ...]:
        """The events as objects; messages that are equal are one."""
        known = _Messages({-1 - place: message for place, message in enumerate(self.others)})
        messages = map(known.__getitem__, self.code.tolist())
        times, beats, tracks = (each.tolist() for each in (self.time_s, self.beat, self.track))
        columns = zip(times, messages, beats, tracks, strict=True)
        with uncollected():
            return tuple(map(partial(tuple.__new__, ScoreEvent), columns))

    @property
    def kind(self) -> Array:
        """The kinds of messages; below 0 for others."""
        return self.code >> 20

    @property
    def channel(self) -> Array:
        """The channels of messages, counted from 0; -1 where they have none."""
        found = np.where(self.code >= 0, self.code >> 16 & 15, -1)
        for place in np.flatnonzero(self.code < 0):
            found[place] = getattr(self.others[-1 - self.code[place]], "channel", -1)
        return found

    @property
    def first(self) -> Array:
        """The first data bytes of channel messages."""
        return self.code >> 8 & 127

    @property
    def second(self) -> Array:
        """The second data bytes of channel messages; 0 where they have none."""
        return self.code & 127

    @property
    def is_struck(self) -> Array:
        """Whether each begins a note."""
        return (self.kind == NOTE_ON) & (self.second > 0)

    @cached_property
    def struck_and_ends(self) -> tuple[Array, Array]:
        """The places of what begins notes, and of what ends each: -1 where nothing does."""
        is_struck, kind = self.is_struck, self.kind
        notes = np.flatnonzero((kind == NOTE_ON) | (kind == NOTE_OFF))
        source = (self.code[notes] >> 8 & 0xF7F).astype(np.int16)
        order = np.argsort(source, kind="stable")
        ends = np.full(len(notes), -1)
        same = source[order[1:]] == source[order[:-1]]
        ends[order[:-1][same]] = notes[order[1:][same]]
        return notes[is_struck[notes]], ends[is_struck[notes]]

    def where(self, chosen: Array) -> Events:
        """Those of a mask, or in the order of some places."""
        columns = self.time_s, self.beat, self.track, self.code
        time_s, beat, track, code = (column[chosen] for column in columns)
        return Events(time_s, beat, track, code, self.others)

    def with_codes(self, code: Array, others: tuple[Any, ...] = ()) -> Events:
        """The same with other messages."""
        return replace(self, code=code, others=(*self.others, *others))

    def with_before(self, before: Sequence[tuple[int, ScoreEvent]]) -> Events:
        """The same with more events, each before that at a place."""
        places = np.array([place for place, _ in before], np.int64)
        added = Events.of(event for _, event in before)
        code = np.where(added.code < 0, added.code - len(self.others), added.code)
        return Events(
            np.insert(self.time_s, places, added.time_s),
            np.insert(self.beat, places, added.beat),
            np.insert(self.track, places, added.track),
            np.insert(self.code, places, code),
            (*self.others, *added.others),
        )

    def __len__(self) -> int:
        return len(self.code)

    def __iter__(self) -> Iterator[ScoreEvent]:
        return iter(self.rows)

    @overload
    def __getitem__(self, place: int) -> ScoreEvent: ...
    @overload
    def __getitem__(self, place: slice) -> tuple[ScoreEvent, ...]: ...
    def __getitem__(self, place: int | slice) -> ScoreEvent | tuple[ScoreEvent, ...]:
        """An event, or a tuple of some."""
        return self.rows[place]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Events) and self.rows == other.rows

    __hash__ = None  # type: ignore[assignment]
