"""The sound of notes: they speak, in tune, and end."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pitch import cents, hertz, pitch_of
from sound import run_for

from yehu_server.core.engine.instrument import Instrument
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.wishes import Key, WishPoster

RATE = 44100


def level(samples: np.ndarray) -> float:
    """RMS in dB of full scale."""
    return 10.0 * math.log10(max(float(np.mean(np.square(samples, dtype=np.float64))), 1e-24))


def player_at(rate: float) -> tuple[WishPoster, Instrument]:
    playing = PlayingOptions()
    instrument = Instrument(playing.spec(rate, calibration_for(float(rate))))
    return playing.wishes(instrument), instrument


# ---------------------------------------------------------------- notes


def test_every_note_speaks_in_tune_within_a_fifth_of_a_second_without_any_controller(everything):
    off = {}
    for note in range(65, 90) if everything else range(65, 90, 2):
        player, instrument = player_at(RATE)
        player.note_on(Key(0, note))
        out = run_for(instrument, 0.6)[RATE // 5 :]
        off[note] = cents(pitch_of(out, RATE), hertz(note))
        assert level(out) > -40.0, note
    assert {note: by for note, by in off.items() if not abs(by) < 35.0} == {}


def test_a_bend_is_heard_as_far_as_it_says():
    for note, bend in ((66, -1.5), (71, 0.5), (74, 2.0), (80, -1.5), (86, 0.5)):
        player, instrument = player_at(RATE)
        player.note_on(Key(0, note))
        run_for(instrument, 0.4)
        player.write("/playing/bend", bend)
        out = run_for(instrument, 0.8)[RATE // 3 :]
        expected = max(note + bend, 65)  # nothing is below the open F string
        assert abs(cents(pitch_of(out, RATE), hertz(expected))) < 35.0, (note, bend)


def test_legato_turns_reach_every_note():
    player, instrument = player_at(RATE)
    held = None
    for note in (66, 70, 74, 77, 72, 79, 84, 73, 65):
        player.note_on(Key(0, note))
        if held:
            player.note_off(held)
        held = Key(0, note)
        out = run_for(instrument, 0.7)[RATE // 3 :]
        assert abs(cents(pitch_of(out, RATE), hertz(note))) < 50.0, note


def test_a_faster_bow_and_a_higher_level_are_louder():
    levels = []
    for speed, volume in ((0.1, 1.0), (0.2, 1.0), (0.2, 0.7)):
        player, instrument = player_at(RATE)
        player.write("/playing/speed", speed)
        player.write("/playing/volume", volume)
        player.note_on(Key(0, 75))
        levels.append(level(run_for(instrument, 1.0)[RATE // 2 :]))
    slow, fast, fast_but_low = levels
    assert fast > slow + 2.0
    assert fast_but_low < fast - 2.0


@pytest.mark.parametrize("note", [65, 70, 72, 80])
def test_a_note_ends(note):
    player, instrument = player_at(RATE)
    player.note_on(Key(0, note))
    loud = level(run_for(instrument, 0.5)[RATE // 4 :])
    player.note_off(Key(0, note))
    assert level(run_for(instrument, 3.0)[-RATE // 2 :]) < loud - 50.0


@pytest.mark.parametrize("note", [65, 70, 72, 80])
def test_all_sound_off_is_silence_within_five_milliseconds(note):
    player, instrument = player_at(RATE)
    player.note_on(Key(0, note))
    run_for(instrument, 0.5)
    player.notes_off(player.held())
    player.stop_sound()
    out = run_for(instrument, 0.5)[round(0.005 * RATE) + 1 :]
    assert np.abs(out).max() < 1e-3  # -60 dBFS
    player.note_on(Key(0, note))  # and the next note speaks
    out = run_for(instrument, 1.0)[RATE // 2 :]
    assert abs(cents(pitch_of(out, RATE), hertz(note))) < 35.0
