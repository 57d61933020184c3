"""Practise: find how each note is bowed at each place from the bridge, by playing it.

Each note is played first, and after others, slurred and separate, at several speeds and pressures;
the ear of the player (``player.ear``), at the string, judges whether it speaks: with one slip in a
period, at its pitch. What the body radiates has to have that pitch, too: the bow may keep a mode of
it going beside a high note. Where it doesn't speak, other shares of Schelleng's limit, places
nearby, slower bows and a firmer finger are tried. What is farther from what is asked for has to be
better.
"""

import math
import os
from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from yehu_lab.practising.candidates import DEFAULT, ROUNDS, lighter, lost, moved
from yehu_lab.practising.passages import (
    Passage,
    SearchedNote,
    passages_of,
    pitches_near_notes,
    stops_of,
)
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.bowing import (
    BOW_POSITIONS,
    FIRST_NOTE,
    FLAUTANDO,
    default_bowing_table,
)
from yehu_server.core.player.note_range import LOWEST_NOTE, NoteRange
from yehu_server.core.player.note_tables import NoteTables, frequency_hz
from yehu_server.playing.part_state import Key
from yehu_server.playing.pitch_and_level import cents, pitch_hz
from yehu_server.playing.player import Player

Array = Any
Progress = Callable[[float, float], None]

QUICK = (0.2, 0.24)  # speeds (m/s) for which a light bow is practised
BEFORE_S, EARLY_S, LATE_S, UP_S, EACH_S = 0.2, 0.13, 0.38, 0.385, 0.4
LISTEN_S = 0.06  # before LATE_S
SPEEDS, PRESSURES = (0.12, 0.16, 0.2, 0.25), (0.2, 0.3, 0.42, 0.55)
# Passages that a bowing is judged by, of which the first few find those that are worth the others;
# and of a light, quick bow.
TRIES, HEAT, QUICK_TRIES = 16, 5, 8
AGAIN, FINALISTS = 500_000, 4  # what begins the other passages; bowings that play them
# It speaks: certainty and slips in a period; cents early, when the ear has not yet tuned it, and
# late. Weight of early.
CERTAIN, FEWEST, MOST, NEAR_EARLY, NEAR_LATE, EARLY = 0.97, 0.7, 1.4, 60.0, 15.0, 0.3
NEAR_OPEN = 8.0  # of open strings, which nothing tunes
OFF_WEIGHT = 600.0  # cents of the first error that count as much as never to speak
GOOD, BETTER = 0.96, 0.015  # a score that is not improved, and by how much another must be better
REGISTERS = 3.0  # how far below and above a note its other registers are searched


class BowingSearch:
    """Practises on an instrument at a rate (Hz).

    `values`: values of parameters, by address: those of the bow's place, speed and pressure alone
    are practised.
    `tuning`: maps a key to its pitch, both fractional MIDI notes, or None. Each note is practised
    at the pitch nearest to it; by default at its own.

    `notes_changed`: number of notes at places of the bow that are now bowed otherwise.
    """

    def __init__(
        self,
        rate: float,
        quantities: Quantities,
        calibration: NoteTables,
        values: Mapping[str, float] | None = None,
        tuning: Callable[[float], float | None] = float,
    ) -> None:
        values = values or {}
        self._notes = NoteRange.of(quantities, calibration)
        self._pitches = pitches_near_notes(tuning, self._notes)
        self._rate = rate
        self._speeds: tuple[float, ...] = SPEEDS
        self._pressures: tuple[float, ...] = PRESSURES
        self._places = range(len(BOW_POSITIONS))
        if "/playing/speed" in values:
            self._speeds = (values["/playing/speed"],)
        if "/playing/pressure" in values:
            self._pressures = (values["/playing/pressure"],)
        if "/playing/bow_position" in values:
            above = bisect_left(BOW_POSITIONS, values["/playing/bow_position"])
            self._places = range(max(above - 1, 0), min(above + 1, len(BOW_POSITIONS)))
        self.notes_changed = 0
        self._tuned = calibration.tuned(quantities)
        self._calibration = calibration

    def learn(
        self,
        progress: Progress | None = None,
        *,
        table: Array | None = None,
        places: Iterable[int] = range(len(BOW_POSITIONS)),
    ) -> Array:
        """Practise all notes; return a table as `default_bowing_table` does.

        `progress`: called with the number of notes done and of all notes.
        `table` (ndarray, optional): how notes are bowed to begin with; by default all alike.
        `places`: indices of BOW_POSITIONS to practise.
        """
        table = default_bowing_table() if table is None else table.copy()
        asked = [place for place in places if place in self._places]
        with ThreadPoolExecutor(os.cpu_count()) as workers:  # the model runs without the GIL
            stops = stops_of(self._notes)
            for done, (string, note) in enumerate(stops, start=1):
                for place in sorted(asked, key=lambda place: place != DEFAULT):
                    start = table[string, place, note - FIRST_NOTE].copy()
                    there = None if place == DEFAULT else moved(table, string, note, place)
                    found = self._best(
                        SearchedNote(string, note, place, start, there, self._notes), workers
                    )
                    self.notes_changed += int(np.any(found != start))
                    table[string, place, note - FIRST_NOTE] = found
                if progress is not None:
                    progress(done, len(stops))
        table[0, :, : LOWEST_NOTE - FIRST_NOTE] = table[0, :, LOWEST_NOTE - FIRST_NOTE, None]
        return table

    def _best(self, search: SearchedNote, workers: ThreadPoolExecutor) -> Array:
        """The best bowing of a note at a place; that which it starts from where that is good."""
        string, place, start = search.string, search.place, search.start
        seed = 1000 * search.note + 100 * string + place
        speeds, pressures = self._speeds, self._pressures
        passages = passages_of(search, seed, TRIES, speeds, pressures)
        again = passages_of(search, seed + AGAIN, TRIES, speeds, pressures)

        def scores(tried: list[Array], passages: list[Passage]) -> Array:
            found = list(workers.map(lambda m: self.score(search, m, passages), tried))
            return np.array(found) - [lost(bowing, start) for bowing in tried]

        def choose(best: Array, score: float, tried: Iterable[Array]) -> tuple[Array, float]:
            tried = list(tried)
            if not tried:
                return best, score
            first = scores(tried, passages[:HEAT])
            tried = [tried[i] for i in np.argsort(-first)[: max(FINALISTS, len(tried) // 3)]]
            found = scores(tried, passages)
            order = np.argsort(-found)[:FINALISTS]
            if found[order[0]] <= score + BETTER:
                return best, score
            # The best of many was lucky too: other passages decide among the first few.
            finalists = [best, *(tried[i] for i in order)]
            both = 0.5 * (np.array([score, *found[order]]) + scores(finalists, again))
            winner = int(both.argmax())
            if winner == 0 or both[winner] <= both[0] + BETTER:
                return best, score
            return finalists[winner], float(both[winner])

        best, score = start, float(scores([start], passages)[0])
        if search.moved is not None:
            best, score = choose(best, score, [search.moved])
        if score < GOOD or float(scores([best], again)[0]) < GOOD:
            for others in ROUNDS:
                best, score = choose(best, score, others(best, string, place))
        if best is not start:  # a best of many is biased upwards: score it again on fresh passages
            fresh = passages_of(search, seed + 2 * AGAIN, 2 * TRIES, speeds, pressures)
            before, after = scores([start, best], fresh)
            best = best if after > before + BETTER else start
        return self._lightly(search, best) if FLAUTANDO in pressures else best

    def _lightly(self, search: SearchedNote, usual: Array) -> Array:
        """A bowing with a share for flautando at which a quick bow speaks."""
        passages = passages_of(search, search.note, QUICK_TRIES, QUICK, (FLAUTANDO,))
        best, most = usual, -math.inf
        for bowing, loss in lighter(usual):
            score = self.score(search, bowing, passages) - loss
            if score > most + BETTER:
                best, most = bowing, score
            if score >= GOOD:
                break
        return best

    def score(self, search: SearchedNote, bowing: Array, passages: Iterable[Passage]) -> float:
        """How well a note speaks in some passages: at best 1."""
        table = default_bowing_table()
        stopped = self._pitches[search.sounds] - search.above
        for row in {math.floor(stopped), math.ceil(stopped)}:
            table[search.string, :, row - FIRST_NOTE] = bowing
        spec = InstrumentSpec(self._rate, self._tuned, calibration=self._calibration, bowing=table)
        instrument = Instrument(spec)
        instrument.disable_pressure_correction()
        commands = Player(instrument)
        commands.write("/playing/variation", 0.0)
        commands.write("/playing/bow_length", 0.0)
        instrument.write("/bow/noise", 0.0, ramp_ms=0.0)
        commands.write("/playing/bow_position", BOW_POSITIONS[search.place])
        if search.is_high_on_inner:
            commands.write("/playing/string", 1.0)
        speaks, off, count = 0.0, 0.0, 0
        for passage in passages:
            early, late, error = self._play(instrument, commands, search, passage)
            speaks += (late + EARLY * early) / (1.0 + EARLY)
            off += min(abs(error), NEAR_EARLY) if early else NEAR_EARLY
            count += 1
        return (speaks - off / OFF_WEIGHT) / count

    def _play(
        self, instrument: Instrument, commands: Player, search: SearchedNote, passage: Passage
    ) -> tuple[bool, bool, float]:
        """Whether a note speaks early and late in a passage, and its error (cents) early."""
        start = instrument.frame

        def play_until(seconds: float) -> Array:
            frames = start + instrument.frames(1e3 * seconds) - instrument.frame
            sound = np.zeros(frames, np.float32)
            instrument.process(sound)
            return sound

        before, note = passage.before, search.sounds
        at = start + instrument.frames(1e3 * BEFORE_S)
        rest = instrument.frames(1e3 * passage.rest_s)
        commands.write("/playing/speed", passage.speed, frame=start)
        commands.write("/playing/pressure", passage.pressure, frame=start)
        if before is not None:
            commands.note_on(Key(0, before), frame=start, tuned=self._pitches[before])
            if not passage.is_slurred:
                commands.note_off(Key(0, before), frame=at - rest)
        commands.note_on(Key(0, note), frame=at, tuned=self._pitches[note])
        if before is not None and passage.is_slurred:
            commands.note_off(Key(0, before), frame=at)
        play_until(BEFORE_S + EARLY_S)
        early, error = _speaks(instrument, NEAR_EARLY)
        sound = play_until(BEFORE_S + LATE_S)[-instrument.frames(1e3 * LISTEN_S) :]
        late, _ = _speaks(instrument, NEAR_OPEN if search.is_open else NEAR_LATE)
        late = late and has_pitch(sound, self._rate, self._pitches[note])
        end = start + instrument.frames(1e3 * (BEFORE_S + UP_S))
        commands.note_off(Key(0, note), frame=end)
        play_until(BEFORE_S + EACH_S)
        return early, late, error


def has_pitch(sound: Array, rate: float, pitch: float) -> bool:
    """Whether a sound has a pitch (fractional MIDI note), in its register."""
    wanted = frequency_hz(pitch, 440.0)
    found = pitch_hz(sound, rate, lo=wanted / REGISTERS, hi=wanted * REGISTERS)
    return math.isfinite(found) and abs(cents(found, wanted)) < NEAR_EARLY


def _speaks(instrument: Instrument, near: float) -> tuple[bool, float]:
    """Whether the sounding note is heard to speak within `near` cents, and its error (cents)."""
    certainty, slips, error = instrument.heard()
    is_one = certainty > CERTAIN and FEWEST < slips < MOST
    return is_one and abs(error) < near, error
