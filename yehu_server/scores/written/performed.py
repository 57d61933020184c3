"""Perform a written score (docs/scores.md); each part gets a MIDI channel of its own."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from yehu_server.core.player.harmonics import SAME_PITCH
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ScoreError
from yehu_server.scores.events import BEND, CONTROL, NOTE_OFF, NOTE_ON, Events, NoteColumns, Setting
from yehu_server.scores.score import Score, ScorePart
from yehu_server.scores.written.dynamics import Loudness
from yehu_server.scores.written.mark_settings import (
    ARTICULATION,
    DIRECTION,
    PLAIN,
    Active,
    actives_of,
    harmonic_of,
    slide_of,
    values_of,
)
from yehu_server.scores.written.notated import Note, Part, Written, times
from yehu_server.scores.written.ornaments import WAYS, Curve, curves_of, touches_of
from yehu_server.scores.written.part_bowing import Played, bowed, has_bowing
from yehu_server.scores.written.tempo import WrittenClock

CHANNELS = tuple(channel for channel in range(16) if channel != 9)
EXPRESSION, LEGATO_PEDAL = 11, 68
PORTAMENTO, PORTAMENTO_TIME = "/playing/portamento", "/playing/portamento_time"
AFTER_S = 0.005  # after a note's beginning, when its finger is on the way
LAST_S = 0.3  # after the last note, when all is put back
HIGHEST_KEY = 127
RELEASE = 64  # velocity of a note-off
MAX_EVENTS = 300_000
SAME_S = 1e-9
# Order at one time.
OFF, SET, ON, AFTER = range(4)
FIRST, SWELL, THEN = range(PHASES := 3)  # of what is set for one note
BLOCK = 500  # notes that are worked out at once
Array = Any

Touched = tuple[float, float, int, int, int]
Row = tuple[float, int, int, int, float]


def performed(
    written: Written,
    plays: Sequence[int] | None = None,
    within: NoteRange = YEHU,
    clock: WrittenClock | None = None,
) -> Score:
    """Return a written score as it is played.

    `plays` are the numbers of the parts to play, from 0; by default all. Tempo and waits are of
    all, as the `clock` of the score has them. Open strings and harmonics are those of `within`.
    Raises ScoreError where there is no note, or it lasts longer than a day.
    """
    clock = clock or WrittenClock(written)
    warnings = [*written.warnings, *written.not_understood]
    chosen = range(len(written.parts)) if plays is None else plays
    numbers = [number for number in chosen if written.parts[number].notes]
    if not numbers:
        raise ScoreError("has no note to play")
    if len(numbers) > len(CHANNELS):
        warnings.insert(0, f"{len(numbers)} parts; the first {len(CHANNELS)} are played")
    moves = _Moves()
    parts = []
    end = Fraction(0)
    for channel, number in zip(CHANNELS, numbers, strict=False):
        part = written.parts[number]
        _Performer(part, channel, clock, moves, within).play()
        name, count = written.names[number], len(part.notes)
        parts.append(ScorePart(name, channel, channel + 1, count))
        end = max(end, part.notes[-1].end)
    warnings += [times(mark, count) for mark, count in moves.left.items()]
    events = moves.events(clock)
    return Score(
        events,
        max(clock.seconds(end), float(events.time_s[-1])),
        written.title,
        tuple(warnings),
        written.metres,
        tuple(parts),
        written.remarks,
        is_written=True,
    )


def shortest_s(written: Written, clock: WrittenClock) -> float:
    """The length (s) of the shortest part, as written: none is played in less."""
    ends = [part.notes[-1].end for part in written.parts if part.notes]
    return clock.seconds(min(ends, default=0))


def leading_notes(part: Part, clock: WrittenClock) -> NoteColumns:
    """A part's notes as written, which all follow, but as long as fermatas have them."""
    begins, ends = np.array(part.begins_at), np.array(part.ends_at)
    pitches, none = np.array([note.pitch for note in part.notes], float), np.zeros(len(begins))
    keys = np.clip(np.floor(pitches + 0.5), 0, HIGHEST_KEY).astype(np.int64)
    times_s = clock.seconds_of(begins), clock.seconds_of(ends)
    return NoteColumns(none - 1, none - 1, none, keys, none, *times_s, begins, none)


class _Manner(NamedTuple):
    """How a note is played, by its marks and the signs that hold."""

    values: Mapping[str, float]  # of parameters, by address
    pitch: float  # that the finger has: of a harmonic where it touches
    is_node: bool
    is_ornamented: bool
    slides_in: bool
    left: Sequence[str]  # what is left out


class _Moves:
    """What players do, in columns that become events.

    A touch is a time (s) and that of its end, a key, and the number of its note in its part. A row
    is a time, its order at that time, its place among those, a code of `Events`, and a beat.
    """

    def __init__(self) -> None:
        self.settings: list[Setting] = []
        self.left: Counter[str] = Counter()  # marks that are left out, and how often
        self._columns: list[tuple[Array, ...]] = []
        self._count = 0

    def check(self, more: int) -> None:
        """Raise ScoreError where so many more moves are too many."""
        if self._count + more > MAX_EVENTS:
            raise ScoreError(f"asks for more than {MAX_EVENTS} moves of bow and fingers")

    def add(self, part: Part, channel: int, touches: list[Touched], rows: list[Row]) -> None:
        """Add the moves of a part; rows may be in any order of their places."""
        self.check(2 * len(touches) + len(rows))
        self._count += 2 * len(touches) + len(rows)
        begin_s, end_s, key, velocity, note = map(np.array, zip(*touches, strict=True))
        by_key = np.argsort(key, kind="stable")
        again = by_key[1:][key[by_key][1:] == key[by_key][:-1]]  # struck while it sounds
        before = by_key[:-1][key[by_key][1:] == key[by_key][:-1]]
        end_s[before] = np.minimum(end_s[before], begin_s[again])
        source = channel << 16 | key << 8
        beats = np.array(part.begins_at)[note], np.array(part.ends_at)[note]
        on, off = NOTE_ON << 20 | source | velocity, NOTE_OFF << 20 | source | RELEASE
        track = np.full_like(key, channel + 1)
        self._columns += [
            (begin_s, np.full_like(key, ON), note, on, track, *beats),
            (end_s, np.full_like(key, OFF), note, off, track, *beats),
        ]
        if rows:
            time_s, order, place, code, beat = map(np.array, zip(*rows, strict=True))
            track, none = np.full_like(code, channel + 1), np.full(len(rows), np.nan)
            self._columns.append((time_s, order, place, code, track, beat, none))

    def events(self, clock: WrittenClock) -> Events:
        """All as events in order, at the beats of their notes where their times are those."""
        columns = map(np.concatenate, zip(*self._columns, strict=True))
        time_s, order, place, code, track, begin, end = columns
        beat = clock.beats_at(time_s)
        for at in (end, begin):
            beat = np.where(np.abs(time_s - clock.seconds_of(at)) < SAME_S, at, beat)
        beat = np.where(np.isnan(end), begin, beat)
        events = Events(time_s, beat, track, code, tuple(self.settings))
        return events.where(np.lexsort((place, track, order, time_s)))


class _Performer:
    def __init__(
        self,
        part: Part,
        channel: int,
        clock: WrittenClock,
        moves: _Moves,
        within: NoteRange,
    ) -> None:
        self._part = part
        self._within = within
        self._channel = channel
        self._clock = clock
        self._moves = moves
        self._expression = 127
        self._set: dict[str, float] = {}  # by address, what marks have set
        self._manners: dict[Any, _Manner] = {}
        self._touches: list[Touched] = []
        self._rows: list[Row] = []

    def play(self) -> None:
        """Add all its moves."""
        part, rows = self._part, self._rows
        loudness = Loudness(part, self._clock)
        if loudness.is_marked:  # so that phrasing leaves room for it
            rows.append((0.0, SET, -1, self._code(EXPRESSION, 127), 0.0))
        if has_bowing(part):
            rows.append((0.0, SET, -1, self._code(LEGATO_PEDAL, 0), 0.0))
        actives = actives_of(part)
        played = bowed(part, actives, self._clock)
        velocities = loudness.velocities().tolist()
        quarters_s = self._clock.quarters_of(np.array(part.begins_at)).tolist()
        columns = [*zip(played, actives, velocities, quarters_s, strict=True)]
        for first in range(0, len(played), BLOCK):
            block = columns[first : first + BLOCK]
            if loudness.is_marked:
                self._swell(loudness, first, played[first : first + BLOCK])
            curves = curves_of(each[:3] for each, *_ in block)
            for place, row in enumerate(block, first):
                (note, begin_s, end_s, direction, slide_s), active, velocity, _ = row
                _, _, pitch, marks, before, after, contour = note
                is_plain = not (marks or before or after or contour or direction or slide_s)
                key = _key_of(pitch)
                if is_plain and key == pitch and not self._set and active == PLAIN:
                    self._touches.append((begin_s, end_s, key, velocity, place))
                else:
                    self._play(*row, place, curves.get(place - first, []))
            self._moves.check(2 * len(self._touches) + len(rows))
        last_s = max(each.end_s for each in played) + LAST_S
        self._put_back(last_s, len(played), part.ends_at[-1], {})
        self._moves.add(part, self._channel, self._touches, rows)

    # -- one note ----------------------------------------------------------------------------

    def _play(
        self,
        played: Played,
        active: Active,
        velocity: int,
        quarter_s: float,
        place: int,
        curve: Curve,
    ) -> None:
        note, begin_s, end_s, direction, slide_s = played
        manner = self._manner(note, active, quarter_s)
        beat = self._part.begins_at[place]
        values, pitch = manner.values, manner.pitch
        key = _key_of(pitch)
        if manner.is_node:
            curve = []
        if direction or slide_s > 0.0 or curve or abs(pitch - key) > 1e-6:
            values = {**values}
            if direction:
                values[DIRECTION] = direction
            if slide_s > 0.0:
                values |= {PORTAMENTO: 1.0, PORTAMENTO_TIME: 1e3 * slide_s}
            if abs(pitch - key) > 1e-6 or curve:
                values[BEND] = pitch - key + (curve[0][1] if curve else 0.0)
        if values or self._set:
            self._put_back(begin_s, place, beat, values)
        if manner.left:
            self._moves.left.update(manner.left)
        touches = [(begin_s, end_s, pitch)]
        if manner.is_ornamented or note.before or note.after:
            sounding = note if pitch == note.pitch else note._replace(pitch=pitch)
            touches = touches_of(sounding, begin_s, end_s)
        if manner.slides_in and len(touches) > 1:  # the first of them slides
            self._setting(touches[1][0], SET, place, THEN, beat, ARTICULATION, None)
            self._set.pop(ARTICULATION, None)
        for touch_s, until_s, its in touches:
            # Small notes bend with the great one: each is a key, and a share of a semitone.
            own = key if its == pitch else _key_of(its - (pitch - key))
            if own != key or its == pitch:
                self._touches.append((touch_s, until_s, own, velocity, place))
        if curve:
            self._bend(curve, pitch - key, place, beat)
        if slide_s > 0.0:
            for address in (PORTAMENTO, PORTAMENTO_TIME):
                self._setting(begin_s + AFTER_S, AFTER, place, THEN, beat, address, None)
                del self._set[address]

    def _bend(self, curve: Curve, sharper: float, place: int, beat: float) -> None:
        """Follow a curve, whose first point is set where the note begins."""
        for at_s, semitones in curve[1:]:
            self._setting(at_s, AFTER, place, THEN, beat, BEND, sharper + semitones)
            self._set[BEND] = math.nan  # whatever it was, it is put back
        self._moves.check(2 * len(self._touches) + len(self._rows))  # many are long

    def _manner(self, note: Note, active: Active, quarter_s: float) -> _Manner:
        """How a note is played; notes that are written alike are played alike."""
        # Lengths that are alike are mostly one object, which is found sooner than a fraction.
        key = note.pitch, note.marks, id(note.length), active, quarter_s
        found = self._manners.get(key)
        if found is None:
            node = harmonic_of(note, self._within)
            found = self._manners[key] = _Manner(
                values_of(note, active, quarter_s, self._within),
                note.pitch if node is None else node.touched,
                node is not None,
                not note.names.isdisjoint(WAYS),
                bool(slide_of(note)) and node is None,
                [*self._left_out(note, active)],
            )
        return found

    def _swell(self, loudness: Loudness, first: int, played: Sequence[Played]) -> None:
        """Controller 11 as hairpins have it, below the loudest moment of each note."""
        _, begin_s, end_s, *_ = zip(*played, strict=True)
        number, step, beat, below_db = loudness.swells(first, first + len(played))
        begins_s, ends_s = np.array(begin_s)[number], np.array(end_s)[number]
        time_s = np.where(step == 0, begins_s, self._clock.seconds_of(beat))
        # The amplitude is the square of expression.
        value = np.rint(127.0 * 10.0 ** (-below_db / 40.0)).astype(np.int64)
        is_within = np.flatnonzero((step == 0) | (begins_s < time_s) & (time_s < ends_s))
        moves = is_within[np.diff(value[is_within], prepend=self._expression) != 0]
        self._expression = value[is_within[-1]]
        columns = (each[moves].tolist() for each in (time_s, number, value, beat))
        self._rows += (
            (at_s, SET, PHASES * (first + its) + SWELL, self._code(EXPRESSION, level), at)
            for at_s, its, level, at in zip(*columns, strict=True)
        )

    # -- settings ----------------------------------------------------------------------------

    def _put_back(
        self, time_s: float, place: int, beat: float, values: Mapping[str, float]
    ) -> None:
        """Set what the next note wants, and put back what only the last one wanted."""
        for address in [address for address in self._set if address not in values]:
            self._setting(time_s, SET, place, FIRST, beat, address, None)
            del self._set[address]
        for address, value in values.items():
            if self._set.get(address) != value:
                self._setting(time_s, SET, place, FIRST, beat, address, value)
                self._set[address] = value

    def _setting(
        self,
        time_s: float,
        order: int,
        place: int,
        phase: int,
        beat: float,
        address: str,
        value: float | None,
    ) -> None:
        settings = self._moves.settings
        settings.append(Setting(address, value, self._channel))
        self._rows.append((time_s, order, PHASES * place + phase, -len(settings), beat))

    def _code(self, control: int, value: int) -> int:
        return (CONTROL << 4 | self._channel) << 16 | control << 8 | value

    def _left_out(self, note: Note, active: Active) -> Iterator[str]:
        """Marks that cannot be played as written."""
        names = note.names
        if "harmonic" in names and harmonic_of(note, self._within) is None:
            yield "a harmonic that does not speak is played as a light stopped note"
        inner, outer = self._within.open_notes
        is_open = note.pitch < inner + 0.5 or abs(note.pitch - outer) <= SAME_PITCH
        if "open-string" in names and not is_open:
            yield "an open string is marked on a note that no open string has"
        if slide_of(note) and ("articulation" in names or active.gesture):
            yield "a note that slides has no other articulation"
        if "arpeggio" in names:
            yield "an arpeggio has no meaning for one note at a time"


def _key_of(pitch: float) -> int:
    key = math.floor(pitch + 0.5)
    return key if 0 <= key <= HIGHEST_KEY else min(max(key, 0), HIGHEST_KEY)
