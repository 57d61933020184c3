"""The package's estimators of pitch (and the tests' own) and level, on known tones."""

import math
from itertools import product

import numpy as np
import pytest
from pitch import cents, pitch_of

from yehu_server.playing.pitch_and_level import SILENCE_DB, a_weighted_db, pitch_hz
from yehu_server.util.loudness import a_weighting

RATES = (22050.0, 44100.0, 48000.0, 96000.0)
# The A curve in dB, from the table of IEC 61672-1.
A_CURVE = {31.62: -39.4, 63.1: -26.2, 125.9: -16.1, 251.2: -8.6, 501.2: -3.2, 1000: 0.0, 1995: 1.2,
         3981: 1.0, 7943: -1.1, 15849: -6.6}  # fmt: skip


def tone(frequency: float, rate: float, seconds: float, slope: float = 1.0) -> np.ndarray:
    """Harmonics that fall off as a bowed string's do, in random phases."""
    phases = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, 60)
    time = np.arange(round(seconds * rate)) / rate
    return sum(
        k**-slope * np.sin(2.0 * np.pi * k * frequency * time + phases[k])
        for k in range(1, 60)
        if k * frequency < 0.45 * rate
    )


NOTES = (60, 65, 69.3, 72, 77.77, 83, 89, 94)


def hertz(note: float) -> float:
    return 440.0 * 2.0 ** ((note - 69) / 12)


@pytest.mark.parametrize("rate", RATES)
def test_steady_tones_are_right_to_half_a_cent(rate):
    for note, seconds in product(NOTES, (0.05, 0.3)):
        found = pitch_hz(tone(hertz(note), rate, seconds), rate)
        assert abs(cents(found, hertz(note))) < 0.5, (note, seconds)


@pytest.mark.parametrize("estimate", [pitch_hz, pitch_of])
@pytest.mark.parametrize("rate", RATES)
def test_tones_in_noise_are_right_to_half_a_cent_with_a_fundamental_or_without(estimate, rate):
    time = np.arange(round(rate / 4)) / rate
    for note, first in product(NOTES[1:-1], (1, 2)):
        frequency, chance = hertz(note), np.random.default_rng(1)
        partials = range(first, max(first + 2, min(12, int(0.45 * rate / frequency))))
        x = sum(
            np.sin(2.0 * np.pi * n * frequency * time + chance.uniform(0.0, 6.0)) / n
            for n in partials
        )
        noisy = x + 1e-3 * chance.standard_normal(len(time))
        assert abs(cents(estimate(noisy, rate), frequency)) < 0.5, (note, first)


@pytest.mark.parametrize("estimate", [pitch_hz, pitch_of])
def test_what_has_no_pitch_gets_none(estimate):
    assert math.isnan(estimate(np.random.default_rng(3).normal(size=13230), 44100.0))
    assert math.isnan(estimate(np.zeros(13230), 44100.0))
    assert math.isnan(estimate(np.ones(3), 44100.0))


def test_the_curve_is_the_standards():
    found = [20.0 * np.log10(a_weighting(frequency)) for frequency in A_CURVE]
    assert found == pytest.approx([*A_CURVE.values()], abs=0.1)


def test_a_sine_of_full_scale_at_a_kilohertz_is_3_db_below_and_silence_has_a_level_too():
    for rate in (44100.0, 48000.0):
        x = np.sin(2.0 * np.pi * 1000.0 * np.arange(round(rate)) / rate)
        assert a_weighted_db(x, rate) == pytest.approx(-3.01, abs=0.02)
        assert a_weighted_db(0.1 * x, rate) == pytest.approx(-23.01, abs=0.02)
    assert a_weighted_db(np.zeros(100), 44100.0) == SILENCE_DB
