"""Sine, cosine, exponential and power against the C library's, over what the model asks."""

import math

import numpy as np

from yehu_server.physics.elementary import (
    SLIGHT,
    exponential,
    logarithm,
    power,
    power_of_2,
    sine_and_cosine,
    slowing,
)


def test_sine_and_cosine_are_the_c_librarys_for_a_quarter_turn_to_either_side():
    half_turns = np.linspace(-0.5, 0.5, 20_001)
    found = np.array([sine_and_cosine(x) for x in half_turns])
    assert np.abs(found[:, 0] - np.sin(math.pi * half_turns)).max() <= 7e-16
    assert np.abs(found[:, 1] - np.cos(math.pi * half_turns)).max() <= 3e-15


def test_powers_of_two_are_the_c_librarys():
    x = np.concatenate([np.linspace(-890.0, 890.0, 10_001), np.linspace(-1.0, 1.0, 10_001)])
    found = np.array([power_of_2(value) for value in x])
    assert np.abs(found / np.exp2(x) - 1.0).max() <= 7e-16
    assert power_of_2(-3.0) == 0.125


def test_a_slight_slowing_is_exact_as_well():
    t = 10.0 ** np.linspace(-20.0, 6.0, 20_001)
    found = np.array([slowing(value) for value in t])
    root = np.sqrt(1.0 + t)
    assert np.abs(found / (t / (root * (1.0 + root))) - 1.0).max() <= 1e-15
    assert t.min() < SLIGHT < t.max()
    assert slowing(0.0) == 0.0


def test_the_exponential_is_the_c_librarys():
    x = np.concatenate([np.linspace(-700.0, 700.0, 10_001), np.linspace(-1.0, 1.0, 10_001)])
    found = np.array([exponential(value) for value in x])
    # What it is off by is what rounding makes of so large an exponent.
    assert np.abs(found / np.exp(x) - 1.0)[np.abs(x) <= 40.0].max() <= 2e-15
    assert np.abs(found / np.exp(x) - 1.0).max() <= 3e-14


def test_what_is_far_below_is_as_good_as_nothing():
    assert 0.0 < exponential(-1e9) < 1e-300
    assert 0.0 < power_of_2(-1e9) < 1e-260
    assert math.isnan(exponential(math.nan))
    assert math.isnan(power_of_2(math.nan))


def test_logarithm_and_power_are_the_c_librarys():
    x = 10.0 ** np.linspace(-300.0, 300.0, 20_001)
    logs = np.array([logarithm(value) for value in x])
    assert np.all(np.abs(logs - np.log(x)) <= 4e-16 * np.maximum(1.0, np.abs(np.log(x))))
    x = 10.0 ** np.linspace(-20.0, 0.0, 20_001)
    for exponent in (0.5, 0.65, 1.0, 2.0):
        found = np.array([power(value, exponent) for value in x])
        assert np.abs(found / x**exponent - 1.0).max() <= 3e-14


def test_a_penetration_too_small_to_matter_has_a_power_that_is_a_number():
    assert 0.0 < power(5e-324, 0.65) < 1e-150
