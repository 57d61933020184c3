"""Tune the model by bowing it: string tensions, and finger positions for each pitch.

Each open string is tuned by its tension; each stopped note is bowed at several speeds, and the
finger moved until it is in tune. `playing.calibration_store` keeps the results, under a key of
everything that they depend on.
"""

import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.elementary import exp2
from yehu_server.core.physics.shelf import shelf_gain
from yehu_server.core.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    BOW_POSITIONS,
    DISTANCE_FACTOR,
    FIRM,
    LIGHT,
    MIN_PRESS,
    TOP_SPEED,
    at_pitch,
    bow_pressure_for,
)
from yehu_server.core.player.note_tables import (
    ABOVE,
    GAINS,
    OPEN_NOTES,
    PITCHES,
    PLAIN,
    SPEEDS,
    USUAL_SPEED,
    NoteTables,
    Tables,
    frequency_hz,
    ideal_position,
)
from yehu_server.params.table import find
from yehu_server.playing.bowing_tables import shipped_bowing_table
from yehu_server.playing.pitch_and_level import SILENCE_DB, a_weighted_db, cents, pitch_hz
from yehu_server.playing.stringing import notes_of
from yehu_server.util import PACKAGE
from yehu_server.util.loudness import a_weighting
from yehu_server.util.source_key import key_of

Array = Any
Progress = Callable[[float, float], None]

PRESS = 1.5  # N
SETTLE_S, LISTEN_S, OPEN_SETTLE_S, OPEN_LISTEN_S = 0.3, 0.12, 0.6, 0.3
ROUNDS = 6
DEFAULT_PLACE = find("/playing/bow_position").default
PLAUSIBLE_CENTS = 90.0  # beyond, the note is in another register
IN_TUNE_CENTS, ENOUGH_CENTS = 15.0, 0.7  # accepted at the end, and enough to stop
STEP_CENTS = 1.5  # in a bracket as narrow as this the pitch jumps
USUAL_CENTS = (50.0, 25.0)  # sharpening to begin with, and where nothing could be measured


@dataclass(frozen=True)
class _Setup:
    rate: float
    quantities: Quantities
    a4: float
    bowing: Array  # ndarray [shape=(STRINGS, NOTES, BOWING_SIZE)], at DEFAULT_PLACE
    open_notes: tuple[int, int]

    def above(self, string: int) -> int:
        """Semitones by which a string is tuned higher than a yehu's, for which tables are."""
        return self.open_notes[string] - OPEN_NOTES[string]

    def bowing_value(self, string: int, pitch: float, column: int) -> float:
        """One value of how a pitch is bowed on a string."""
        return at_pitch(self.bowing[string], float(pitch - self.above(string)), column)


def calibration_key(
    rate: float, quantities: Quantities, a4: float, bowing: Array | None = None
) -> str:
    """Hash of everything that a calibration depends on (16 hex digits); see `calibrate`."""
    core = PACKAGE / "core"
    sources = [
        source
        for folder in ("physics", "controls")
        for source in sorted((core / folder).glob("*.py"))
    ]
    sources += [core / "player" / f"{name}.py" for name in ("bowing", "note_tables")]
    sources += [core / "engine" / f"{name}.py" for name in ("sounding", "output")]
    sources += [Path(__file__)]
    bowing = shipped_bowing_table(rate) if bowing is None else bowing
    bowed = bowing[:, BOW_POSITIONS.index(DEFAULT_PLACE)].tolist()
    return key_of(sources, repr((rate, a4, quantities, bowed)))


def calibrate(
    rate: float,
    quantities: Quantities,
    *,
    a4: float = 440.0,
    bowing: Array | None = None,
    progress: Progress | None = None,
) -> NoteTables:
    """Measure a calibration at a rate (Hz) and reference pitch (Hz) by bowing the model.

    `bowing`: by default as practised for the nearest of the usual rates. `progress`: called with
    the number of notes done and of all. Raises ParameterError where the strings are no two that a
    fiddle has.
    """
    bowing = shipped_bowing_table(rate) if bowing is None else bowing
    open_notes = notes_of(quantities).open_notes
    usual = bowing[:, BOW_POSITIONS.index(DEFAULT_PLACE)]
    untuned = _Setup(rate, quantities, a4, usual, open_notes)
    jobs = [
        (string, pitch + untuned.above(string))
        for string, pitches in enumerate(PITCHES)
        for pitch in pitches
        if pitch <= OPEN_NOTES[string] + math.ceil(quantities.strings[string].reach)
    ]
    rows: list[Any] = []
    with ThreadPoolExecutor(os.cpu_count()) as workers:  # the model runs without the GIL
        first, second = workers.map(lambda i: _tension(untuned, i), (0, 1))
        tuned = replace(untuned, quantities=NoteTables(a4, (first, second), ()).tuned(quantities))
        measured = workers.map(lambda job: _stopped_note(tuned, *job), jobs)
        for done, row in enumerate(measured, start=1):
            rows.append(row)
            if progress is not None:
                progress(done, len(jobs))
    sharpening, levels = [], []
    for string, note in enumerate(open_notes):
        stopped = [row for (on, _), row in zip(jobs, rows, strict=True) if on == string]
        own = np.full((len(PITCHES[string]), len(SPEEDS), 2), np.nan)
        own[: len(stopped)] = stopped
        open_levels = [_bow(tuned, string, note, speed, None)[1] for speed in SPEEDS]
        sharpening.append(_completed(own[:, :, 0], USUAL_CENTS[string]))
        levels.append(_completed(np.vstack([open_levels, own[:, :, 1]]), SILENCE_DB))
    centroids, louder = _all_centroids(tuned, sharpening)
    tensions = (first, second)
    return NoteTables(a4, tensions, tuple(sharpening), tuple(levels), open_notes, centroids, louder)


def _bow(
    setup: _Setup, string: int, pitch: float, speed: float, x_f: float | None
) -> tuple[float, float]:
    """Pitch (Hz) and level (dB) of a string, bowed as the player does at medium pressure."""
    steady = _steady(setup, string, pitch, speed, x_f)
    # NumPy's transforms differ in their last bits from processor to processor; what is found here
    # decides where the next finger goes.
    return round(pitch_hz(steady, setup.rate), 9), round(a_weighted_db(steady, setup.rate), 9)


def _steady(setup: _Setup, string: int, pitch: float, speed: float, x_f: float | None) -> Array:
    """What is heard of that, once it is steady."""
    rate = setup.rate
    instrument = Instrument(InstrumentSpec(rate, setup.quantities))
    if x_f is not None:
        instrument.write("/finger/1/position", x_f, ramp_ms=0.0)
        instrument.write(
            "/finger/1/press", max(PRESS, setup.bowing_value(string, pitch, MIN_PRESS))
        )
    columns = (AT_FLAUTANDO, AT_LIGHT, AT_FIRM, DISTANCE_FACTOR, TOP_SPEED)
    flautando, light, firm, farther, fastest = (
        setup.bowing_value(string, pitch, c) for c in columns
    )
    pressure = bow_pressure_for(flautando, light, firm, 0.5 * (LIGHT + FIRM), string)
    beta = farther * DEFAULT_PLACE
    instrument.write("/bow/noise", 0.0, ramp_ms=0.0)  # an even bow: the same at every try
    instrument.write("/bow/position", beta, ramp_ms=0.0)
    instrument.write("/bow/pressure", pressure, ramp_ms=0.0)
    instrument.write("/bow/side", 1.0 if string == 0 else -1.0)
    instrument.write("/bow/speed", min(speed, fastest), ramp_ms=40.0)
    settle_s = OPEN_SETTLE_S if x_f is None else SETTLE_S
    listen_s = OPEN_LISTEN_S if x_f is None else LISTEN_S
    out = np.zeros(round((settle_s + listen_s) * rate), np.float32)
    instrument.process(out)
    return out[round(settle_s * rate) :]


def _all_centroids(setup: _Setup, sharpening: Sequence[Any]) -> tuple[Tables, Tables]:
    """Two tables of all notes: `NoteTables.centroids` and `louder`."""
    usual = SPEEDS.index(USUAL_SPEED)
    centroids, louder = [], []
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        for string, pitches in enumerate(PITCHES):
            jobs = [(setup, string, float(setup.open_notes[string]), None)]
            jobs += [
                (setup, string, pitch + setup.above(string), row[usual])
                for pitch, row in zip(pitches, sharpening[string], strict=True)
            ]
            found = list(workers.map(lambda job: _centroids(*job), jobs))
            centroids.append(tuple(row[0] for row in found))
            louder.append(tuple(row[1] for row in found))
    return tuple(centroids), tuple(louder)


def _centroids(setup: _Setup, string: int, pitch: float, sharp: float | None) -> tuple[Any, Any]:
    """Centroid (Hz) of a note with each of GAINS, and how much louder (dB) it is; 0 in silence.

    `sharp`: its sharpening (cents); None for an open string.
    """
    x_f = None
    if sharp is not None:
        flat = frequency_hz(pitch - sharp / 100.0, setup.a4)
        x_f = ideal_position(setup.quantities, string, flat)
    speed = min(USUAL_SPEED, setup.bowing_value(string, pitch, TOP_SPEED))
    steady = _steady(setup, string, pitch, speed, x_f)
    spectrum = np.fft.rfft(steady * np.hanning(len(steady)))
    frequencies = np.fft.rfftfreq(len(steady), 1.0 / setup.rate)[:-1]  # the shelf has no last one
    power = np.abs(spectrum[:-1]) ** 2
    if not power.any():
        return (0.0,) * len(GAINS), (0.0,) * len(GAINS)
    plain = frequencies @ power / power.sum()
    shelves = np.array([shelf_gain(frequencies, setup.rate, gain, ABOVE * plain) for gain in GAINS])
    shelved = power * shelves**2
    heard = shelved @ a_weighting(frequencies) ** 2
    centroids = np.round(shelved @ frequencies / shelved.sum(axis=1), 1)
    louder = np.round(10.0 * np.log10(heard / heard[PLAIN]), 2)
    return tuple(centroids.tolist()), tuple(louder.tolist())


def starting_tension(quantities: Quantities, a4: float, string: int) -> float:
    """Tension (N) from which an open string is tuned."""
    return quantities.strings[string].T * (a4 / 440.0) * (a4 / 440.0)


def _tension(setup: _Setup, string: int) -> float:
    """Tension (N) at which an open string is in tune."""
    note = setup.open_notes[string]
    target = frequency_hz(note, setup.a4)
    tension = starting_tension(setup.quantities, setup.a4, string)
    for _ in range(ROUNDS):
        quantities = override(setup.quantities, {f"string_{string + 1}": {"T": tension}})
        tried = replace(setup, quantities=quantities)
        measured_hz = [_bow(tried, string, note, speed, None)[0] for speed in SPEEDS[:3]]
        errors = [cents(f, target) for f in measured_hz if math.isfinite(f)]
        error = float(np.median(errors)) if errors else 0.0
        if abs(error) < PLAUSIBLE_CENTS:
            tension *= exp2(-2.0 * error / 1200.0)
        if abs(error) < ENOUGH_CENTS:
            break
    return tension


def _stopped_note(setup: _Setup, string: int, note: float) -> list[tuple[float, float]]:
    """Sharpening (cents) and level (dB) at each speed; NaN where the note leaves its register."""
    found = []
    guess = USUAL_CENTS[string]
    bowed_at = 0.0
    for speed in SPEEDS:
        slowed = min(speed, setup.bowing_value(string, note, TOP_SPEED))
        if slowed != bowed_at:
            sharp, level = _search(setup, string, note, slowed, guess)
            guess = sharp if math.isfinite(sharp) else guess
        bowed_at = slowed
        found.append((sharp, level))
    return found


def _search(
    setup: _Setup, string: int, note: float, speed: float, sharp: float
) -> tuple[float, float]:
    """Sharpening (cents) at which a note is nearest to its pitch, and its level (dB) there.

    The pitch does not follow the finger everywhere: it locks to the other string and to the
    body, and may jump over the note. So the search keeps a bracket, and the best result.
    """
    target = frequency_hz(note, setup.a4)
    best, nearest = (math.nan, math.nan), IN_TUNE_CENTS
    flat, high = math.inf, -math.inf  # the least sharpening that was flat, the most that was sharp
    for _ in range(ROUNDS):
        x_f = ideal_position(setup.quantities, string, target * exp2(-sharp / 1200.0))
        measured_hz, level = _bow(setup, string, note, speed, x_f)
        error = cents(measured_hz, target) if math.isfinite(measured_hz) else math.inf
        if abs(error) > PLAUSIBLE_CENTS:
            break
        if abs(error) < nearest:
            best, nearest = (sharp, level), abs(error)
        if abs(error) < ENOUGH_CENTS:
            break
        if error > 0.0:
            high = max(high, sharp)
        else:
            flat = min(flat, sharp)
        if flat - high < STEP_CENTS:
            break
        sharp += error
        if not high < sharp < flat:
            sharp = 0.5 * (high + flat) if high < flat else sharp
    return best


def _completed(table: Any, usual: float) -> tuple[tuple[float, ...], ...]:
    """Fill gaps from the note's other speeds, or by interpolation between its neighbours."""
    known = ~np.isnan(table)
    full = table.copy()
    for column in range(table.shape[1]):
        measured = np.flatnonzero(known[:, column])
        between = (
            np.interp(np.arange(len(table)), measured, table[measured, column])
            if len(measured)
            else np.full(len(table), usual)
        )
        for row in np.flatnonzero(~known[:, column]):
            others = table[row][known[row]]
            full[row, column] = others[-1] if len(others) else between[row]
    return tuple(tuple(round(float(value), 2) for value in row) for row in full)
