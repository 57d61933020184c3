"""Practise: find how each note is bowed at each place from the bridge, by playing it.

Each note is played after others, slurred and separate, at several speeds and pressures; the ear of
the player (``player.ear``) tells whether it speaks: with one slip in a period, at its pitch. Where
it doesn't, other shares of Schelleng's limit, places nearby, slower bows and a firmer finger are
tried. What is farther from the wish has to be better.
"""

from __future__ import annotations

import math
import os
from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.engine.instrument import Instrument
from yehu_server.params.table import find
from yehu_server.physics.quantities import Quantities
from yehu_server.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    FARTHER,
    FIRST,
    FLAUTANDO,
    LEAST_PRESS,
    PLACES,
    TOP_SPEED,
)
from yehu_server.player.calibration import OPEN_NOTES, Calibration
from yehu_server.player.fingering import HIGHEST_NOTE, LOWEST_NOTE
from yehu_server.player.practice import bowing_table
from yehu_server.playing.wishes import Key, Wishes

Array = Any
Progress = Callable[[float, float], None]

NOTES = range(LOWEST_NOTE, HIGHEST_NOTE + 1)
DEFAULT = PLACES.index(find("/playing/bow_position").default)  # calibrated so: it stays
SPEEDS, PRESSURES = (0.12, 0.16, 0.2, 0.25), (0.2, 0.3, 0.42, 0.55)
QUICK = (0.2, 0.24)  # speeds (m/s) for which a light bow is practised at the default place
RESTS_S = (0.02, 0.12)
BEFORE_S, EARLY_S, LATE_S, UP_S, EACH_S = 0.2, 0.13, 0.38, 0.385, 0.4
TRIES, QUICK_TRIES = 10, 8
AGAIN, FINALISTS = 500_000, 4  # what begins the other passages; manners that play them
# It speaks: certainty and slips in a period; cents early, when the ear has not yet tuned it, and
# late. Weight of early.
CERTAIN, FEWEST, MOST, NEAR_EARLY, NEAR_LATE, EARLY = 0.97, 0.7, 1.4, 60.0, 15.0, 0.3
NEAR_OPEN = 8.0  # of open strings, which nothing tunes
OFF_WEIGHT = 600.0  # cents of the first error that count as much as never to speak
GOOD, BETTER = 0.95, 0.02  # a score that is not improved, and by how much another must be better
STAYS_WELL = 0.9  # a score at the usual place that is good enough
AWAY, CHANGED = 0.05, 0.02  # lost for moving the bow by a factor of e, and its share
FARTHERS_ON_F, FARTHERS_ON_C = (0.7, 0.85, 1.0, 1.2, 1.45, 1.75), (0.87, 1.0, 1.15)
SHARES, FIRMEST_ON_F, FIRMEST_ON_C = (0.75, 1.0, 1.35, 1.8, 2.3), 1.2, 3.5
TOP_SPEEDS, PRESSES = (0.08, 0.1, 0.13, 0.16, 0.2, 0.6), (0.0, 3.0, 4.0)
FINE_FARTHERS, FINE_SHARES = (0.95, 1.0, 1.05), (0.88, 1.0, 1.13)
FLAUTANDO_SHARES = (1.0, 1.3, 1.6, 2.0, 2.4)
NEAREST, FARTHEST = 0.055, 0.36  # bow positions
FIRST_ON_C = 72


@dataclass(frozen=True)
class Passage:
    """A note before, and how the next is bowed."""

    before: int
    speed: float
    pressure: float
    is_slurred: bool
    rest_s: float


class Practice:
    """Practises on an instrument at a rate (Hz).

    Parameters
    ----------
    values : mapping
        Values of parameters, by address: those of the bow's place, speed and pressure alone are
        practised.

    Attributes
    ----------
    notes_changed : int
        Number of notes at places of the bow that are now bowed otherwise.
    """

    def __init__(
        self,
        rate: float,
        quantities: Quantities,
        calibration: Calibration,
        values: Mapping[str, float] | None = None,
    ) -> None:
        values = values or {}
        self._rate = rate
        self._speeds: tuple[float, ...] = SPEEDS
        self._pressures: tuple[float, ...] = PRESSURES
        self._places = range(len(PLACES))
        if "/playing/speed" in values:
            self._speeds = (values["/playing/speed"],)
        if "/playing/pressure" in values:
            self._pressures = (values["/playing/pressure"],)
        if "/playing/bow_position" in values:
            above = bisect_left(PLACES, values["/playing/bow_position"])
            self._places = range(max(above - 1, 0), min(above + 1, len(PLACES)))
        self.notes_changed = 0
        self._tuned = calibration.tuned(quantities)
        self._calibration = calibration
        self._usual = bowing_table()

    def learn(self, progress: Progress | None = None) -> Array:
        """Practise all notes at all places; return a table as `bowing_table` does.

        Parameters
        ----------
        progress : callable, optional
            Called with the number of notes done and of all notes.
        """
        table = self._usual.copy()
        with ThreadPoolExecutor(os.cpu_count()) as workers:  # the model runs without the GIL
            for done, note in enumerate(NOTES, start=1):
                for place in self._places:
                    improve = self._lightly if place == DEFAULT else self._anew
                    found = improve(note, place, workers)
                    self.notes_changed += int(np.any(found != table[place, note - FIRST]))
                    table[place, note - FIRST] = found
                if progress is not None:
                    progress(done, len(NOTES))
        table[:, : LOWEST_NOTE - FIRST] = table[:, LOWEST_NOTE - FIRST, None]
        return table

    def _anew(self, note: int, place: int, workers: ThreadPoolExecutor) -> Array:
        """The best manner of a note at a place; its own where that is good."""
        usual = self._usual[place, note - FIRST]
        passages = _passages(1000 * note + place, TRIES, self._speeds, self._pressures)
        best, score = usual, self.score(note, place, usual, passages)
        again = _passages(1000 * note + place + AGAIN, TRIES, self._speeds, self._pressures)
        if score >= GOOD and self.score(note, place, usual, again) >= GOOD:
            return best

        def scores(tried: list[Array], passages: list[Passage]) -> Array:
            found = list(workers.map(lambda m: self.score(note, place, m, passages), tried))
            return np.array(found) - [_lost(manner, usual) for manner in tried]

        def choose(best: Array, score: float, tried: Iterable[Array]) -> tuple[Array, float]:
            tried = list(tried)
            found = scores(tried, passages)
            first = np.argsort(-found)[:FINALISTS]
            if found[first[0]] <= score + BETTER:
                return best, score
            # The best of many was lucky too: other passages decide among the first few.
            finalists = [best, *(tried[i] for i in first)]
            both = 0.5 * (np.array([score, *found[first]]) + scores(finalists, again))
            winner = int(both.argmax())
            if winner == 0 or both[winner] <= both[0] + BETTER:
                return best, score
            return finalists[winner], float(both[winner])

        farthers = FARTHERS_ON_C
        if note < FIRST_ON_C:  # there the bow may also stay where it usually is
            stays = usual[FARTHER] * PLACES[DEFAULT] / PLACES[place]
            best, score = choose(
                best, score, _varied(note, place, usual, (stays,), (1.0,), fixed=True)
            )
            if score >= STAYS_WELL:
                return best
            farthers = (*FARTHERS_ON_F, *(stays * near for near in FINE_FARTHERS))
        best, score = choose(best, score, _varied(note, place, usual, farthers, SHARES, fixed=True))
        best, score = choose(best, score, (_with(best, TOP_SPEED, v) for v in TOP_SPEEDS))
        best, score = choose(best, score, (_with(best, LEAST_PRESS, v) for v in PRESSES))
        best, _ = choose(best, score, _varied(note, place, best, FINE_FARTHERS, FINE_SHARES))
        return best

    def _lightly(self, note: int, place: int, _workers: ThreadPoolExecutor) -> Array:
        """The usual manner, with a share for flautando at which a quick bow speaks."""
        usual = self._usual[place, note - FIRST]
        passages = _passages(note, QUICK_TRIES, QUICK, (FLAUTANDO,))
        best, most = usual, -math.inf
        for share in FLAUTANDO_SHARES:
            manner = _with(usual, AT_FLAUTANDO, usual[AT_FLAUTANDO] * share)
            score = self.score(note, place, manner, passages) - CHANGED * math.log(share)
            if score > most + BETTER:
                best, most = manner, score
            if score >= GOOD:
                break
        return best

    def score(self, note: int, place: int, manner: Array, passages: Iterable[Passage]) -> float:
        """How well a note speaks in some passages: at best 1."""
        table = self._usual.copy()
        table[:, note - FIRST] = manner
        instrument = Instrument(
            self._rate, self._tuned, calibration=self._calibration, bowing=table
        )
        instrument.bow_by_tables()
        wishes = Wishes(instrument)
        wishes.write("/playing/variation", 0.0)
        wishes.write("/playing/bow_position", PLACES[place])
        speaks, off, count = 0.0, 0.0, 0
        for passage in passages:
            early, late, error = self._play(instrument, wishes, note, passage)
            speaks += (late + EARLY * early) / (1.0 + EARLY)
            off += min(abs(error), NEAR_EARLY) if early else NEAR_EARLY
            count += 1
        return (speaks - off / OFF_WEIGHT) / count

    def _play(
        self, instrument: Instrument, wishes: Wishes, note: int, passage: Passage
    ) -> tuple[bool, bool, float]:
        """Whether a note speaks early and late in a passage, and its error (cents) early."""
        start = instrument.frame

        def play_until(seconds: float) -> None:
            frames = start + instrument.frames(1e3 * seconds) - instrument.frame
            instrument.process(np.zeros(frames, np.float32))

        before = passage.before
        if before == note:
            before += 5 if note < FIRST_ON_C else -5
        at = start + instrument.frames(1e3 * BEFORE_S)
        rest = instrument.frames(1e3 * passage.rest_s)
        wishes.write("/playing/speed", passage.speed, frame=start)
        wishes.write("/playing/pressure", passage.pressure, frame=start)
        wishes.note_on(Key(0, before), frame=start)
        if passage.is_slurred:
            wishes.note_on(Key(0, note), frame=at)
            wishes.note_off(Key(0, before), frame=at)
        else:
            wishes.note_off(Key(0, before), frame=at - rest)
            wishes.note_on(Key(0, note), frame=at)
        play_until(BEFORE_S + EARLY_S)
        early, error = _speaks(instrument, NEAR_EARLY)
        play_until(BEFORE_S + LATE_S)
        late, _ = _speaks(instrument, NEAR_OPEN if note in OPEN_NOTES else NEAR_LATE)
        end = start + instrument.frames(1e3 * (BEFORE_S + UP_S))
        wishes.note_off(Key(0, note), frame=end)
        play_until(BEFORE_S + EACH_S)
        return early, late, error


def _speaks(instrument: Instrument, near: float) -> tuple[bool, float]:
    """Whether the sounding note is heard to speak within `near` cents, and its error (cents)."""
    certainty, slips, error = instrument.heard()
    is_one = certainty > CERTAIN and FEWEST < slips < MOST
    return is_one and abs(error) < near, error


def _passages(
    seed: int, count: int, speeds: tuple[float, ...], pressures: tuple[float, ...]
) -> list[Passage]:
    chance = np.random.default_rng(seed)
    return [
        Passage(
            before=int(chance.choice(NOTES)),
            speed=float(chance.choice(speeds)),
            pressure=float(chance.choice(pressures)),
            is_slurred=bool(chance.integers(2)),
            rest_s=float(chance.choice(RESTS_S)),
        )
        for _ in range(count)
    ]


def _lost(manner: Array, usual: Array) -> float:
    """What a manner loses for its distance from the usual one."""
    moved = abs(math.log(manner[FARTHER] / usual[FARTHER]))
    return AWAY * moved + CHANGED * abs(math.log(manner[AT_LIGHT] / usual[AT_LIGHT]))


def _with(manner: Array, column: int, value: float) -> Array:
    changed = manner.copy()
    changed[column] = value
    return changed


def _varied(
    note: int,
    place: int,
    manner: Array,
    farthers: tuple[float, ...],
    shares: tuple[float, ...],
    *,
    fixed: bool = False,
) -> list[Array]:
    """Manners with the bow elsewhere (where `fixed`, by these factors alone) and other shares."""
    firmest = FIRMEST_ON_C if note >= FIRST_ON_C else FIRMEST_ON_F
    varied = []
    for farther in farthers:
        for share in shares:
            changed = manner.copy()
            changed[FARTHER] = farther if fixed else manner[FARTHER] * farther
            changed[[AT_FLAUTANDO, AT_LIGHT, AT_FIRM]] *= share
            changed[AT_FIRM] = min(changed[AT_FIRM], firmest)
            if NEAREST <= PLACES[place] * changed[FARTHER] <= FARTHEST:
                varied.append(changed)
    return varied
