"""Sine, cosine and powers against the C library's, over what the model asks."""

import math

import numpy as np
import pytest

from yehu_server.core.physics import elementary, fixed_power
from yehu_server.core.physics.elementary import (
    SERIES_BELOW,
    kernel_exp2,
    kernel_sincospi,
    one_minus_inverse_root,
)
from yehu_server.core.physics.fixed_power import INTERVALS, TABLES, power, prepare_power

# The error of a polynomial, and half a unit for each rounding of its last sums and products;
# processors that fuse multiply and add have fewer. The C library rounds too.
ROUNDING = 1e-15


def test_sine_and_cosine_are_the_c_librarys_for_a_quarter_turn_to_either_side():
    half_turns = np.linspace(-0.5, 0.5, 20_001)
    found = np.array([kernel_sincospi(x) for x in half_turns])
    assert np.abs(found[:, 0] - np.sin(math.pi * half_turns)).max() <= ROUNDING
    assert np.abs(found[:, 1] - np.cos(math.pi * half_turns)).max() <= 3e-15


def test_powers_of_two_are_the_c_librarys():
    x = np.concatenate([np.linspace(-890.0, 890.0, 10_001), np.linspace(-1.0, 1.0, 10_001)])
    found = np.array([kernel_exp2(value) for value in x])
    assert np.abs(found / np.exp2(x) - 1.0).max() <= ROUNDING
    assert kernel_exp2(-3.0) == 0.125
    assert 0.0 < kernel_exp2(-1e9) < 1e-260  # as good as nothing
    assert math.isnan(kernel_exp2(math.nan))


def test_a_slight_argument_is_exact_as_well():
    t = 10.0 ** np.linspace(-20.0, 6.0, 20_001)
    found = np.array([one_minus_inverse_root(value) for value in t])
    root = np.sqrt(1.0 + t)
    assert np.abs(found / (t / (root * (1.0 + root))) - 1.0).max() <= ROUNDING
    assert t.min() < SERIES_BELOW < t.max()
    assert one_minus_inverse_root(0.0) == 0.0


# ---------------------------------------------------------------- of any number

ANGLES = np.linspace(-20.0, 20.0, 4001).tolist()
POSITIVE = [
    *(10.0 ** np.linspace(-200.0, 200.0, 4001)).tolist(),
    *np.linspace(0.5, 2.0, 1001).tolist(),
]
# Each with Python's own, where to compare them, and by how much they may differ: relative to the
# result, and in all.
FUNCTIONS = {
    "exp2": (lambda x: 2.0**x, np.linspace(-990.0, 990.0, 4001).tolist(), 1e-15, 0.0),
    "exp": (math.exp, np.linspace(-600.0, 600.0, 4001).tolist(), 1e-15, 0.0),
    "exp10": (lambda x: 10.0**x, np.linspace(-3.0, 3.0, 4001).tolist(), 3e-15, 0.0),
    "log": (math.log, POSITIVE, 6e-16, 0.0),
    "log2": (math.log2, POSITIVE, 8e-16, 0.0),
    "log10": (math.log10, POSITIVE, 8e-16, 0.0),
    "sin": (math.sin, ANGLES, 0.0, 4e-15),
    "cos": (math.cos, ANGLES, 0.0, 4e-15),
    "tan": (math.tan, np.linspace(-1.5, 1.5, 4001).tolist(), 1e-14, 0.0),
    "asin": (math.asin, np.linspace(-1.0, 1.0, 4001).tolist(), 8e-16, 0.0),
    "tanh": (math.tanh, ANGLES, 8e-16, 0.0),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_of_any_number_is_pythons_own(name):
    of_python, numbers, relative, absolute = FUNCTIONS[name]
    found = getattr(elementary, name)
    wrong = [
        x for x in numbers if abs(found(x) - of_python(x)) > absolute + relative * abs(of_python(x))
    ]
    assert wrong == []


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_of_any_number_has_the_same_bits_compiled_and_as_python(name):
    _, numbers, *_ = FUNCTIONS[name]
    function = getattr(elementary, name)
    assert [x for x in numbers if function(x) != function._for_python(x)] == []


def test_what_is_exact_is_exact():
    assert [elementary.log2(2.0**n) for n in range(-100, 100)] == list(range(-100, 100))
    assert [elementary.exp2(float(n)) for n in range(-100, 100)] == [
        2.0**n for n in range(-100, 100)
    ]
    assert elementary.exp2(-1e9) == 2.0**-1000
    assert (elementary.exp(0.0), elementary.log(1.0), elementary.sin(0.0)) == (1.0, 0.0, 0.0)
    assert (elementary.tanh(1e9), elementary.tanh(-1e9)) == (1.0, -1.0)
    assert elementary.power(2.0, 0.5) == pytest.approx(math.sqrt(2.0), rel=1e-15)


# ---------------------------------------------------------------- the contact law's power

# The sum of what the powers of two and of a middle are off by, and of the roundings of two products
# and a sum.
ROUNDING_OF_TABLES = 1.3e-15


def tables(factor, exponent):
    """The tables of one power."""
    made = np.zeros(1, TABLES)
    prepare_power(made[0], factor, exponent)
    return made[0]


def test_tables_are_made_once_for_an_exponent(monkeypatch):
    tables(3.0, 0.7)
    monkeypatch.setattr(fixed_power, "elementwise", None)
    tables(1.0, 0.7)


@pytest.mark.parametrize("exponent", [0.0005, 0.5, 0.65, 1.0, 1.37, 2.0])
def test_a_power_is_the_c_librarys_over_all_magnitudes(exponent):
    of = tables(3.0, exponent)
    x = np.concatenate([10.0 ** np.linspace(-100.0, 20.0, 20_001), np.linspace(1e-6, 1e-2, 5001)])
    found = np.array([power(of, value) for value in x])
    wanted = 3.0 * x.astype(np.longdouble) ** np.longdouble(exponent)
    assert np.abs(found / wanted - 1.0).max() <= ROUNDING_OF_TABLES
    # It has no steps where tables change hands, ...
    for twos in (-40, -12, -1, 0):
        border = 2.0**twos * (1.0 + np.arange(INTERVALS) / INTERVALS)
        before = np.array([power(of, np.nextafter(x, 0.0)) for x in border])
        after = np.array([power(of, x) for x in border])
        assert np.abs(after / before - 1.0).max() <= 2.0 * ROUNDING_OF_TABLES
    # ... and is a number for whatever size.
    of = tables(1.0, exponent)
    found = [power(of, x) for x in (5e-324, 1e-310, 1e-200, 1e200, 1.7e308)]
    assert np.all(np.isfinite(found))
    assert 0.0 < min(found[:3]) <= max(found[:3]) < 1.0 < min(found[3:])
