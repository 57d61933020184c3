"""Loudness: the A curve and levels of known sounds."""

from __future__ import annotations

import numpy as np
import pytest

from yehu_server.playing.pitch_and_level import SILENCE_DB, a_weighted_db, a_weighting

# dB, from the table of IEC 61672-1.
TABLE = {31.62: -39.4, 63.1: -26.2, 125.9: -16.1, 251.2: -8.6, 501.2: -3.2, 1000: 0.0, 1995: 1.2,
         3981: 1.0, 7943: -1.1, 15849: -6.6}  # fmt: skip


@pytest.mark.parametrize(("frequency", "decibels"), TABLE.items())
def test_the_curve_is_the_standards(frequency, decibels):
    assert 20.0 * np.log10(a_weighting(frequency)) == pytest.approx(decibels, abs=0.1)


@pytest.mark.parametrize("rate", [44100.0, 48000.0])
def test_a_sine_of_full_scale_at_a_kilohertz_is_3_db_below(rate):
    x = np.sin(2.0 * np.pi * 1000.0 * np.arange(round(rate)) / rate)
    assert a_weighted_db(x, rate) == pytest.approx(-3.01, abs=0.02)
    assert a_weighted_db(0.1 * x, rate) == pytest.approx(-23.01, abs=0.02)


def test_silence_has_a_level_too():
    assert a_weighted_db(np.zeros(100), 44100.0) == SILENCE_DB
