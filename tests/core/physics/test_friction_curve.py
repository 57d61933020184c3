"""Friction by a curve, and viscous friction: the law, its hysteresis, and what the bow feels."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from core.physics.runs import play

from yehu_server.core.physics import refined
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.friction_curve import solve_curve
from yehu_server.errors import ParameterError

YEHU = Quantities()
BOW = YEHU.bow
CURVE = {"bow": {"friction": "hyperbolic"}}
LAW = SimpleNamespace(mu_S=BOW.mu_S, mu_C=BOW.mu_C, v_s=BOW.v_s)
F_N, MOBILITY = 1.5, 2.0  # N, m/s/N: mobility F_N (mu_S - mu_C) is 6.8 v_s, so that it is ambiguous


def coefficient(v_r):
    """Of a string that slips."""
    return BOW.mu_C + (BOW.mu_S - BOW.mu_C) * BOW.v_s / (BOW.v_s + np.abs(v_r))


def pulled(velocities):
    """Relative velocities as the free velocity goes through some, from rest; the law is checked."""
    v_r, found = 0.0, []
    for free in velocities:
        f_b, v_r = solve_curve.py_func(free, MOBILITY, F_N, v_r, LAW)
        assert v_r == pytest.approx(free - MOBILITY * f_b, abs=1e-12)
        if v_r == 0.0:
            assert abs(f_b) <= BOW.mu_S * F_N * (1.0 + 1e-12)
        else:
            assert f_b == pytest.approx(math.copysign(F_N * coefficient(v_r), v_r), rel=1e-9)
        found.append(v_r)
    return np.array(found)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_string_sticks_up_to_static_friction_and_slips_until_no_slip_is_left(side):
    """It lets go at mobility mu_S F_N, and is caught where the line leaves the curve."""
    up = np.linspace(0.0, 5.0, 5001)
    slips = np.abs(pulled(side * np.concatenate([up, up[::-1]])))
    lets_go = up[(slips[:5001] > 0.0).argmax()]
    caught = up[::-1][(slips[5001:] == 0.0).argmax()]
    step = MOBILITY * F_N * (BOW.mu_S - BOW.mu_C)
    assert lets_go == pytest.approx(MOBILITY * F_N * BOW.mu_S, abs=2e-3)
    below = 2.0 * math.sqrt(step * BOW.v_s) - BOW.v_s
    assert caught == pytest.approx(MOBILITY * F_N * BOW.mu_C + below, abs=2e-3)


def test_a_bowed_string_sticks_without_giving_way_and_slips_along_the_curve():
    run = play({"F_N": 0.5, "v_b": 0.2}, 0.3, quantities=override(YEHU, CURVE))
    v_r, f_b = run["v_r"], run["f_b"]
    slips = v_r != 0.0
    assert 0.05 < slips[-4410:].mean() < 0.5
    assert np.abs(f_b[~slips]).max() <= 0.5 * BOW.mu_S * (1.0 + 1e-12)
    np.testing.assert_allclose(
        f_b[slips], 0.5 * np.sign(v_r)[slips] * coefficient(v_r[slips]), rtol=1e-9
    )
    assert int(run.state["unconverged"][0]) == 0


@pytest.mark.parametrize("v_b", [0.5, 1.0])
def test_a_light_bow_that_always_slips_feels_the_curve_and_viscous_friction(v_b):
    stribeck = BOW.mu_C + (BOW.mu_S - BOW.mu_C) * math.exp(-((v_b / BOW.v_s) ** 2))
    for law, mu in ((CURVE, coefficient(v_b)), ({}, stribeck)):
        bow = dict(law.get("bow", {}), epsilon_2=0.004)
        run = play({"F_N": 0.01, "v_b": v_b}, 0.05, quantities=override(YEHU, {"bow": bow}))
        expected = 0.01 * mu + 0.004 * v_b
        assert np.abs(run["f_b"][-100:]).mean() == pytest.approx(expected, rel=0.03)


def test_hair_of_some_width_has_no_friction_by_a_curve():
    wide = override(YEHU, {"bow": {"friction": "hyperbolic", "width": 0.008}})
    with pytest.raises(ParameterError, match="hyperbolic is for hair of no width"):
        refined.prepare(wide, 44100.0)
