"""Wide hair, torsion, other friction: the energy ledger, and the plain motion at no width."""

import numpy as np
import pytest
from core.physics.runs import play
from core.physics.test_energy import balanced, performance

from yehu_server.core.physics.quantities import Quantities, override

YEHU = Quantities()
WIDE = {"bow": {"width": 0.008}}
KINDS = {
    "torsion": {"torsion": "on"},
    "width": WIDE,
    "both": WIDE | {"torsion": "on"},
    "hyperbolic": {"bow": {"friction": "hyperbolic"}},
    "both, viscous": {"torsion": "on", "bow": {"width": 0.008, "epsilon_2": 0.4}},
    "both, thermal": {
        "torsion": "on",
        "bow": {"width": 0.008, "points": 3, "friction": "thermal"},
    },
}


def jumps(t):
    """Bow and fingers lifted, put down and moved from one sample to the next, on shared nodes."""

    def steps(each, values):
        return np.resize(values, int(t[-1] / each) + 1)[(t / each).astype(int)]

    return {
        "F_N": steps(0.031, [0.7, 0.0, -0.5, 2.0, -0.7, 0.0]),
        "v_b": steps(0.047, [0.3, -0.2, 0.1, 0.6]),
        "x_b": steps(0.053, [0.255, 0.29, 0.2]),
        "x_f": [steps(0.041, [0.05, 0.25, 0.19]), steps(0.037, [0.06, 0.26])],
        "press": [steps(0.023, [0.0, 2.0, 5.0]), steps(0.059, [1.0, 0.0])],
    }


@pytest.mark.parametrize("rate", [44100.0, 88200.0, 352800.0])
@pytest.mark.parametrize("kind", KINDS)
def test_the_ledger_closes_with_torsion_width_and_other_friction(kind, rate):
    quantities = override(YEHU, KINDS[kind])
    seconds = 0.4 if rate < 1e5 else 0.1
    for curves, fingers in ((performance, 1), (jumps, 2)):
        run = play(curves, seconds, rate, quantities=quantities, fingers=fingers)
        balanced(run)
        assert run["loss_friction"].max() > 1e-3
        assert np.abs(run["f_b"]).max() > 0.1


@pytest.mark.parametrize("points", [2, 4])
def test_hair_of_no_width_moves_the_string_as_one_point_does(points):
    def curves(t):
        return {"F_N": 0.5, "v_b": 0.2, "x_f": [np.full(len(t), 0.1)], "press": [1.5]}

    narrow = override(YEHU, {"bow": {"width": 1e-12, "points": points}})
    one, many = play(curves, 0.012), play(curves, 0.012, quantities=narrow)
    for name in ("bridge_force", "f_b", "v_r", "pressure", "energy", "loss_hair", "loss_friction"):
        np.testing.assert_allclose(many[name], one[name], atol=1e-8 * np.abs(one[name]).max())


def test_each_strip_of_wide_hair_slips_by_itself():
    """While the middle sticks, the string turns about it: ends of wide hair cannot all stick."""
    wide = override(YEHU, {"bow": {"width": 0.02, "points": 4}})
    run = play({"F_N": 0.5, "v_b": 0.2}, 0.3, quantities=wide)
    assert np.ptp(run.refined["v_r"][0]) > 1e-4
    assert np.ptp(run.refined["z"][0, :, 0]) > 1e-7


def test_a_light_bow_that_always_slips_feels_the_law_of_the_whole_hair():
    bow = YEHU.bow
    mu = bow.mu_C + (bow.mu_S - bow.mu_C) * np.exp(-((1.0 / bow.v_s) ** 2))
    wide = override(YEHU, KINDS["both"])
    run = play({"F_N": 0.01, "v_b": 1.0}, 0.05, quantities=wide)
    assert np.abs(run["f_b"][-100:]).mean() == pytest.approx(0.01 * mu, rel=0.02)
