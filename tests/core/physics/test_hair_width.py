"""Wide hair, torsion, other friction: the energy ledger, and the plain motion at no width."""

from dataclasses import replace

import numpy as np
import pytest
from core.physics.runs import play
from core.physics.test_energy import balanced, performance
from hypothesis import example, given, settings
from hypothesis import strategies as st

from yehu_server.core.physics import layout
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.friction import MAX_ITERATIONS
from yehu_server.core.physics.hair_width import MAX_EVALUATIONS, release_points, solve_points

YEHU = Quantities()
BOTH = {"torsion": "on", "bow": {"width": 0.008}}
FRAMES = 10_000
BOWS = st.fixed_dictionaries(
    {
        "width": st.just(0.0) | st.floats(1e-3, 0.03),
        "points": st.integers(2, layout.MAX_POINTS),
        "friction": st.sampled_from(("elasto-plastic", "thermal")),
        "epsilon_2": st.just(0.0) | st.floats(0.0, 2.0),
    }
) | st.just({"friction": "hyperbolic"})  # which has no width
KINDS = st.fixed_dictionaries(
    {
        "torsion": st.sampled_from(("off", "on")),
        "tension_modulation": st.floats(0.0, 1.0),
        "felt_loss": st.floats(0.0, 3e3),
        "bow": BOWS,
    }
)


def of_modes(count, seed):
    """The body's radiation with modes anywhere, none undamped."""
    chance = np.random.default_rng(seed)
    hertz = np.sort(chance.uniform(150.0, 6000.0, count))
    mass = chance.uniform(0.02, 0.5, count)
    damping = mass * 2.0 * np.pi * hertz * chance.uniform(0.01, 0.05, count)
    return replace(YEHU.body, frequency_hz=tuple(hertz), mass=tuple(mass), damping=tuple(damping))


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


@settings(max_examples=2)  # beside those of test_passive.py
@given(
    kind=KINDS,
    modes=st.integers(1, layout.MAX_MODES),
    rate=st.floats(44.1e3, 352.8e3),
    seed=st.integers(0, 99),
)
@example(
    kind={"torsion": "on", "bow": {"width": 0.008, "points": 3, "friction": "thermal"}},
    modes=layout.MAX_MODES,
    rate=44.1e3,
    seed=0,
)
@example(kind=BOTH, modes=11, rate=352.8e3, seed=1)
def test_the_ledger_closes_with_torsion_width_other_friction_and_any_body(kind, modes, rate, seed):
    quantities = replace(override(YEHU, kind), body=of_modes(modes, seed))
    for curves, fingers in ((performance, 1), (jumps, 2)):
        run = play(curves, FRAMES / rate, rate, quantities=quantities, fingers=fingers)
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
    assert run.refined["offset"][0, :4] == pytest.approx([-0.0075, -0.0025, 0.0025, 0.0075])
    assert np.ptp(run.refined["v_r"][0]) > 1e-4
    assert np.ptp(run.refined["z"][0, :, 0]) > 1e-7


@pytest.fixture(name="wide")
def wide_fixture():
    """Records of wide hair that has bent bristles: model, state, points."""
    hard = override(YEHU, {"bow": {"width": 0.002, "points": 3, "epsilon_0": 1e8}})
    run = play({"F_N": 0.5, "v_b": 0.2}, 0.02, quantities=hard, ledger=False)
    return run.model[0], run.state[0], run.refined[0]


def test_a_sample_takes_a_bounded_number_of_evaluations_whatever_comes(wide):
    model, state, points = wide
    points["free"][:3] = 1e4, -1e4, 5e3  # m/s, of which TOLERANCE is less than rounding
    most = MAX_EVALUATIONS + 2 * 3 * MAX_ITERATIONS
    assert MAX_EVALUATIONS <= solve_points(model, state, points, 0, 0.5) < most
    assert state["unconverged"] == 1


def test_forces_that_are_not_solved_are_let_go_where_they_would_give_energy(wide):
    model, state, points = wide
    before, bristles = points["f_b"].copy(), points["z"][:3, 0].copy()
    for more, is_let_go in ((1e-3, False), (-1e-3, True)):
        points["free"][:3] = points["v_r"][:3] + points["mobility"][:3, :3] @ before[:3]
        points["free"][:3] += more * np.sign(before[:3])
        state["work"]["dropped_z"] = 0.0
        release_points(model, points, state["work"], 0)
        assert points["f_b"].any() != is_let_go
        energy = (0.5 * points["share"] * model["epsilon_0"] * bristles**2).sum()
        assert state["work"]["dropped_z"] == pytest.approx(energy if is_let_go else 0.0)
    np.testing.assert_array_equal(points["v_r"][:3], points["free"][:3])
