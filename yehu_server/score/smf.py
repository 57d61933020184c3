"""A tolerant reader of Standard MIDI Files.

Real files are cut short, have wrong counts of tracks, come in RIFF wrappers and have velocities
above 127. This reader keeps all valid messages, lists the damage in `Score.warnings`, and refuses
only files with nothing to play.
"""

from __future__ import annotations

import errno
import math
import os
import re
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from operator import itemgetter
from pathlib import Path
from typing import Literal

import mido

from yehu_server.errors import ScoreError
from yehu_server.files import read_bytes

MAX_BYTES = 64 * 2**20
MAX_EVENTS = 1_000_000  # of any kind; a message takes some 0.5 kB in memory
MAX_TRACKS = 65_535  # as many as a header can announce
MAX_CHUNKS = 2 * MAX_TRACKS
MAX_DURATION_H = 24
MAX_REST_S = 30  # between the last message and the end of a track

DEFAULT_TEMPO = 500_000  # microseconds a quarter note, 120 bpm
TRUE_FRAMES = {29: (30_000, 1001)}  # "29" frames a second are the 29.97 of drop-frame video

META, SYSEX, ESCAPE = 0xFF, 0xF0, 0xF7
END_OF_TRACK, SET_TEMPO, TIME_SIGNATURE = 0x2F, 0x51, 0x58
STATUS = re.compile(rb"[\x80-\xff]")
SYSTEM_DATA_BYTES = {0xF1: 1, 0xF2: 2, 0xF3: 1}


@dataclass(frozen=True)
class ScoreEvent:
    """One channel-voice message at its time (s) from the start of the score.

    `beat` is its time in quarter notes; NaN where the file counts frames of a film.
    """

    time_s: float
    message: mido.Message
    beat: float = math.nan


@dataclass(frozen=True)
class Metre:
    """A time signature: the beat (quarter notes) from which it holds, and its bars' length."""

    beat: float
    quarters: float


COMMON_TIME = Metre(0.0, 4.0)


@dataclass(frozen=True)
class Score:
    """A performance: events in order, and warnings about damage in the file.

    Parameters
    ----------
    events : tuple of ScoreEvent
        Sorted by time; at equal times, in the order of the tracks, then of the file.
    duration_s : float
        Up to the last event or end-of-track of the longest track, but not more than 30 s
        beyond the last event.
    name : str
        The file's name, without folder and extension.
    warnings : tuple of str
        One line for each kind of damage, with its count.
    metres : tuple of Metre
        The time signatures, in order.

    Raises
    ------
    ScoreError
        If the score lasts longer than a day.
    """

    events: tuple[ScoreEvent, ...]
    duration_s: float
    name: str = ""
    warnings: tuple[str, ...] = ()
    metres: tuple[Metre, ...] = (COMMON_TIME,)

    def bar_at(self, beat: float) -> tuple[float, float]:
        """Return the beat from which the metre of a beat holds, and the quarters in its bars."""
        metre = COMMON_TIME
        for each in self.metres:
            if each.beat > beat + 1e-9:
                break
            metre = each
        return metre.beat, metre.quarters

    def __post_init__(self) -> None:
        if self.duration_s > MAX_DURATION_H * 3600:
            hours = self.duration_s / 3600
            raise ScoreError(f"the score lasts {hours:.3g} hours, more than {MAX_DURATION_H}")


def read_score(path: str | os.PathLike[str]) -> Score:
    """Read a Standard MIDI File, bare or in a RIFF wrapper.

    Formats 0 and 1 play all tracks together under the tempo changes of all of them.
    Format 2 plays its tracks one after another, as `concatenate` would, each starting
    at 120 bpm with tempo changes of its own. Sysex, escapes and metas other than
    tempo and time signature are dropped. A channel message with a data byte above 127 is
    dropped as a whole.

    Raises
    ------
    ScoreError
        One line naming the file, whatever its bytes: missing, unreadable, too large or
        too long, not a MIDI file, or without one channel message to play.
    """
    shown = os.fspath(path)
    if not shown.isprintable():  # a line break or a stray byte in a name
        shown = ascii(shown)
    try:
        score = _parse(_load(path))
    except ScoreError as error:
        raise ScoreError(f"{shown}: {error}") from None
    return replace(score, name=Path(path).stem)


def concatenate(scores: Sequence[Score]) -> Score:
    """Join several scores, each beginning at the end of the one before.

    A system reset between them ends all notes, pedals and bends.
    """
    events: list[ScoreEvent] = []
    start = 0.0
    for number, score in enumerate(scores, start=1):
        events += (replace(event, time_s=start + event.time_s) for event in score.events)
        start += score.duration_s
        if number < len(scores):
            events.append(ScoreEvent(start, mido.Message("reset")))
    names = " + ".join(score.name for score in scores)
    warnings = (f"{score.name}: {warning}" for score in scores for warning in score.warnings)
    return Score(tuple(events), start, names, tuple(warnings))


# ---------------------------------------------------------------- the file


def _load(path: str | os.PathLike[str]) -> bytes:
    try:
        data = read_bytes(Path(path), MAX_BYTES)
    except OSError as error:
        if error.errno == errno.EFBIG:
            raise ScoreError(f"larger than {MAX_BYTES // 2**20} MiB") from None
        reason = error.strerror or type(error).__name__
        raise ScoreError(f"cannot be read ({reason.lower()})") from None
    except ValueError:  # a NUL in the name
        raise ScoreError("cannot be read (no such file name)") from None
    if not data:
        raise ScoreError("is empty")
    return data


def _parse(data: bytes) -> Score:
    found: Counter[str] = Counter()
    if data[:4] == b"RIFF" and data[8:12] == b"RMID":
        wrapped = _chunks(data[12:], "little", found)
        data = next((body for tag, body in wrapped if tag == b"data"), b"")
    if data[:4] != b"MThd":
        raise ScoreError("is not a MIDI file")
    chunks = _chunks(data, "big", found)
    header = next(chunks, (b"", b""))[1]
    if len(header) < 6:
        raise ScoreError("has a damaged header")
    file_format, announced, division = (
        int.from_bytes(header[at : at + 2], "big") for at in (0, 2, 4)
    )

    tracks: list[_Track] = []
    room = MAX_EVENTS
    for number, (tag, body) in enumerate(chunks):
        if number == MAX_CHUNKS:
            raise ScoreError(f"has more than {MAX_CHUNKS} chunks")
        if tag == b"MTrk":
            tracks.append(_decode(body, room, found))
            room -= tracks[-1].events
        if len(tracks) > MAX_TRACKS:
            raise ScoreError(f"has more than {MAX_TRACKS} tracks")
    if not any(track.messages for track in tracks):
        raise ScoreError("has no playable track")
    if len(tracks) != announced:
        found[f"{announced} tracks announced, {len(tracks)} found"] += 1
    if file_format > 2:
        found[f"unknown format {file_format}, read as format 1"] += 1

    if file_format == 2:
        score = concatenate([_play_together([track], division, found) for track in tracks])
    else:
        score = _play_together(tracks, division, found)
    times = (f" ({count} times)" if count > 1 else "" for count in found.values())
    return replace(score, warnings=tuple(map(str.__add__, found, times)))


def _chunks(
    data: bytes, order: Literal["big", "little"], found: Counter[str]
) -> Iterator[tuple[bytes, bytes]]:
    """Each chunk's tag and body; RIFF counts in little endian and pads to even lengths."""
    pos = 0
    while pos + 8 <= len(data):
        tag = data[pos : pos + 4]
        if not all(0x20 <= byte < 0x7F for byte in tag):
            # The length of the chunk before is wrong, or padding follows it.
            found["bytes outside any chunk skipped"] += 1
            pos = data.find(b"MTrk", pos)
            if pos < 0:
                return
            continue
        length = int.from_bytes(data[pos + 4 : pos + 8], order)
        body = data[pos + 8 : pos + 8 + length]
        if len(body) < length:
            found["the file is cut short"] += 1
        yield tag, body
        pos += 8 + length + (length % 2 if order == "little" else 0)


# ---------------------------------------------------------------- one track


@dataclass
class _Track:
    messages: list[tuple[int, mido.Message]] = field(default_factory=list)  # at ticks
    tempos: list[tuple[int, int]] = field(default_factory=list)  # at ticks, in us a quarter
    metres: list[tuple[int, float]] = field(default_factory=list)  # at ticks, quarters a bar
    end: int = 0  # ticks
    events: int = 0  # of any kind, dropped ones too


@dataclass
class _Cursor:
    """A position in a track; a step past the end raises EOFError."""

    data: bytes
    pos: int = 0

    def take(self, length: int) -> bytes:
        taken = self.data[self.pos : self.pos + length]
        if len(taken) < length:
            raise EOFError
        self.pos += length
        return taken

    def byte(self) -> int:
        if self.pos >= len(self.data):
            raise EOFError
        self.pos += 1
        return self.data[self.pos - 1]

    def at_status(self) -> bool:
        if self.pos >= len(self.data):
            raise EOFError
        return self.data[self.pos] >= 0x80

    def skip_to_status(self) -> None:
        found = STATUS.search(self.data, self.pos)
        if found is None:
            raise EOFError
        self.pos = found.start()

    def number(self) -> int:
        """A variable-length number; at most four bytes, as in the format."""
        value = 0
        for _ in range(4):
            byte = self.byte()
            value = value << 7 | byte & 0x7F
            if byte < 0x80:
                break
        return value


@lru_cache(maxsize=1 << 16)
def _message(status: int, body: bytes) -> mido.Message:
    """A message, cached and never changed: making one takes longer than the rest of reading."""
    return mido.Message.from_bytes([status, *body])


def _decode(data: bytes, room: int, found: Counter[str]) -> _Track:
    """Read one track as far as possible; raises ScoreError for more than `room` events."""
    track = _Track()
    cursor = _Cursor(data)
    tick = 0
    running = 0  # kept across metas and sysex, as some writers rely on it
    try:
        while cursor.pos < len(data):  # a missing end-of-track does no harm
            tick += cursor.number()
            if not running and not cursor.at_status():
                found["data without a status byte skipped"] += 1
                cursor.skip_to_status()
            status = cursor.byte() if cursor.at_status() else running
            if status == META:
                kind = cursor.byte()
                body = cursor.take(cursor.number())
                if kind == SET_TEMPO:
                    tempo = int.from_bytes(body[:3], "big")
                    if len(body) >= 3 and tempo > 0:
                        track.tempos.append((tick, tempo))
                    else:
                        found["a tempo of zero or cut short ignored"] += 1
                elif kind == TIME_SIGNATURE and len(body) >= 2 and body[0] > 0 and body[1] < 8:
                    track.metres.append((tick, 4.0 * body[0] / 2.0 ** body[1]))
            elif status in (SYSEX, ESCAPE):
                cursor.take(cursor.number())
            elif status > SYSEX:
                found["a system message, which no file should hold, skipped"] += 1
                cursor.take(SYSTEM_DATA_BYTES.get(status, 0))
            else:
                running = status
                body = cursor.take(1 if status & 0xE0 == 0xC0 else 2)
                if max(body) < 0x80:
                    track.messages.append((tick, _message(status, body)))
                else:
                    # Dropped at its full length: mostly this is a velocity above 127, and the
                    # next message is intact.
                    found["a damaged message dropped"] += 1
            track.end = tick
            if status == META and kind == END_OF_TRACK:
                break
            track.events += 1
            if track.events > room:
                raise ScoreError(f"has more than {MAX_EVENTS} events")
    except EOFError:
        found["a track ends in the middle of an event"] += 1
    return track


# ---------------------------------------------------------------- ticks to seconds


class _Clock:
    """Converts ticks to seconds, in integers so that long files do not drift."""

    def __init__(self, division: int, tempos: Sequence[tuple[int, int]]) -> None:
        if division >= 0x8000:  # SMPTE: no tempo, frames a second and ticks a frame
            frames, seconds = TRUE_FRAMES.get(256 - (division >> 8), (256 - (division >> 8), 1))
            self._units_per_second = frames * (division & 0xFF)
            changes = [(0, seconds)]
        else:
            self._units_per_second = division * 1_000_000
            changes = [(0, DEFAULT_TEMPO), *tempos]
        if self._units_per_second == 0:
            raise ScoreError("has a time division of zero")
        self._ticks: list[int] = []
        self._spans: list[tuple[int, int]] = []  # units so far, units a tick from here on
        for tick, rate in changes:
            so_far = self._units(tick) if self._ticks else 0
            self._ticks.append(tick)
            self._spans.append((so_far, rate))

    def _units(self, tick: int) -> int:
        at = bisect_right(self._ticks, tick) - 1
        so_far, rate = self._spans[at]
        return so_far + (tick - self._ticks[at]) * rate

    def seconds(self, tick: int) -> float:
        return self._units(tick) / self._units_per_second


def _play_together(tracks: Sequence[_Track], division: int, found: Counter[str]) -> Score:
    # Sorting is stable: at one tick, the order of the tracks and within them stays.
    tempos = sorted((tempo for track in tracks for tempo in track.tempos), key=itemgetter(0))
    messages = sorted((pair for track in tracks for pair in track.messages), key=itemgetter(0))
    clock = _Clock(division, tempos)
    per_beat = division if division < 0x8000 else math.nan
    events = tuple(
        ScoreEvent(clock.seconds(tick), message, tick / per_beat) for tick, message in messages
    )
    end_s = clock.seconds(max(track.end for track in tracks))
    latest_s = (events[-1].time_s if events else 0.0) + MAX_REST_S
    if end_s > latest_s:
        found[f"silence at the end cut to {MAX_REST_S} s"] += 1
    signatures = sorted((each for track in tracks for each in track.metres), key=itemgetter(0))
    metres = (Metre(tick / per_beat, quarters) for tick, quarters in signatures)
    return Score(events, min(end_s, latest_s), metres=(COMMON_TIME, *metres))
