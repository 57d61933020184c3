"""Decode one track of a MIDI file to messages at ticks, convert these to seconds, note damage."""

import math
import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import mido

from yehu_server.errors import ScoreError
from yehu_server.scores.encodings import NAMES, decoded, encoding_of
from yehu_server.scores.smf.tunings import MAX_MESSAGES, is_tuning

MAX_KINDS = 30  # listed separately; a hostile file could have one for each of its bytes
OTHERS = "further faults of other kinds"


class DamagedError(ScoreError):
    """A file that could be played, with damage, where none is accepted."""


class DamageReport:
    """The damage found in one file, by kind; each entry says how the reader went on."""

    def __init__(self) -> None:
        self._found: dict[str, tuple[int, int]] = {}  # how often, and the first byte

    def add(self, what: str, at: int) -> None:
        """Note a fault at a byte of the file, counted from 0."""
        if what not in self._found and len(self._found) >= MAX_KINDS:
            what = OTHERS
        times, first = self._found.get(what, (0, at))
        self._found[what] = (times + 1, min(first, at))

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
META, SYSEX, ESCAPE = 0xFF, 0xF0, 0xF7
TRACK_NAME, END_OF_TRACK, SET_TEMPO, TIME_SIGNATURE, KEY_SIGNATURE = 0x03, 0x2F, 0x51, 0x58, 0x59
MAX_SHARPS = 7  # or flats, of a key signature
LONGEST_NAME, LONGEST_NAME_BYTES = 40, 160  # characters of 1 to 4 bytes
STATUS = re.compile(rb"[\x80-\xff]")
SYSTEM_DATA_BYTES = {0xF1: 1, 0xF2: 2, 0xF3: 1}
NUMBER_BYTES = 4  # of a variable-length number, as the format has it
LONGEST_NUMBER_BYTES = 8  # as some writers have it, padded
LARGEST_NUMBER = 0x0FFF_FFFF
Placed = tuple[int, mido.Message, int]  # tick, message, byte in the file


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
        self._per_beat = math.nan if division >= SMPTE else division
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
        return tick / self._per_beat

    def times(self, ticks: Iterable[int]) -> Iterator[tuple[float, float]]:
        """The same of ticks in order: seconds and beat of each."""
        spans = zip(self._ticks, self._spans, strict=True)
        (begin, (so_far, rate)), following = next(spans), next(spans, None)
        per_second, per_beat = self._units_per_second, self._per_beat
        for tick in ticks:
            while following is not None and tick >= following[0]:
                (begin, (so_far, rate)), following = following, next(spans, None)
            yield (so_far + (tick - begin) * rate) / per_second, tick / per_beat


@dataclass
class Track:
    """The messages of a track and its other events, at ticks."""

    messages: list[Placed] = field(default_factory=list)
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


@dataclass
class _Cursor:
    """A position in a track; a step past the end raises EOFError."""

    data: bytes
    pos: int
    end: int

    def take(self, length: int) -> bytes:
        if self.pos + length > self.end:
            raise EOFError
        self.pos += length
        return self.data[self.pos - length : self.pos]

    def byte(self) -> int:
        if self.pos >= self.end:
            raise EOFError
        self.pos += 1
        return self.data[self.pos - 1]

    def at_status(self) -> bool:
        if self.pos >= self.end:
            raise EOFError
        return self.data[self.pos] >= 0x80

    def skip_to_status(self) -> None:
        found = STATUS.search(self.data, self.pos, self.end)
        if found is None:
            raise EOFError
        self.pos = found.start()

    def number(self, faults: DamageReport) -> int:
        """A variable-length number; one that is padded is read to its end."""
        value = 0
        for place in range(LONGEST_NUMBER_BYTES):
            byte = self.byte()
            if place == NUMBER_BYTES:
                faults.add(f"a number of more than {NUMBER_BYTES} bytes", self.pos - place - 1)
            value = value << 7 | byte & 0x7F
            if byte < 0x80:
                break
        return min(value, LARGEST_NUMBER)


OF_ALL = ("type", "time", "channel")  # what all messages have


class MessagesOfStatus(dict[bytes, "mido.Message | None"]):
    """The messages of a status by data bytes, None if damaged; each made once, as it takes long."""

    def __init__(self, status: int) -> None:
        super().__init__()
        self.length = 1 if status & 0xE0 == 0xC0 else 2
        self._plain = mido.Message.from_bytes([status, *[0] * self.length])
        self._names = [name for name in vars(self._plain) if name not in OF_ALL]

    def __missing__(self, body: bytes) -> mido.Message | None:
        message = None
        if body.isascii():  # no byte above 127
            message = self._plain.copy()  # without checks, which take three times as long
            if len(self._names) == len(body):
                vars(message).update(zip(self._names, body, strict=True))
            else:
                vars(message)["pitch"] = body[0] + (body[1] << 7) - 8192
        self[body] = message
        return message


class KnownMessages(dict[int, MessagesOfStatus]):
    """The messages of a file, by status."""

    def __missing__(self, status: int) -> MessagesOfStatus:
        return self.setdefault(status, MessagesOfStatus(status))


def decode(
    data: bytes, start: int, stop: int, room: int, faults: DamageReport, known: KnownMessages
) -> Track:
    """Read the events from one byte to another, as far as possible.

    Reading ends with the first event beyond `room`, so that `events` is larger then. `known`: the
    messages of the same file so far.
    """
    track = Track(start_at=start)
    cursor = _Cursor(data, start, stop)
    keep = track.messages.append
    tick = longest = events = 0
    at = pos = start
    running, messages = 0, known[0x80]  # kept across metas and sysex, as some writers rely on it
    try:
        while pos < stop and events <= room:
            at = pos
            delta = data[at]
            pos = at + 1
            if delta >= 0x80:  # few are
                cursor.pos = at
                delta = cursor.number(faults)
                pos = cursor.pos
            tick += delta
            if pos < stop and data[pos] < 0x80 and running:
                status = running
            else:
                cursor.pos = pos
                if not running and not cursor.at_status():
                    faults.add("data without a status byte skipped", pos)
                    cursor.skip_to_status()
                status = cursor.byte()
                pos = cursor.pos
            if status < SYSEX:
                if status != running:
                    running, messages = status, known[status]
                after = pos + messages.length
                message = messages[data[pos:after] if after <= stop else cursor.take(stop)]
                pos = after
                if message is not None:
                    keep((tick, message, at))
                else:
                    # Dropped at its full length: mostly this is a velocity above 127, and the
                    # next message is intact.
                    faults.add("a damaged message dropped", at)
            else:
                _take_other(track, cursor, status, tick, at, faults)
                pos = cursor.pos
            track.end, track.end_at = tick, at
            if track.after_end is not None:
                break
            if delta > longest:
                longest = delta
                track.longest = delta, tick, at
            events += 1
    except EOFError:
        track.is_whole = False
        faults.add("a track ends in the middle of an event", at)
    track.events = events
    return track


def _take_other(
    track: Track, cursor: _Cursor, status: int, tick: int, at: int, faults: DamageReport
) -> None:
    """Read an event that is no channel message, after its status."""
    if status == META:
        kind = cursor.byte()
        body = cursor.take(cursor.number(faults))
        if kind == END_OF_TRACK:
            track.after_end = cursor.pos
        else:
            _keep(track, tick, kind, body, at, faults)
    elif status in (SYSEX, ESCAPE):
        body = cursor.take(cursor.number(faults))
        if status == SYSEX and is_tuning(body) and len(track.tunings) < MAX_MESSAGES:
            track.tunings.append((tick, body))
    else:
        faults.add("a system message, which no file should hold, skipped", at)
        cursor.take(SYSTEM_DATA_BYTES.get(status, 0))


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
