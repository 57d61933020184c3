"""Intonation: the calibration, and those that are shipped."""

from dataclasses import replace
from itertools import product

import mido
import numpy as np
import pytest
from hands import Watched
from pitch import cents, hertz, pitch_of
from sound import run, run_for

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.intonation import balance_db, position_of
from yehu_server.core.player.note_tables import (
    OPEN_NOTES,
    PITCHES,
    ROWS_OF_A_YEHU,
    SPEEDS,
    NoteTables,
)
from yehu_server.playing.calibration import _completed, calibration_key
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.pitch_and_level import a_weighted_db
from yehu_server.playing.player import Player

RATES = (44100.0, 48000.0, 96000.0)


def test_a_calibration_is_of_its_rate_its_instrument_and_its_pitch():
    keys = {
        calibration_key(rate, quantities, a4)
        for rate in RATES
        for quantities in (Quantities(), replace(Quantities(), bridge_x=0.29))
        for a4 in (440.0, 442.0)
    }
    assert len(keys) == 12


def test_a_note_that_could_not_be_measured_is_between_its_neighbours_at_each_speed():
    gone = np.nan
    table = np.array([[-20.0, -14.0], [gone, gone], [-26.0, -18.0], [gone, -11.0]])
    filled = np.array(_completed(table, -60.0))
    assert filled[1].tolist() == [-23.0, -16.0]
    assert filled[3].tolist() == [-11.0, -11.0]  # one that was, is as at its other speed
    assert np.isnan(table).sum() == 3
    assert _completed(np.full((2, 2), gone), -60.0) == ((-60.0, -60.0), (-60.0, -60.0))


MEASURED = Quantities()


def calibrated_player(calibration: NoteTables, quantities: Quantities = MEASURED) -> np.void:
    """The record of a player who knows a calibration."""
    instrument = Watched(quantities=quantities, calibration=calibration)
    return instrument._rig["player"][0]


def test_positions_go_up_with_the_pitch_and_are_even_between_the_notes():
    calibration = calibration_for(44100.0)
    player = calibrated_player(calibration, calibration.tuned(Quantities()))
    for string, open_note in enumerate(OPEN_NOTES):
        for speed in (0.05, *SPEEDS, 0.5):
            pitches = np.arange(open_note + 0.5, open_note + 10.0, 0.25)
            places = [position_of(player, string, pitch, speed, 0.0) for pitch in pitches]
            assert (np.diff(places) > 0.0).all()


def test_the_sharpening_is_read_at_its_notes_and_speeds():
    tables = tuple(
        tuple(tuple(10.0 * pitch + column for column in range(4)) for pitch in pitches)
        for pitches in PITCHES
    )
    player = calibrated_player(NoteTables(440.0, (49.5, 64.1), tables))

    def sharpening(string: int, pitch: float, speed: float) -> float:
        """How much lower (cents) than the pitch the finger stops an ideal string."""
        position = position_of(player, string, pitch, speed, 0.0)
        return 100.0 * (pitch - Watched().pitch_at(string, position))

    assert sharpening(0, 66.0, SPEEDS[0]) == pytest.approx(660.0)
    assert sharpening(1, 75.0, SPEEDS[2]) == pytest.approx(752.0)
    for pitch in (67.5, 67.7, 75.3):  # among quarter tones, between them, among semitones
        assert sharpening(0, pitch, SPEEDS[3]) == pytest.approx(10.0 * pitch + 3.0)
    assert sharpening(0, 60.0, 0.01) == pytest.approx(660.0)
    assert sharpening(1, 99.0, 9.0) == pytest.approx(963.0)


def test_notes_that_a_yehu_lacks_do_not_count_in_the_average_loudness():
    usual = calibration_for(44100.0)
    louder = tuple(
        (*rows[: ROWS_OF_A_YEHU + 1], *(((20.0,) * 4,) * (len(rows) - ROWS_OF_A_YEHU - 1)))
        for rows in usual.levels
    )
    players = [calibrated_player(each) for each in (usual, replace(usual, levels=louder))]
    for string, pitch, is_same in ((0, 70.0, True), (1, 89.0, True), (1, 94.0, False)):
        one, other = (balance_db(player, string, pitch, 0.2) for player in players)
        assert (one == other) == is_same


def begun(
    note: int,
    rate: float,
    velocity: int,
    wheel: int | None,
    a4: float = 440.0,
    quantities: Quantities = MEASURED,
    **settings: float,
) -> Instrument:
    """An instrument on which a note begins."""
    tuned = calibration_for(rate, quantities, a4=a4)
    instrument = Instrument(PlayingOptions(quantities=quantities).spec(rate, tuned))
    player = Player(instrument)
    for name, value in settings.items():
        player.write(f"/body/{name}", value)
    midi = player.mapped(load("keyboard"))
    if wheel is not None:
        midi.receive(mido.Message("control_change", control=16, value=wheel), frame=0)
    midi.receive(mido.Message("note_on", note=note, velocity=velocity), frame=0)
    return instrument


def heard(note: int, rate: float, *how) -> float:
    """The pitch (Hz) of a note, from 0.1 s after it began."""
    return pitch_of(run_for(begun(note, rate, *how), 0.7)[round(0.1 * rate) :], rate)


def test_notes_are_in_tune(everything):
    notes = [65, 67, 70, 72, 73, 75, 77, 78, 81, 82, 84, 86, 87, 89]
    hows = [(80, None), (110, 0), (50, 64)]  # velocity, wheel
    cases = [*product([44100.0], notes, hows), *product([48000.0], notes[::3], hows)]
    cases = cases if everything else cases[::4]  # most notes, each way in turn
    off = {
        (rate, note, how): cents(heard(note, rate, *how), hertz(note)) for rate, note, how in cases
    }
    # At 48 kHz a slow bow plays the lowest one 14 cents sharp.
    assert {at: by for at, by in off.items() if abs(by) >= (15.0 if at[1] == 65 else 10.0)} == {}


def test_notes_are_evenly_loud_but_where_the_body_has_its_way(everything):
    for velocity, wheel in ((80, None), (110, 64)):
        step = 1 if everything else 3
        levels = [loudness(note, velocity, wheel) for note in range(65, 90, step)]
        assert max(levels) - min(levels) < 6.0
        assert np.abs(np.diff(levels)).max() < 4.0
    low, middle, high = (loudness(note, 80, None, evenness=0.0) for note in (65, 73, 78))
    assert middle - low > 12.0
    assert middle - high > 6.0


def loudness(note: int, velocity: int, wheel: int | None, **settings: float) -> float:
    """A-weighted level (dB) of a note once it has settled."""
    return a_weighted_db(
        run(begun(note, 44100.0, velocity, wheel, **settings), 30870)[13230:], 44100.0
    )
