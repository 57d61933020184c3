"""A score to be played, from any kind of file: messages and settings at times; and its notes."""

from __future__ import annotations

import contextlib
import errno
import math
import os
from bisect import insort
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from operator import itemgetter
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import mido

from yehu_server.core.midi.registered_parameters import MPE_CONFIGURATION, RPN_FINE
from yehu_server.errors import ScoreError, one_line
from yehu_server.playing.sources import MPE_FROM
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
        if error.errno == errno.EFBIG:
            raise ScoreError(f"larger than {most_bytes >> 20} MiB") from None
        raise ScoreError(f"cannot be read ({error_reason(error).lower()})") from None
    except ValueError:  # a NUL in the name
        raise ScoreError("cannot be read (no such file name)") from None
    if not data.strip():
        raise ScoreError("is empty")
    return data


BEND = "/playing/bend"  # address of what lies between keys


@dataclass(frozen=True)
class Setting:
    """A parameter that a score sets, among the messages of its events."""

    address: str  # of `params/table.py`
    value: float | None  # None: what it was before the score set it
    channel: int = 0  # of the part, counted from 0; where that is not played, nothing is set
    is_passing: bool = False  # holds until the next note begins, which ends it without a move
    type: ClassVar[str] = "setting"  # as messages have one


class ScoreEvent(NamedTuple):
    """One channel-voice message at its time (s) from the start of the score.

    `beat` is its time in quarter notes; NaN where the file counts frames of a film. `track` is
    counted from 1; 0 where there are no tracks.
    """

    time_s: float
    message: Any  # mido.Message, or Setting
    beat: float = math.nan
    track: int = 0


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
    events: tuple[ScoreEvent, ...]
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
    def notes(self) -> tuple[ScoreNote, ...]:
        """Its note-ons, in order, with what ends them, as a key struck again does."""
        return tuple(_paired(self))

    def __post_init__(self) -> None:
        check_duration(self.duration_s, LONGEST_DURATION_H)


def concatenate(scores: Sequence[Score]) -> Score:
    """Join scores, one after another; a system reset between them ends notes, pedals and bends."""
    events: list[ScoreEvent] = []
    start = 0.0
    for number, score in enumerate(scores, start=1):
        events += (
            ScoreEvent(start + event.time_s, event.message, event.beat, event.track)
            for event in score.events
        )
        start += score.duration_s
        if number < len(scores):
            events.append(ScoreEvent(start, mido.Message("reset")))
    names = " + ".join(score.name for score in scores)
    warnings = (f"{score.name}: {warning}" for score in scores for warning in score.warnings)
    remarks = (f"{score.name}: {remark}" for score in scores for remark in score.remarks)
    parts = scores[0].parts if scores else ()
    if len(scores) > 1:
        parts = tuple(replace(part, notes=0) for part in parts)
    metres = {score.metres for score in scores}  # from the beginning of each score
    metre = metres.pop() if len(metres) == 1 else (COMMON_TIME,)
    return Score(tuple(events), start, names, tuple(warnings), metre, parts, tuple(remarks))


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


def _paired(score: Score) -> Iterator[ScoreNote]:
    held: dict[tuple[int, int], list[Any]] = {}
    found: list[list[Any]] = []
    for number, (time_s, message, beat, track) in enumerate(score.events):
        kind = message.type
        if kind not in ("note_on", "note_off"):
            continue
        key = channel, note = message.channel, message.note
        if key in held:
            begun = held.pop(key)
            begun[1], begun[6] = number, time_s
        if kind == "note_on" and (velocity := message.velocity) > 0:
            begun = [number, -1, channel, note, velocity, time_s, score.duration_s, beat, track]
            held[key] = begun
            found.append(begun)
    return map(ScoreNote._make, found)


def without_notes(score: Score, notes: Collection[ScoreNote]) -> Score:
    """A score without some of its notes, and what ends them; another strike of the key stays."""
    if not notes:
        return score
    left = {note.begins for note in notes}
    left |= {note.ends for note in notes} - {note.begins for note in score.notes}
    events = (event for number, event in enumerate(score.events) if number not in left)
    return replace(score, events=tuple(events))


def distinct(messages: Iterable[Any]) -> list[Any]:
    """Messages, each object once; of a file, those that are equal are one."""
    return list({id(message): message for message in messages}.values())


def says_mpe(score: Score) -> bool:
    """Whether a score of MIDI says that its channels are notes of one player (MPE, RPN 6)."""
    return any(
        message.type == "control_change"
        and (message.control, message.value) == (RPN_FINE, MPE_CONFIGURATION)
        for message in distinct(map(itemgetter(1), score.events))
    )


def seems_mpe(score: Score) -> bool:
    """Whether each of several channels but the first has notes and a pressure, as of MPE."""
    messages = distinct(map(itemgetter(1), score.events))
    pressed = {message.channel for message in messages if message.type == "aftertouch"}
    played = {note.channel for note in score.notes}
    return len(played) >= MPE_FROM and 0 not in played and played <= pressed


def transposed(message: mido.Message, by: int) -> mido.Message:
    """A note-on or note-off so many semitones higher."""
    return _note(message.type, message.channel, message.note + by, message.velocity)


@lru_cache(maxsize=1 << 16)
def _note(kind: str, channel: int, note: int, velocity: int) -> mido.Message:
    """A message, cached and never changed, as mido checks each for long."""
    return mido.Message(kind, channel=channel, note=note, velocity=velocity)


# A phrase ends with a rest, with a note that lasts much longer than those about it, or when it is
# this long.
REST_S, LONG_NOTE, LONGEST_PHRASE_BEATS, MAX_NOTES = 0.3, 2.5, 16.0, 4096


def phrases_of(notes: Iterable[ScoreNote]) -> list[list[ScoreNote]]:
    """Divide the notes of one voice into phrases."""
    phrases: list[list[ScoreNote]] = []
    lengths: list[float] = []  # of the last phrase, sorted
    for note in notes:
        if not phrases or _ends_before(phrases[-1], lengths, note):
            phrases.append([])
            lengths = []
        phrases[-1].append(note)
        insort(lengths, note.length_s)
    return phrases


def _ends_before(phrase: list[ScoreNote], lengths: list[float], note: ScoreNote) -> bool:
    last = phrase[-1]
    if note.start_s - last.end_s >= REST_S:
        return True
    if note.beat - phrase[0].beat >= LONGEST_PHRASE_BEATS or len(phrase) >= MAX_NOTES:
        return True
    median_s = lengths[len(lengths) // 2]
    return len(phrase) > 3 and last.length_s > LONG_NOTE * median_s
