"""Convert beats to seconds: tempi, their changes, and fermatas, which hold all parts."""

from bisect import bisect_right
from collections.abc import Iterator
from fractions import Fraction
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np

from yehu_server.scores.written import notated
from yehu_server.scores.written.notated import Span, Written
from yehu_server.scores.written.ticks import TICKS, Ticks, scaled, ticks_of

Array = Any

# By ear.
HELD, LONGEST_HELD = 1.8, 10.0  # times as long under a fermata, and at most
WAIT = Fraction(1)  # quarters of a rest that its fermata stretches
CAESURA_S = 0.4
BRIEF = Fraction(1, 4)  # quarters before a caesura, which take so much longer
SLOWER, FASTER = 0.7, 1.25  # at the end of ritardando and accelerando
HOLDING = {"fermata", "caesura"}  # marks
STEPS = 64  # at most, in a change of tempo
SHORTEST_STEP = TICKS // 4


class Stretch(NamedTuple):
    """Beats that take `factor` times as long, and `more_s` a quarter on top."""

    begin: float
    end: float
    factor: float = 1.0
    more_s: float = 0.0


class WrittenClock:
    """Converts beats to seconds from the start of the score, and back."""

    def __init__(self, written: Written) -> None:
        stretches = list(_stretches(written))
        tempi = _with_changes(written)
        starts = [beat for beat, _ in tempi]
        ends = [beat for begin, end, *_ in stretches for beat in (begin, end)]
        beats = np.unique([0.0, *starts, *ends])
        beats = beats[beats >= 0.0]
        quarters = np.array([notated.DEFAULT_TEMPO, *(each for _, each in tempi)])
        held = np.clip(quarters, notated.LOWEST_TEMPO, notated.HIGHEST_TEMPO)
        rates = 60.0 / held[np.searchsorted(starts, beats, side="right")]  # seconds a quarter
        self._beats: list[float] = beats.tolist()
        self._rates = self._stretched(rates.tolist(), stretches)
        lengths_s = np.diff(beats) * self._rates[:-1]
        self._seconds: list[float] = [0.0, *np.cumsum(lengths_s).tolist()]
        self._columns = tuple(map(np.array, (self._beats, self._seconds, self._rates)))

    def _stretched(self, rates: list[float], stretches: list[Stretch]) -> list[float]:
        changed = list(rates)
        for each in stretches:
            first = bisect_right(self._beats, each.begin) - 1
            last = bisect_right(self._beats, each.end) - 1
            for at in range(first, last):
                # Where several parts have the same fermata, it counts once.
                changed[at] = max(changed[at], rates[at] * each.factor + each.more_s)
        return changed

    def seconds(self, beat: Fraction | float) -> float:
        """Seconds at a beat."""
        exact = float(beat)
        at = self._at(exact)
        return self._seconds[at] + (exact - self._beats[at]) * self._rates[at]

    def seconds_of(self, beats: Array) -> Array:
        """Seconds at beats [shape=(beats,)]."""
        since, seconds, rates = self._columns
        at = np.maximum(np.searchsorted(since, beats, side="right") - 1, 0)
        return seconds[at] + (beats - since[at]) * rates[at]

    def beats_at(self, seconds: Array) -> Array:
        """The beats at seconds [shape=(seconds,)]."""
        beats, since, rates = self._columns
        at = np.maximum(np.searchsorted(since, seconds, side="right") - 1, 0)
        return beats[at] + (seconds - since[at]) / rates[at]

    def beat_at(self, seconds: float) -> float:
        """The beat at so many seconds."""
        at = max(bisect_right(self._seconds, seconds) - 1, 0)
        return self._beats[at] + (seconds - self._seconds[at]) / self._rates[at]

    def quarters_of(self, beats: Array) -> Array:
        """The lengths of quarter notes (s) at beats [shape=(beats,)]."""
        since, _, rates = self._columns
        return rates[np.maximum(np.searchsorted(since, beats, side="right") - 1, 0)]

    def _at(self, beat: float) -> int:
        return max(bisect_right(self._beats, beat) - 1, 0)

    @property
    def tempi(self) -> list[tuple[float, float]]:
        """Each change of tempo as played: its beat, and the seconds that a quarter lasts."""
        return list(zip(self._beats, self._rates, strict=True))


def _stretches(written: Written) -> Iterator[Stretch]:
    for part in written.parts:
        columns = part.notes, part.names, part.begins_at, part.ends_at
        for note, names, begin, end in zip(*columns, strict=True):
            if HOLDING.isdisjoint(names):
                continue
            fermata, caesura = note.marked("fermata"), note.marked("caesura")
            factor = 1.0 if fermata is None else _held(fermata.value)
            held = float(note.held_from) if fermata and fermata.second else begin
            more_s = 0.0 if caesura is None else CAESURA_S / float(note.end - note.held_from)
            yield Stretch(held, end, factor, more_s)
        for sign in part.signs:
            if sign.name == "fermata":
                yield Stretch(float(sign.beat), float(sign.beat + WAIT), _held(sign.value))
            elif sign.name == "caesura" and sign.beat > 0:
                since = max(sign.beat - BRIEF, Fraction(0))
                more_s = CAESURA_S / float(sign.beat - since)
                yield Stretch(float(since), float(sign.beat), 1.0, more_s)


def _held(factor: float | None) -> float:
    return min(max(factor or HELD, 1.0), LONGEST_HELD)


def _with_changes(written: Written) -> list[tuple[float, float]]:
    """The tempi and their beats in order, with ritardandos and accelerandos as steps."""
    tempi = sorted((ticks_of(beat), quarters) for beat, quarters in written.tempi)
    starts = [beat for beat, _ in tempi]
    spans = {
        (span.name, ticks_of(span.begin), ticks_of(span.end)): span
        for part in written.parts
        for span in part.spans
        if span.name in ("ritardando", "accelerando") and span.end > span.begin
    }
    steps: dict[Ticks, float] = {}
    for (_, begin, end), span in sorted(spans.items(), key=lambda each: each[0][1]):
        at = bisect_right(starts, begin) - 1
        before = tempi[at][1] if at >= 0 else notated.DEFAULT_TEMPO
        steps |= _steps(span, begin, end - begin, before)
    # At the end of the change the next tempo holds, where one is written there.
    steps |= tempi
    return [(float(beat / TICKS), quarters) for beat, quarters in sorted(steps.items())]


def _steps(span: Span, begin: Ticks, length: Ticks, before: float) -> dict[Ticks, float]:
    count = min(max(int(length // SHORTEST_STEP), 1), STEPS)
    last = span.value or (SLOWER if span.name == "ritardando" else FASTER)
    last = min(max(last, 1.0 / LONGEST_HELD), LONGEST_HELD)
    beats = accumulate([scaled(length, Fraction(1, count))] * count, initial=begin)
    return {beat: before * (1.0 + (last - 1.0) * step / count) for step, beat in enumerate(beats)}
