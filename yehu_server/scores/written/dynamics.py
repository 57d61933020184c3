"""The loudness of a written part: dynamics, hairpins and accents, as MIDI velocities."""

from bisect import bisect_left, bisect_right
from fractions import Fraction
from itertools import repeat
from operator import itemgetter
from typing import Any, Literal

import numpy as np

from yehu_server.scores.written.notated import DYNAMICS, FORCED, HAIRPINS, Part, Sign, Span
from yehu_server.scores.written.tempo import WrittenClock

Array = Any
Side = Literal["left", "right"]

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
        accents = not all(names.isdisjoint(ACCENTS) for names in {*part.names})
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
        self._range = self._ranges()

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

    def _between(self, after: int, beat: float) -> float:
        """Loudness at a beat that lies before the breakpoint of a number."""
        if after == 0:
            return DEFAULT
        begin, level = self._beats[after - 1], self._levels[after - 1]
        if after == len(self._beats):
            return level
        end, aim = self._beats[after], self._levels[after]
        return level + (aim - level) * (beat - begin) / (end - begin)

    def _levels_at(self, beats: Array, side: Side = "right") -> Array:
        """Loudness at beats [shape=(beats,)], after what is written there; or before it (left)."""
        known, levels = self._columns
        if not len(known):
            return np.full(len(beats), DEFAULT)
        after = np.searchsorted(known, beats, side=side)
        at, to = np.maximum(after - 1, 0), np.minimum(after, len(known) - 1)
        length = np.where(at == to, 1.0, known[to] - known[at])
        between = levels[at] + (levels[to] - levels[at]) * (beats - known[at]) / length
        return np.where(after == 0, DEFAULT, between)

    def _ranges(self) -> tuple[Array, Array]:
        """The least and the largest loudness while each note sounds."""
        begins, ends = np.array(self._part.begins_at), np.array(self._part.ends_at)
        known, levels = self._columns
        first, last = np.searchsorted(known, begins, "right"), np.searchsorted(known, ends, "left")
        sides = self._levels_at(begins), self._levels_at(ends, "left")
        least, largest = np.minimum(*sides), np.maximum(*sides)
        inner = np.flatnonzero(first < last)  # notes within which something is written
        slices = np.column_stack((first[inner], last[inner])).ravel()
        padded = np.append(levels, DEFAULT)
        for found, each in ((least, np.minimum), (largest, np.maximum)):
            if len(inner):
                found[inner] = each(found[inner], each.reduceat(padded, slices)[::2])
        return least, largest

    def velocities(self) -> Array:
        """The velocity of each note: its loudest moment."""
        loudest = self._range[1].copy()
        for at, begins_at in enumerate(self._part.begins_at if self._forced else ()):
            if (name := self._forced.get(begins_at)) is not None:
                loudest[at] = max(float(DYNAMICS[FORCED[name][0]]), loudest[at] + FORCED_BY)
        accents = {names: sum(ACCENTS.get(n, 0.0) for n in names) for names in {*self._part.names}}
        loudest += np.array([accents[names] for names in self._part.names])
        return np.rint(np.clip(loudest, SOFTEST, LOUDEST)).astype(np.int64)

    def swells(self, first: int, last: int) -> tuple[Array, Array, Array, Array]:
        """Steps of some notes: the note's number, the step's, the beat, and how far below (dB).

        That is below the loudest moment of the note; a note that stays has one step.
        """
        notes = slice(first, last)
        least, largest = (each[notes] for each in self._range)
        part = self._part
        begins, ends = np.array(part.begins_at[notes]), np.array(part.ends_at[notes])
        stays = largest - least < MIN_SWELL
        lengths_s = self._clock.seconds_of(ends) - self._clock.seconds_of(begins)
        counts = np.where(stays, 1, np.clip((lengths_s / SWELL_S).astype(np.int64), 2, MAX_STEPS))
        number = np.repeat(np.arange(len(counts)), counts)
        step = np.arange(len(number)) - np.repeat(np.cumsum(counts) - counts, counts)
        lengths = np.array([float(note.length) for note in part.notes[notes]])
        beats = begins[number] + lengths[number] * step / counts[number]
        below = np.maximum(largest[number] - self._levels_at(beats), 0.0) * DB_PER_STEP
        return number, step, beats, np.where(stays[number], 0.0, below)


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
