"""The contact law's power, by tables, against the C library's."""

import numpy as np
import pytest

from yehu_server.core.physics.power import INTERVALS, TABLES, power, prepare_power

# The sum of at most seven roundings of 2^-53: four in the powers of two, one each in the power of a
# middle, in the product of these and in the sum. How many have the same sign depends on the
# processor: 5.5e-16 with fused multiply-adds, 6.01e-16 without.
ROUNDING = 8e-16

exponents = pytest.mark.parametrize("exponent", [0.0005, 0.5, 0.65, 1.0, 1.37, 2.0])


def tables(factor, exponent):
    """The tables of one power."""
    made = np.zeros(1, TABLES)
    prepare_power(made[0], factor, exponent)
    return made[0]


@exponents
def test_a_power_is_the_c_librarys_over_all_magnitudes(exponent):
    of = tables(3.0, exponent)
    x = np.concatenate([10.0 ** np.linspace(-100.0, 20.0, 20_001), np.linspace(1e-6, 1e-2, 5001)])
    found = np.array([power(of, value) for value in x])
    wanted = 3.0 * x.astype(np.longdouble) ** np.longdouble(exponent)
    assert np.abs(found / wanted - 1.0).max() <= ROUNDING


@exponents
def test_a_power_has_no_steps_where_tables_change_hands(exponent):
    of = tables(1.0, exponent)
    for twos in (-40, -12, -1, 0):
        border = 2.0**twos * (1.0 + np.arange(INTERVALS) / INTERVALS)
        before = np.array([power(of, np.nextafter(x, 0.0)) for x in border])
        after = np.array([power(of, x) for x in border])
        assert np.abs(after / before - 1.0).max() <= 2.0 * ROUNDING


def test_a_deeper_penetration_has_a_higher_power():
    of = tables(900.0, 0.65)
    found = np.array([power(of, x) for x in 10.0 ** np.linspace(-30.0, 2.0, 50_001)])
    assert np.all(np.diff(found) > 0.0)


@exponents
def test_a_penetration_of_whatever_size_has_a_power_that_is_a_number(exponent):
    of = tables(1.0, exponent)
    sizes = (5e-324, 1e-310, 1e-200, 1e200, 1.7e308)
    found = [power(of, x) for x in sizes]
    assert np.all(np.isfinite(found))
    assert 0.0 < min(found[:3]) <= max(found[:3]) < 1.0 < min(found[3:])
