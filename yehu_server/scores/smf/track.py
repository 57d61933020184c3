"""Decode one track of a MIDI file to messages at ticks, convert these to seconds, note damage."""

import math
import re
from array import array
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from yehu_server.errors import ScoreError
from yehu_server.scores.encodings import NAMES, decoded, encoding_of
from yehu_server.scores.smf.tunings import MAX_MESSAGES, is_tuning

MAX_KINDS = 30  # listed separately; a hostile file could have one for each of its bytes
OTHERS = "further faults of other kinds"


Array = Any


class DamagedError(ScoreError):
    """A file that could be played, with damage, where none is accepted."""


class DamageReport:
    """The damage found in one file, by kind; each entry says how the reader went on."""

    def __init__(self) -> None:
        self._found: dict[str, tuple[int, int]] = {}  # how often, and the first byte

    def add(self, what: str, at: int, count: int = 1) -> None:
        """Note a fault at a byte of the file, counted from 0, or several, first there."""
        if what not in self._found and len(self._found) >= MAX_KINDS:
            what = OTHERS
        times, first = self._found.get(what, (0, at))
        self._found[what] = (times + count, min(first, at))

    @property
    def warnings(self) -> tuple[str, ...]:
        """A line for each kind, by place in the file."""
        by_place = sorted(self._found.items(), key=lambda fault: fault[1][1])
        return tuple(_describe(what, times, at) for what, (times, at) in by_place)

    def refuse(self) -> None:
        """Raise DamagedError for the first fault in the file, if there is one."""
        if self._found:
            what, (_, at) = min(self._found.items(), key=lambda fault: fault[1][1])
            raise DamagedError(f"{_describe(what, 1, at)}: refused by --strict")


def _describe(what: str, times: int, at: int) -> str:
    return f"{what}, at byte {at}" if times == 1 else f"{what}, {times} times, first at byte {at}"


DEFAULT_TEMPO = 500_000  # microseconds a quarter note, 120 bpm
DEFAULT_TICKS = 480  # a quarter note, where a file has 0
DEFAULT_FRAME_TICKS = 40  # with 25 frames a second, milliseconds
TRUE_FRAMES = {29: (30_000, 1001)}  # "29" frames a second are the 29.97 of drop-frame video
FILM_FRAMES = (24, 25, 29, 30)
SMPTE = 0x8000
UNPLAYED = np.iinfo(np.int64).max  # units of time that no score lasts
META, SYSEX, ESCAPE = 0xFF, 0xF0, 0xF7
TRACK_NAME, END_OF_TRACK, SET_TEMPO, TIME_SIGNATURE, KEY_SIGNATURE = 0x03, 0x2F, 0x51, 0x58, 0x59
MAX_SHARPS = 7  # or flats, of a key signature
LONGEST_NAME, LONGEST_NAME_BYTES = 40, 160  # characters of 1 to 4 bytes
STATUS = re.compile(rb"[\x80-\xff]")
SYSTEM_DATA_BYTES = {0xF1: 1, 0xF2: 2, 0xF3: 1}
NUMBER_BYTES = 4  # of a variable-length number, as the format has it
LONGEST_NUMBER_BYTES = 8  # as some writers have it, padded
LARGEST_NUMBER = 0x0FFF_FFFF


def checked_division(division: int, at: int, faults: DamageReport) -> int:
    """Return the division of a header, at a byte; where it is impossible, the one assumed."""
    if division == 0:
        faults.add(f"a division of 0: {DEFAULT_TICKS} ticks a quarter note assumed", at)
        return DEFAULT_TICKS
    if division < SMPTE:
        return division
    frames = 256 - (division >> 8)
    if frames not in FILM_FRAMES:
        faults.add(f"{frames} frames a second, as no film has, believed", at)
    if division & 0xFF == 0:
        faults.add(f"a division of 0: {DEFAULT_FRAME_TICKS} ticks a frame assumed", at)
        return division | DEFAULT_FRAME_TICKS
    return division


class Clock:
    """Converts ticks to seconds, in integers so that long files do not drift.

    The division is as in a header, not 0: ticks a quarter note, or frames a second and ticks a
    frame. Tempos are ticks, in order, and the microseconds of a quarter note from there on.
    """

    def __init__(self, division: int, tempos: Sequence[tuple[int, int]]) -> None:
        if division >= SMPTE:  # no tempo
            frames, seconds = TRUE_FRAMES.get(256 - (division >> 8), (256 - (division >> 8), 1))
            self._units_per_second = frames * (division & 0xFF)
            changes = [(0, seconds)]
        else:
            self._units_per_second = division * 1_000_000
            changes = [(0, DEFAULT_TEMPO), *tempos]
        self.per_beat: float = math.nan if division >= SMPTE else division
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
        """The time (s) of a tick."""
        return self._units(tick) / self._units_per_second

    def beat(self, tick: int) -> float:
        """The time of a tick in quarter notes; NaN where frames are counted."""
        return tick / self.per_beat

    @property
    def spans(self) -> Iterator[tuple[int, int, int, int]]:
        """From each tempo on: its tick, units so far, units a tick, and units a second."""
        for tick, (so_far, rate) in zip(self._ticks, self._spans, strict=True):
            yield tick, min(so_far, UNPLAYED), rate, self._units_per_second


def times_of(clocks: Sequence[Clock], begins: Sequence[int], ticks: Array) -> tuple[Array, Array]:
    """The seconds and beats of ticks that are played [shape=(ticks,)].

    Ticks are those of the songs of some clocks, which begin at some ticks.
    """
    spans = [
        (begin + tick, begin, *span)
        for clock, begin in zip(clocks, begins, strict=False)
        for tick, *span in clock.spans
    ]
    since, begin, so_far, rate, per_second = np.array(spans).T
    per_beat = np.array([clock.per_beat for clock in clocks])
    at = np.searchsorted(since, ticks, side="right") - 1
    units = so_far[at] + (ticks - since[at]) * rate[at]
    song = np.searchsorted(begins, ticks, side="right") - 1
    return units / per_second[at], (ticks - begin[at]) / per_beat[song]


@dataclass
class Track:
    """Where a track's messages are, and its other events, at ticks."""

    begin: int = 0  # place of its first message among those of the file, and after its last
    after: int = 0
    tempos: list[tuple[int, int]] = field(default_factory=list)  # in us a quarter
    metres: list[tuple[int, float]] = field(default_factory=list)  # quarters a bar
    keys: list[tuple[int, int]] = field(default_factory=list)  # sharps, or below 0 flats
    tunings: list[tuple[int, bytes]] = field(default_factory=list)  # by system exclusive
    end: int = 0  # ticks
    end_at: int = 0  # byte of the last event
    events: int = 0  # of any kind, dropped ones too
    longest: tuple[int, int, int] = (0, 0, 0)  # rest before an event: ticks, its end, its byte
    name: bytes = b""  # in an encoding that nothing says
    start_at: int = 0  # its first byte in the file
    is_whole: bool = True  # not cut in the middle of an event
    after_end: int | None = None  # byte after the end-of-track event


class Decoded:
    """The channel messages of a file as they are found, in columns."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        # Of each: its tick in its track, its byte in the file, that of its data, its status.
        self.columns = tuple(array("q") for _ in range(4))


def decode(decoded: Decoded, start: int, stop: int, room: int, faults: DamageReport) -> Track:
    """Read the events from one byte to another, as far as possible.

    Reading ends with the first event beyond `room`, so that `events` is larger then.
    """
    data, columns = decoded.data, decoded.columns
    track = Track(start_at=start, begin=len(columns[0]))
    keep_tick, keep_at, keep_body, keep_status = (column.append for column in columns)
    tick = longest = events = end = end_at = 0
    at = pos = start  # the latter beyond `stop` where an event is cut
    running = length = 0  # kept across metas and sysex, as some writers rely on it
    while pos < stop and events <= room:
        at = pos
        delta = data[at]
        pos = at + 1
        if delta >= 0x80:
            delta, pos = _number(data, at, stop, faults)
        tick += delta
        status = data[pos] if pos < stop else 0
        if status >= 0x80:
            pos += 1
        elif running:
            status = running
        else:
            status, pos = _next_status(data, pos, stop, faults)
        if status < SYSEX:
            if status != running:
                running, length = status, 1 if status & 0xE0 == 0xC0 else 2
            body = pos
            pos += length
            if pos > stop:
                break
            keep_tick(tick)
            keep_at(at)
            keep_body(body)
            keep_status(status)
        else:
            pos = _take_other(track, data, pos, stop, (status, tick, at), faults)
            if pos > stop:
                break
        end, end_at = tick, at
        if track.after_end is not None:
            break
        if delta > longest:
            longest = delta
            track.longest = delta, tick, at
        events += 1
    if pos > stop:
        track.is_whole = False
        faults.add("a track ends in the middle of an event", at)
    track.events, track.end, track.end_at, track.after = events, end, end_at, len(columns[0])
    return track


def _number(data: bytes, pos: int, stop: int, faults: DamageReport) -> tuple[int, int]:
    """A variable-length number, and the byte after it; one that is padded is read to its end."""
    value = 0
    for place in range(LONGEST_NUMBER_BYTES):
        if pos + place >= stop:
            return 0, stop + 1
        byte = data[pos + place]
        if place == NUMBER_BYTES:
            faults.add(f"a number of more than {NUMBER_BYTES} bytes", pos)
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            break
    return min(value, LARGEST_NUMBER), pos + place + 1


def _next_status(data: bytes, pos: int, stop: int, faults: DamageReport) -> tuple[int, int]:
    """The first status byte from here on, and the byte after it."""
    if pos < stop:
        faults.add("data without a status byte skipped", pos)
    found = STATUS.search(data, pos, stop)
    return (data[found.start()], found.end()) if found else (SYSEX, stop + 1)


def _take_other(
    track: Track,
    data: bytes,
    pos: int,
    stop: int,
    place: tuple[int, int, int],
    faults: DamageReport,
) -> int:
    """Read an event that is no channel message, after its status; return the byte after it.

    `place`: its status, tick, and byte.
    """
    status, tick, at = place
    if status not in (META, SYSEX, ESCAPE):
        faults.add("a system message, which no file should hold, skipped", at)
        return pos + SYSTEM_DATA_BYTES.get(status, 0)
    is_meta = status == META
    length, begin = _number(data, pos + is_meta, stop, faults)
    after = begin + length
    if after > stop:
        return after
    body = data[begin:after]
    if is_meta and data[pos] == END_OF_TRACK:
        track.after_end = after
    elif is_meta:
        _keep(track, tick, data[pos], body, at, faults)
    elif status == SYSEX and is_tuning(body) and len(track.tunings) < MAX_MESSAGES:
        track.tunings.append((tick, body))
    return after


def _keep(track: Track, tick: int, kind: int, body: bytes, at: int, faults: DamageReport) -> None:
    """Keep a tempo, a signature of time or key, or the track's name; other metas are dropped."""
    if kind == TRACK_NAME and not track.name:
        track.name = body[:LONGEST_NAME_BYTES]
    elif kind == SET_TEMPO:
        tempo = int.from_bytes(body[:3], "big")
        if len(body) >= 3 and tempo > 0:
            track.tempos.append((tick, tempo))
        else:
            faults.add("a tempo of zero or cut short ignored", at)
    elif kind == TIME_SIGNATURE:
        if len(body) >= 2 and body[0] > 0 and body[1] < 8:
            track.metres.append((tick, 4.0 * body[0] / 2.0 ** body[1]))
        else:
            faults.add("an impossible time signature ignored", at)
    elif kind == KEY_SIGNATURE:
        sharps = int.from_bytes(body[:1], "big", signed=True)
        if body and abs(sharps) <= MAX_SHARPS:
            track.keys.append((tick, sharps))
        else:
            faults.add("an impossible key signature ignored", at)


def named(tracks: Sequence[Track]) -> tuple[list[str], str]:
    """The names of tracks, and the name of their encoding where it is not UTF-8 or Latin-1."""
    encoding = encoding_of(*(track.name for track in tracks))
    names = [decoded(track.name, encoding) for track in tracks]
    plain = ["".join(filter(str.isprintable, name)).strip()[:LONGEST_NAME] for name in names]
    return plain, NAMES.get(encoding, "")
