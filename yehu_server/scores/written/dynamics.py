"""The loudness of a written part: dynamics, hairpins and accents, as MIDI velocities."""

from bisect import bisect_left, bisect_right
from fractions import Fraction
from itertools import repeat
from operator import itemgetter
from typing import Any

import numpy as np

from yehu_server.scores.written.notated import DYNAMICS, FORCED, HAIRPINS, Note, Part, Sign, Span
from yehu_server.scores.written.tempo import WrittenClock

Array = Any

DEFAULT = float(DYNAMICS["mf"])
# In steps of velocity, by ear.
ACCENTS = {"accent": 14.0, "marcato": 20.0, "soft-accent": 8.0, "stress": 8.0, "unstress": -8.0}
HAIRPIN = 20.0  # of one that leads to no dynamic
FORCED_BY = 16.0  # a forced note is at least so much louder
REACH = Fraction(1)  # quarters after a hairpin, in which a dynamic is its aim
SOFTEST, LOUDEST = 1.0, 127.0
DB_PER_STEP = 18.0 / 126.0  # of velocity, over the whole range (core/player/velocity.py)
MIN_SWELL = 1.0
SWELL_S = 0.02  # between steps of a swell
MAX_STEPS = 2000  # of a swell within a note
CHANGE_S = 0.3  # in which a note that is held comes to a dynamic written within it; by ear
LEVELS = {**DYNAMICS, **{name: DYNAMICS[then] for name, (_, then) in FORCED.items() if then}}


class Loudness:
    """The loudness of a part at each beat; `is_marked` where the part says anything of it."""

    def __init__(self, part: Part, clock: WrittenClock) -> None:
        signs = [s for s in part.signs if s.name in LEVELS or s.name == "velocity"]
        hairpins = [s for s in part.spans if s.name in HAIRPINS and s.end > s.begin]
        forced = [sign.beat for sign in part.signs if sign.name in FORCED]
        accents = not all(note.names.isdisjoint(ACCENTS) for note in part.notes)
        self.is_marked = bool(signs or hairpins or forced or accents)
        self._forced = _first_notes(part, [sign for sign in part.signs if sign.name in FORCED])
        # Loudness at breakpoints, joined by straight lines; at a jump the same beat stands twice.
        # Beats are floats here: swells ask for many.
        self._beats: list[float] = []
        self._levels: list[float] = []
        self._part, self._clock = part, clock
        self._build(
            sorted(signs, key=lambda s: float(s.beat)),
            sorted(hairpins, key=lambda s: float(s.begin)),
        )

    def _build(self, signs: list[Sign], hairpins: list[Span]) -> None:
        starts = [float(sign.beat) for sign in signs]
        changes: list[tuple[float, int, Sign | Span]] = [
            *zip(starts, repeat(0), signs, strict=False),
            *((float(span.begin), 1, span) for span in hairpins),
        ]
        there = 0.0  # where the last sign is complete
        for at, _, change in sorted(changes, key=itemgetter(0, 1)):
            beat = at if isinstance(change, Sign) else max(at, there)
            level = self.at(beat)
            while self._beats and self._beats[-1] > beat:  # a hairpin that another sign cuts short
                self._beats.pop()
                self._levels.pop()
            self._add(beat, level)
            if isinstance(change, Sign):
                there = self._reached(change.beat)
                self._add(there, _level_of(change))
                continue
            after = bisect_left(starts, float(change.end))
            aim = level + (HAIRPIN if change.name == "crescendo" else -HAIRPIN)
            if after < len(signs) and signs[after].beat <= change.end + REACH:
                # To the dynamic after it, unless that lies the other way.
                written = _level_of(signs[after])
                aim = written if (written > level) == (aim > level) and written != level else aim
            self._add(max(float(change.end), beat), min(max(aim, SOFTEST), LOUDEST))

        self._columns = np.array(self._beats), np.array(self._levels)

    def _reached(self, beat: Fraction) -> float:
        """The beat at which a sign is complete: at once, or soon where a note is held over it."""
        note = self._part.notes[max(bisect_right(self._part.begins_at, float(beat)) - 1, 0)]
        if not note.beat < beat < note.end:
            return float(beat)
        soon = self._clock.beat_at(self._clock.seconds(beat) + CHANGE_S)
        return min(soon, float(note.end))

    def _add(self, beat: float, level: float) -> None:
        self._beats.append(beat)
        self._levels.append(level)

    def at(self, beat: float) -> float:
        """Loudness (velocity) at a beat, after what is written there."""
        return self._between(bisect_right(self._beats, beat), beat)

    def _before(self, beat: float) -> float:
        """Loudness just before what is written at a beat."""
        return self._between(bisect_left(self._beats, beat), beat)

    def _between(self, after: int, beat: float) -> float:
        """Loudness at a beat that lies before the breakpoint of a number."""
        if after == 0:
            return DEFAULT
        begin, level = self._beats[after - 1], self._levels[after - 1]
        if after == len(self._beats):
            return level
        end, aim = self._beats[after], self._levels[after]
        return level + (aim - level) * (beat - begin) / (end - begin)

    def _levels_at(self, beats: Array) -> Array:
        """Loudness at beats [shape=(beats,)], after what is written there."""
        known, levels = self._columns
        after = np.searchsorted(known, beats, side="right")
        at, to = np.maximum(after - 1, 0), np.minimum(after, len(known) - 1)
        length = np.where(at == to, 1.0, known[to] - known[at])
        between = levels[at] + (levels[to] - levels[at]) * (beats - known[at]) / length
        return np.where(after == 0, DEFAULT, between)

    def _range(self, note: Note) -> tuple[float, float]:
        """The least and the largest loudness while a note sounds."""
        if not self._beats:
            return DEFAULT, DEFAULT
        begin, end = note.begins_at, note.ends_at
        first, last = bisect_right(self._beats, begin), bisect_left(self._beats, end)
        levels = [self.at(begin), *self._levels[first:last], self._before(end)]
        return min(levels), max(levels)

    def velocity(self, note: Note) -> int:
        """The velocity of a note: its loudest moment."""
        loudest = self._range(note)[1]
        name = self._forced.get(note.begins_at) if self._forced else None
        if name is not None:
            loudest = max(float(DYNAMICS[FORCED[name][0]]), loudest + FORCED_BY)
        if note.marks:
            loudest += sum(ACCENTS.get(name, 0.0) for name in note.names)
        return round(min(max(loudest, SOFTEST), LOUDEST))

    def swell(self, note: Note) -> tuple[Array, Array]:
        """Beats of a note, and the dB that it is below its loudest there; one where it stays."""
        begin, length = note.begins_at, float(note.length)
        least, largest = self._range(note)
        if largest - least < MIN_SWELL:
            return np.array([begin]), np.zeros(1)
        length_s = self._clock.seconds(note.ends_at) - self._clock.seconds(begin)
        count = min(max(int(length_s / SWELL_S), 2), MAX_STEPS)
        beats = begin + length * np.arange(count) / count
        return beats, np.maximum(largest - self._levels_at(beats), 0.0) * DB_PER_STEP


def _level_of(sign: Sign) -> float:
    if sign.name == "velocity":
        return min(max(sign.value or DEFAULT, SOFTEST), LOUDEST)
    return float(LEVELS[sign.name])


def _first_notes(part: Part, forced: list[Sign]) -> dict[float, str]:
    """The forced signs, by the beats of the notes that they are for."""
    beats = part.begins_at
    found = {}
    for sign in forced:
        at = bisect_left(beats, float(sign.beat))
        if at < len(beats):
            found[beats[at]] = sign.name
    return found
