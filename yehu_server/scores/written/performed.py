"""Perform a written score (docs/scores.md); each part gets a MIDI channel of its own."""

import math
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction

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
    SET_NOTHING,
    Active,
    actives_of,
    harmonic_of,
    slide_of,
    values_of,
)
from yehu_server.scores.written.notated import Note, Part, Written, times
from yehu_server.scores.written.ornaments import curve_of, touches_of
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

Beats = tuple[float, float]  # at which a note begins and ends


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
    left: Counter[str] = Counter()
    parts = []
    end = Fraction(0)
    for channel, number in zip(CHANNELS, numbers, strict=False):
        part = written.parts[number]
        _Performer(part, channel, clock, left, moves, within).play()
        name, count = written.names[number], len(part.notes)
        parts.append(ScorePart(name, channel, channel + 1, count))
        end = max(end, part.notes[-1].end)
    warnings += [times(mark, count) for mark, count in left.items()]
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


def shortest_s(written: Written) -> float:
    """The length (s) of the shortest part, as written: none is played in less."""
    ends = [part.notes[-1].end for part in written.parts if part.notes]
    return WrittenClock(written).seconds(min(ends, default=0))


def leading_notes(part: Part, clock: WrittenClock) -> NoteColumns:
    """A part's notes as written, which all follow, but as long as fermatas have them."""
    begins, ends = np.array(part.begins_at), np.array(part.ends_at)
    keys, none = np.array([_key_of(note.pitch) for note in part.notes]), np.zeros(len(begins))
    times_s = clock.seconds_of(begins), clock.seconds_of(ends)
    return NoteColumns(none - 1, none - 1, none, keys, none, *times_s, begins, none)


class _Moves:
    """What players do, as rows that become events.

    Each is a time (s), its order at that time, a code of `Events`, a track, and the beats at which
    its note begins and ends; the latter is NaN where the first is the row's own beat.
    """

    def __init__(self) -> None:
        self.rows: list[tuple[float, int, int, int, float, float]] = []
        self.settings: list[Setting] = []

    def add(self, *row: *tuple[float, int, int, int, float, float]) -> None:
        """Add a row. Raises ScoreError where there are too many."""
        if len(self.rows) == MAX_EVENTS:
            raise ScoreError(f"asks for more than {MAX_EVENTS} moves of bow and fingers")
        self.rows.append(row)

    def events(self, clock: WrittenClock) -> Events:
        """All as events in order, at the beats of their notes where their times are those."""
        time_s, order, code, track, begin, end = map(np.array, zip(*self.rows, strict=True))
        beat = clock.beats_at(time_s)
        for at in (end, begin):
            beat = np.where(np.abs(time_s - clock.seconds_of(at)) < SAME_S, at, beat)
        beat = np.where(np.isnan(end), begin, beat)
        events = Events(time_s, beat, track, code, tuple(self.settings))
        return events.where(np.lexsort((order, time_s)))


class _Performer:
    def __init__(
        self,
        part: Part,
        channel: int,
        clock: WrittenClock,
        left: Counter[str],
        moves: _Moves,
        within: NoteRange,
    ) -> None:
        self._part = part
        self._within = within
        self._channel = channel
        self._clock = clock
        self._left = left  # marks that are left out, and how often
        self._moves = moves
        self._loudness = Loudness(part, clock)
        self._set: dict[str, float] = {}  # by address, what marks have set
        self._ends: dict[int, int] = {}  # of sounding keys: places among the moves
        self._expression = 127

    def play(self) -> None:
        """Add all its moves; not in order."""
        if self._loudness.is_marked:  # so that phrasing leaves room for it
            self._control(0.0, 0.0, EXPRESSION, 127)
        if has_bowing(self._part):
            self._control(0.0, 0.0, LEGATO_PEDAL, 0)
        actives = actives_of(self._part)
        played = bowed(self._part, actives, self._clock)
        beats = zip(self._part.begins_at, self._part.ends_at, strict=True)
        for each, state, at in zip(played, actives, beats, strict=True):
            self._play(each, state, at)
        last_s = max(each.end_s for each in played) + LAST_S
        self._put_back(last_s, self._part.ends_at[-1], {})

    # -- one note ----------------------------------------------------------------------------

    def _play(self, played: Played, active: Active, beats: Beats) -> None:
        note, begin_s = played.note, played.begin_s
        key = _key_of(note.pitch)
        is_plain = not (note.marks or note.before or note.after or note.contour or any(played[3:]))
        if is_plain and active is PLAIN and key == note.pitch and not self._is_shaped():
            self._touch(begin_s, played.end_s, key, self._loudness.velocity(note), beats)
            return
        if not note.names <= SET_NOTHING:
            self._count_left(note, active)
        values = values_of(note, active, self._clock.quarter_s(beats[0]), self._within)
        if played.direction:
            values[DIRECTION] = played.direction
        if played.slide_s > 0.0:
            values |= {PORTAMENTO: 1.0, PORTAMENTO_TIME: 1e3 * played.slide_s}
        node = harmonic_of(note, self._within)
        pitch = note.pitch if node is None else node.touched
        key = _key_of(pitch)
        curve = curve_of(note, begin_s, played.end_s) if node is None else []
        if abs(pitch - key) > 1e-6 or curve:
            values[BEND] = pitch - key + (curve[0][1] if curve else 0.0)
        if values or self._set:
            self._put_back(begin_s, beats[0], values)
        velocity = self._loudness.velocity(note)
        if self._loudness.is_marked:
            self._swell(played)
        sounding = note if pitch == note.pitch else note._replace(pitch=pitch)
        touches = touches_of(sounding, begin_s, played.end_s)
        if slide_of(note) and node is None and len(touches) > 1:  # the first of them slides
            self._setting(touches[1].begin_s, SET, beats[0], ARTICULATION, None)
            self._set.pop(ARTICULATION, None)
        for touch in touches:
            # Small notes bend with the great one: each is a key, and a share of a semitone.
            own = key if touch.pitch == pitch else _key_of(touch.pitch - (pitch - key))
            if own != key or touch.pitch == pitch:
                self._touch(touch.begin_s, touch.end_s, own, velocity, beats)
        for at_s, semitones in curve[1:]:
            self._setting(at_s, AFTER, beats[0], BEND, pitch - key + semitones)
            self._set[BEND] = math.nan  # whatever it was, it is put back
        if played.slide_s > 0.0:
            for address in (PORTAMENTO, PORTAMENTO_TIME):
                self._setting(begin_s + AFTER_S, AFTER, beats[0], address, None)
                del self._set[address]

    def _is_shaped(self) -> bool:
        """Whether something of the notes before still acts, or is to be put back."""
        return bool(self._set) or self._loudness.is_marked

    def _touch(self, begin_s: float, end_s: float, key: int, velocity: int, beats: Beats) -> None:
        rows = self._moves.rows
        before = self._ends.get(key)
        if before is not None and rows[before][0] > begin_s:  # struck again
            rows[before] = (begin_s, *rows[before][1:])
        source, track = self._channel << 16 | key << 8, self._channel + 1
        self._moves.add(begin_s, ON, NOTE_ON << 20 | source | velocity, track, *beats)
        self._ends[key] = len(rows)
        self._moves.add(end_s, OFF, NOTE_OFF << 20 | source | RELEASE, track, *beats)

    def _swell(self, played: Played) -> None:
        """Controller 11 as a hairpin has it, below the loudest moment of the note."""
        beats, below_db = self._loudness.swell(played.note)
        times_s = self._clock.seconds_of(beats)
        times_s[0] = played.begin_s
        rows = zip(times_s.tolist(), beats.tolist(), below_db.tolist(), strict=True)
        for step, (time_s, beat, below) in enumerate(rows):
            # The amplitude is the square of expression.
            value = round(127.0 * 10.0 ** (-below / 40.0))
            if value != self._expression and (step == 0 or played.begin_s < time_s < played.end_s):
                self._expression = value
                self._control(time_s, beat, EXPRESSION, value)

    # -- settings ----------------------------------------------------------------------------

    def _put_back(self, time_s: float, beat: float, values: dict[str, float]) -> None:
        """Set what the next note wants, and put back what only the last one wanted."""
        for address in [address for address in self._set if address not in values]:
            self._setting(time_s, SET, beat, address, None)
            del self._set[address]
        for address, value in values.items():
            if self._set.get(address) != value:
                self._setting(time_s, SET, beat, address, value)
                self._set[address] = value

    def _setting(
        self, time_s: float, order: int, beat: float, address: str, value: float | None
    ) -> None:
        self._moves.settings.append(Setting(address, value, self._channel))
        self._add(time_s, order, beat, -len(self._moves.settings))

    def _control(self, time_s: float, beat: float, control: int, value: int) -> None:
        code = (CONTROL << 4 | self._channel) << 16 | control << 8 | value
        self._add(time_s, SET, beat, code)

    def _add(self, time_s: float, order: int, beat: float, code: int) -> None:
        self._moves.add(time_s, order, code, self._channel + 1, beat, math.nan)

    def _count_left(self, note: Note, active: Active) -> None:
        """Count marks that cannot be played as written."""
        names = note.names
        if "harmonic" in names and harmonic_of(note, self._within) is None:
            self._left["a harmonic that does not speak is played as a light stopped note"] += 1
        inner, outer = self._within.open_notes
        is_open = note.pitch < inner + 0.5 or abs(note.pitch - outer) <= SAME_PITCH
        if "open-string" in names and not is_open:
            self._left["an open string is marked on a note that no open string has"] += 1
        if slide_of(note) and ("articulation" in names or active.gesture):
            self._left["a note that slides has no other articulation"] += 1
        if "arpeggio" in names:
            self._left["an arpeggio has no meaning for one note at a time"] += 1


def _key_of(pitch: float) -> int:
    return min(max(math.floor(pitch + 0.5), 0), HIGHEST_KEY)
