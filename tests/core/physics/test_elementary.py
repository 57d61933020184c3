"""Sine, cosine and powers of two against the C library's, over what the model asks."""

import math

import numpy as np

from yehu_server.core.physics.elementary import (
    SLIGHT,
    one_minus_inverse_root,
    power_of_2,
    sine_and_cosine,
)

# The error of a polynomial, and half a unit for each rounding of its last sums and products;
# processors that fuse multiply and add have fewer. The C library rounds too.
ROUNDING = 1e-15


def test_sine_and_cosine_are_the_c_librarys_for_a_quarter_turn_to_either_side():
    half_turns = np.linspace(-0.5, 0.5, 20_001)
    found = np.array([sine_and_cosine(x) for x in half_turns])
    assert np.abs(found[:, 0] - np.sin(math.pi * half_turns)).max() <= ROUNDING
    assert np.abs(found[:, 1] - np.cos(math.pi * half_turns)).max() <= 3e-15


def test_powers_of_two_are_the_c_librarys():
    x = np.concatenate([np.linspace(-890.0, 890.0, 10_001), np.linspace(-1.0, 1.0, 10_001)])
    found = np.array([power_of_2(value) for value in x])
    assert np.abs(found / np.exp2(x) - 1.0).max() <= ROUNDING
    assert power_of_2(-3.0) == 0.125


def test_a_slight_argument_is_exact_as_well():
    t = 10.0 ** np.linspace(-20.0, 6.0, 20_001)
    found = np.array([one_minus_inverse_root(value) for value in t])
    root = np.sqrt(1.0 + t)
    assert np.abs(found / (t / (root * (1.0 + root))) - 1.0).max() <= ROUNDING
    assert t.min() < SLIGHT < t.max()
    assert one_minus_inverse_root(0.0) == 0.0


def test_what_is_far_below_is_as_good_as_nothing():
    assert 0.0 < power_of_2(-1e9) < 1e-260
    assert math.isnan(power_of_2(math.nan))
