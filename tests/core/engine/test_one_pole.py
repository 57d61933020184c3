"""The one-pole low-pass filter."""

import math

import numpy as np
import pytest

from yehu_server.core.controls.ramps import one_pole, pole_of_cutoff, pole_of_time

RATE = 48000.0


def filtered(x: np.ndarray, a: float) -> np.ndarray:
    y, out = 0.0, np.zeros(len(x))
    for n, now in enumerate(x):
        out[n] = y = one_pole(y, now, a)
    return out


@pytest.mark.parametrize("seconds", [1e-4, 0.01, 0.1])
def test_what_is_left_of_a_step_decays_by_its_time_constant(seconds):
    frames = 2000
    left = 1.0 - filtered(np.ones(frames), 1.0 - pole_of_time(seconds, RATE))
    expected = np.exp(-np.arange(1, frames + 1) / (seconds * RATE))
    np.testing.assert_allclose(left, expected, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("cutoff", [20.0, 200.0, 1000.0])
def test_a_tone_at_the_cutoff_loses_three_decibels(cutoff):
    time = np.arange(round(10.0 * RATE / cutoff)) / RATE
    tone = np.sin(2.0 * math.pi * cutoff * time)
    heard = filtered(tone, 1.0 - pole_of_cutoff(cutoff, RATE))[len(time) // 2 :]
    assert np.abs(heard).max() == pytest.approx(math.sqrt(0.5), rel=0.01)
