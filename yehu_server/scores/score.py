"""A score to be played, from any kind of file: messages and settings at times; and its notes."""

from __future__ import annotations

import contextlib
import math
import os
from bisect import insort
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import mido
import numpy as np

from yehu_server.core.midi.registered_parameters import MPE_CONFIGURATION, RPN_FINE
from yehu_server.errors import ScoreError, one_line
from yehu_server.playing.sources import MPE_FROM
from yehu_server.scores.events import AFTERTOUCH, CONTROL, Array, Events, NoteColumns, uncollected
from yehu_server.util.files import error_reason, read_bytes

MAX_DURATION_H = 2.0  # of all that is played, where no other is asked for
LONGEST_DURATION_H = 1000.0  # that may be asked for
MAX_SHOWN = 40  # characters of words of a score


def check_duration(seconds: float, max_duration_h: float, what: str = "the score lasts") -> None:
    """Raise ScoreError where a score lasts longer than so many hours."""
    hours = seconds / 3600.0
    if hours > max_duration_h:
        raise ScoreError(
            f"{what} {hours:.3g} hours, more than {max_duration_h:g}: see --max-duration"
        )


@contextlib.contextmanager
def errors_name(path: str | os.PathLike[str]) -> Iterator[None]:
    """Let errors about a score name its file."""
    try:
        yield
    except ScoreError as error:
        raise type(error)(f"{one_line(os.fspath(path))}: {error}") from None


def printable(text: str) -> str:
    """Words of a score for a message: short, and of one line."""
    line = one_line(text.strip())
    return line if len(line) <= MAX_SHOWN else f"{line[:MAX_SHOWN]}..."


def read_score_bytes(path: str | os.PathLike[str], most_bytes: int) -> bytes:
    """Read the file of a score.

    Raises ScoreError, one line, without the file's name: where it cannot be read, is too large or
    empty.
    """
    try:
        data = read_bytes(Path(path), most_bytes)
    except OSError as error:
        raise ScoreError(error_reason(error)) from None
    if not data.strip():
        raise ScoreError("is empty")
    return data


@dataclass(frozen=True)
class Metre:
    """A time signature: the beat (quarter notes) from which it holds, and its bars' length."""

    beat: float
    quarters: float


COMMON_TIME = Metre(0.0, 4.0)
_NAMES = ("Cb", "Gb", "Db", "Ab", "Eb", "Bb", "F", "C", "G", "D", "A", "E", "B", "F#", "C#")
DO_BY_FIFTHS = dict(zip(range(-7, 8), _NAMES, strict=True))


def nearest_key(fifths: int) -> int:
    """The key signature on the same do that has five flats to six sharps."""
    return (fifths + 5) % 12 - 5


@dataclass(frozen=True)
class KeySignature:
    """A key signature: the beat (quarter notes) from which it holds; sharps, or below 0 flats."""

    beat: Fraction
    fifths: int  # -7 to 7

    @property
    def do(self) -> str:
        """The name of do in this key, such as F or Bb."""
        return DO_BY_FIFTHS[self.fifths]


@dataclass(frozen=True)
class ScorePart:
    """A part of a score, by its name: what a channel plays, or a track, or both; None: any.

    Channels are counted from 0, tracks from 1.
    """

    name: str
    channel: int | None = None
    track: int | None = None
    notes: int = 0  # as written; 0: not known


@dataclass(frozen=True)
class Score:
    """A performance: events in order, and warnings about damage in the file.

    Raises ScoreError if the score lasts longer than 1000 hours.
    """

    # Sorted by time; at equal times, in the order of the tracks, then of the file.
    events: Events
    # Up to the last event or end-of-track of the longest track, but not more than 30 s beyond the
    # last event.
    duration_s: float
    name: str = ""  # the file's name, without folder and extension
    # One line for each kind of damage, with its count and the byte where it is first.
    warnings: tuple[str, ...] = ()
    metres: tuple[Metre, ...] = (COMMON_TIME,)  # the time signatures, in order
    parts: tuple[ScorePart, ...] = ()  # those with notes, as far as they are known
    # One line each, which a player should know and which are no fault of a file.
    remarks: tuple[str, ...] = ()
    keys: tuple[KeySignature, ...] = ()  # in order, as far as they are known
    # Its delays at full rubato (``rubato.delays_of``); none where that is not known.
    delays: tuple[tuple[float, float], ...] = ()
    is_written: bool = False  # from notation, whose dynamics hold for many notes

    def bar_at(self, beat: float) -> tuple[float, float]:
        """Return the beat from which the metre of a beat holds, and the quarters in its bars."""
        metre = COMMON_TIME
        for each in self.metres:
            if each.beat > beat + 1e-9:
                break
            metre = each
        return metre.beat, metre.quarters

    @cached_property
    def note_columns(self) -> NoteColumns:
        """Its note-ons, in order, with what ends them, as a key struck again does."""
        events = self.events
        begins, ends = events.struck_and_ends
        end_s = np.where(ends < 0, self.duration_s, events.time_s[ends])
        code, start_s = events.code[begins], events.time_s[begins]
        pitch = code >> 16 & 15, code >> 8 & 127, code & 127
        more = start_s, end_s, events.beat[begins], events.track[begins]
        return NoteColumns(begins, ends, *pitch, *more)

    @cached_property
    def notes(self) -> tuple[ScoreNote, ...]:
        """The same as objects."""
        columns = (column.tolist() for column in self.note_columns)
        with uncollected():
            return tuple(map(ScoreNote._make, zip(*columns, strict=True)))

    def __post_init__(self) -> None:
        check_duration(self.duration_s, LONGEST_DURATION_H)


def concatenate(scores: Sequence[Score]) -> Score:
    """Join scores, one after another; a system reset between them ends notes, pedals and bends."""
    columns: list[tuple[Any, ...]] = []
    others: list[Any] = [mido.Message("reset")]
    start = 0.0
    for number, score in enumerate(scores, start=1):
        events = score.events
        code = np.where(events.code < 0, events.code - len(others), events.code)
        columns.append((start + events.time_s, events.beat, events.track, code))
        others += events.others
        start += score.duration_s
        if number < len(scores):
            columns.append(([start], [math.nan], [0], [-1]))
    names = " + ".join(score.name for score in scores)
    warnings = (f"{score.name}: {warning}" for score in scores for warning in score.warnings)
    remarks = (f"{score.name}: {remark}" for score in scores for remark in score.remarks)
    parts = scores[0].parts if scores else ()
    if len(scores) > 1:
        parts = tuple(replace(part, notes=0) for part in parts)
    metres = {score.metres for score in scores}  # from the beginning of each score
    metre = metres.pop() if len(metres) == 1 else (COMMON_TIME,)
    joined = Events.of(())
    if columns:
        time_s, beat, track, code = map(np.concatenate, zip(*columns, strict=True))
        joined = Events(time_s, beat, track, code, tuple(others))
    return Score(joined, start, names, tuple(warnings), metre, parts, tuple(remarks))


class ScoreNote(NamedTuple):
    """A note of a score, with the numbers of its events; times in seconds."""

    # Numbers of its note-on and its note-off; `ends` is -1 where nothing ends it.
    begins: int
    ends: int
    channel: int
    key: int
    velocity: int
    start_s: float
    end_s: float
    beat: float  # quarter notes since the beginning of the score; NaN where it has none
    track: int = 0  # as of its events

    @property
    def length_s(self) -> float:
        """Its duration (s)."""
        return self.end_s - self.start_s


def without_notes(score: Score, begins: Array) -> Score:
    """A score without the notes that some events begin, and without what ends them.

    Another strike of the key stays.
    """
    if len(begins) == 0:
        return score
    notes = score.note_columns
    ends = notes.ends[np.isin(notes.begins, begins)]
    kept = np.ones(len(score.events), bool)
    kept[ends[ends >= 0]] = False
    kept[notes.begins] = True
    kept[begins] = False
    return replace(score, events=score.events.where(kept))


def says_mpe(score: Score) -> bool:
    """Whether a score of MIDI says that its channels are notes of one player (MPE, RPN 6)."""
    said = CONTROL, RPN_FINE, MPE_CONFIGURATION
    return bool((score.events.code & 0xF0FFFF == said[0] << 20 | said[1] << 8 | said[2]).any())


def seems_mpe(score: Score) -> bool:
    """Whether each of several channels but the first has notes and a pressure, as of MPE."""
    events = score.events
    pressed = {*(events.code[events.kind == AFTERTOUCH] >> 16 & 15).tolist()}
    played = {*score.note_columns.channel.tolist()}
    return len(played) >= MPE_FROM and 0 not in played and played <= pressed


# A phrase ends with a rest, with a note that lasts much longer than those about it, or when it is
# this long.
REST_S, LONG_NOTE, LONGEST_PHRASE_BEATS, MAX_NOTES = 0.3, 2.5, 16.0, 4096


def phrases_of(notes: Sequence[ScoreNote]) -> list[list[ScoreNote]]:
    """Divide the notes of one voice into phrases."""
    spans = [(note.start_s, note.end_s, note.beat) for note in notes]
    starts = phrase_starts(*zip(*spans, strict=True)) if spans else []
    return [[*notes[begin:end]] for begin, end in pairwise([*starts, len(notes)])]


def phrase_starts(
    starts_s: Sequence[float], ends_s: Sequence[float], beats: Sequence[float]
) -> list[int]:
    """The places at which phrases of the notes of one voice begin."""
    starts: list[int] = []
    lengths: list[float] = []  # of the phrase's notes, sorted
    last_end, last_length, first_beat = -math.inf, 0.0, 0.0
    for place, (start, end, beat) in enumerate(zip(starts_s, ends_s, beats, strict=True)):
        count = len(lengths)
        if (
            start - last_end >= REST_S
            or beat - first_beat >= LONGEST_PHRASE_BEATS
            or count >= MAX_NOTES
            or (count > 3 and last_length > LONG_NOTE * lengths[count // 2])
        ):
            starts.append(place)
            lengths, first_beat = [], beat
        last_end, last_length = end, end - start
        insort(lengths, last_length)
    return starts
