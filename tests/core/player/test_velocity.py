"""A harder note is louder, and begins sooner."""

from __future__ import annotations

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
    wishes = playing.wishes(instrument)
    wishes.write("/playing/variation", 0.0)
    instrument.write("/bow/noise", 0.0, ramp_ms=0.0)  # A4 at the body's mode minds it by a decibel
    wishes.write("/body/evenness", 1.0)
    playing.midi(wishes).receive(mido.Message("note_on", note=note, velocity=velocity))
    sound = np.zeros(round(1.2 * RATE), np.float32)
    instrument.process(sound)
    return sound


def level(note: int, velocity: int) -> float:
    """Level (dB, A-weighted) of a note once it is steady."""
    return a_weighted_db(struck(note, velocity)[RATE // 2 :], RATE)


def attack(note: int, velocity: int) -> float:
    """Time (s) in which a note comes to half of its amplitude."""
    window = RATE // 100
    power = np.convolve(np.square(struck(note, velocity)), np.ones(window) / window, "same")
    steady = np.median(power[RATE // 2 : -window])
    return float(np.argmax(power > 0.25 * steady)) / RATE


@pytest.mark.parametrize("note", NOTES)
def test_the_level_rises_with_velocity_by_some_twenty_decibels(note):
    levels = [level(note, velocity) for velocity in VELOCITIES]
    assert min(np.diff(levels)) > 1.0
    assert levels[-1] - levels[0] == pytest.approx(20.0, abs=4.0)
    assert levels[-1] - levels[VELOCITIES.index(80)] >= 3.0


def test_notes_of_one_velocity_are_equally_loud():
    for velocity in (20, 80, 127):
        assert np.ptp([level(note, velocity) for note in NOTES]) < 4.0


@pytest.mark.parametrize("note", NOTES)
def test_a_harder_note_is_brighter(note):
    def centroid(velocity):
        steady = struck(note, velocity)[RATE // 2 :]
        power = np.abs(np.fft.rfft(steady)) ** 2
        return power @ np.fft.rfftfreq(len(steady), 1 / RATE) / power.sum()

    assert centroid(127) > 1.25 * centroid(20)


@pytest.mark.parametrize("note", NOTES)
def test_the_hardest_note_does_not_reach_the_limiter(note):
    bent_above_db = find("/output/limiter").default
    assert np.abs(struck(note, 127)).max() < 10.0 ** (bent_above_db / 20.0)


@pytest.mark.parametrize("note", NOTES)
def test_a_hard_note_begins_sooner_than_a_soft_one(note):
    assert attack(note, 127) < 0.7 * attack(note, 1)
