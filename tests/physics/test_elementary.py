"""Sine, cosine and exponential against the C library's, over what the model asks."""

import math

import numpy as np

from yehu_server.physics.elementary import exponential, sine_and_cosine


def test_sine_and_cosine_are_the_c_librarys_for_a_quarter_turn_to_either_side():
    angles = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 20_001)
    found = np.array([sine_and_cosine(angle) for angle in angles])
    assert np.abs(found[:, 0] - np.sin(angles)).max() <= 7e-16
    assert np.abs(found[:, 1] - np.cos(angles)).max() <= 7e-16


def test_the_exponential_is_the_c_librarys():
    x = np.concatenate([np.linspace(-700.0, 700.0, 10_001), np.linspace(-1.0, 1.0, 10_001)])
    found = np.array([exponential(value) for value in x])
    # What it is off by is what rounding makes of so large an exponent.
    assert np.abs(found / np.exp(x) - 1.0)[np.abs(x) <= 40.0].max() <= 2e-15
    assert np.abs(found / np.exp(x) - 1.0).max() <= 3e-14


def test_what_is_far_below_is_as_good_as_nothing():
    assert 0.0 < exponential(-1e9) < 1e-300
    assert math.isnan(exponential(math.nan))
