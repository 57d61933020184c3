"""A harder note is louder, and begins sooner."""

from functools import cache

import mido
import numpy as np
import pytest

from yehu_server.core.engine.instrument import Instrument
from yehu_server.params.table import find
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.pitch_and_level import a_weighted_db

RATE = 44100
VELOCITIES = (1, 20, 50, 80, 110, 127)
NOTES = (66, 69, 74, 82)  # on both strings


@cache
def struck(note: int, velocity: int) -> np.ndarray:
    """The sound of a note on the shipped keyboard mapping, evened out and without variation."""
    playing = PlayingOptions()
    assert playing.mapping.name == "keyboard"
    instrument = Instrument(playing.spec(RATE, calibration_for(float(RATE))))
    commands = playing.player(instrument)
    commands.write("/playing/variation", 0.0)
    instrument.write("/bow/noise", 0.0, ramp_ms=0.0)  # A4 at the body's mode minds it by a decibel
    commands.write("/body/evenness", 1.0)
    playing.mapped(commands).receive(mido.Message("note_on", note=note, velocity=velocity))
    sound = np.zeros(round(1.2 * RATE), np.float32)
    instrument.process(sound)
    return sound


@pytest.mark.parametrize("note", NOTES)
def test_a_harder_note_is_louder_by_some_twenty_decibels_brighter_and_sooner_there(note):
    steady = [struck(note, velocity)[RATE // 2 :] for velocity in VELOCITIES]
    levels = [a_weighted_db(sound, RATE) for sound in steady]
    assert min(np.diff(levels)) > 1.0
    assert levels[-1] - levels[0] == pytest.approx(20.0, abs=4.0)
    assert levels[-1] - levels[VELOCITIES.index(80)] >= 3.0
    bent_above_db = find("/output/limiter").default
    assert np.abs(struck(note, 127)).max() < 10.0 ** (bent_above_db / 20.0)
    power = np.abs(np.fft.rfft(steady, axis=1)) ** 2
    centroids = power @ np.fft.rfftfreq(len(steady[0]), 1 / RATE) / power.sum(axis=1)
    assert centroids[-1] > 1.05 * centroids[VELOCITIES.index(20)]
    window = RATE // 100
    half_of_amplitude = []
    for velocity in (1, 127):
        power = np.convolve(np.square(struck(note, velocity)), np.ones(window) / window, "same")
        half_of_amplitude.append(np.argmax(power > 0.25 * np.median(power[RATE // 2 : -window])))
    assert half_of_amplitude[1] < 0.7 * half_of_amplitude[0]


def test_notes_of_one_velocity_are_equally_loud():
    for velocity in (20, 80, 127):
        levels = [a_weighted_db(struck(note, velocity)[RATE // 2 :], RATE) for note in NOTES]
        assert np.ptp(levels) < 4.0
