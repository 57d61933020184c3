"""The friction solver alone, on any problem that a step may pose."""

import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from core.physics.runs import play

from yehu_server.core.physics import kernel
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.friction import MAX_ITERATIONS, solve_friction

YEHU = Quantities()
BOW = YEHU.bow
RATE = 44100.0
NO_TANGENT = (0.0, 0.0, 0.0)


def elastoplastic_law(v_r, z_bar, F_N, string, bow):
    """dz/dt of [Yehu] eqs. (16)-(20), a second time and with signs as printed."""
    z_ss = math.copysign(1.0, v_r) * F_N / bow.epsilon_0
    z_ss *= bow.mu_C + (bow.mu_S - bow.mu_C) * math.exp(-(abs(v_r / bow.v_s) ** 2))
    z_ba = bow.xi[string] * bow.mu_C * F_N / bow.epsilon_0
    if v_r * z_bar <= 0.0 or abs(z_bar) <= z_ba:
        chi = 0.0
    elif abs(z_bar) >= abs(z_ss):
        chi = 1.0
    else:
        middle = 0.5 * (abs(z_ss) + z_ba)
        chi = 0.5 * (1.0 + math.sin(math.pi * (abs(z_bar) - middle) / (abs(z_ss) - z_ba)))
    return v_r * (1.0 - chi * z_bar / z_ss)


def damping(v_r, F_N, bow):
    """epsilon_1 of eq. (25)."""
    gamma = bow.mu_C * F_N / bow.epsilon_1
    return bow.mu_C * F_N / math.sqrt(v_r**2 + gamma**2)


def problems(count, seed, fastest=10.0):
    """free (m/s), mobility (m/s/N), z (m), F_N (N), tangent, string.

    A gesture's bow moves at 10 m/s at most; z may be left far above z_ss by a dropped force.
    """
    rng = np.random.default_rng(seed)
    for _ in range(count):
        F_N = 10.0 ** rng.uniform(-3.0, math.log10(5.0))
        free = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-6.0, math.log10(fastest))
        mobility = 10.0 ** rng.uniform(-1.0, math.log10(4.5))
        z_static = BOW.mu_S * F_N / BOW.epsilon_0
        z = z_static * rng.uniform(-1.0, 1.0) * rng.choice([1.0, 1.0, 1.0, 30.0])
        # The tangent of a law at another speed and bow force.
        tangent = rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), -(10.0 ** rng.uniform(0.0, 6.0))
        yield free, mobility, z, F_N, tangent, int(rng.integers(2))


CASES = {
    "measured rosin": (YEHU, RATE),
    "bristles ten times stiffer": (replace(YEHU, bow=replace(BOW, epsilon_0=3.186e5)), RATE),
    "22.05 kHz": (YEHU, 22050.0),
    "192 kHz": (YEHU, 192000.0),
}


@pytest.mark.parametrize("case", CASES, ids=lambda name: name.replace(" ", "-"))
def test_every_random_problem_is_solved(case):
    """(49) in m/s, and (52)'s second row in m/s; the law from this file."""
    quantities, rate = CASES[case]
    bow, model = quantities.bow, kernel.prepare(quantities, rate)[0]
    all_converged = []
    for free, mobility, z, F_N, tangent, string in problems(3000, seed=13):
        f_b, z_bar, v_r, _, iterations, converged = solve_friction(
            free, mobility, z, F_N, BOW.mu_S, tangent, model, string
        )
        assert all(math.isfinite(value) for value in (f_b, z_bar, v_r))
        assert iterations <= MAX_ITERATIONS
        r = 2.0 * (z_bar - z) * rate
        scale = max(1.0, abs(v_r), abs(r), abs(free))
        force = bow.epsilon_0 * z_bar + damping(v_r, F_N, bow) * r
        assert abs(f_b - force) <= 1e-12 * max(1.0, abs(force))
        assert abs(free - mobility * f_b - v_r) <= 1e-11 * scale
        all_converged.append(converged)
        if converged:
            law = elastoplastic_law(v_r, z_bar, F_N, string, bow)
            assert abs(law - r) <= 1e-9 * scale
            # Friction takes energy and never gives any, eq. (56e).
            work, stored = f_b * v_r, bow.epsilon_0 * z_bar * r
            assert work - stored >= -1e-9 * max(abs(work), abs(stored), 1e-3)
    assert np.mean(all_converged) > 0.999


def test_what_a_last_step_leaves_is_as_small_as_the_docstring_says():
    """2e-13 m/s, though the law is not worked out again after it: over steady bowing."""
    model = kernel.prepare(YEHU, RATE)[0]
    rng = np.random.default_rng(17)
    for string, F_N in ((0, 0.05), (0, 0.7), (1, 3.0)):
        z, tangent, sides = 0.0, NO_TANGENT, Counter()
        for n in range(4000):
            # A string that sticks and slips, with noise for its corners.
            free = 1.2 * F_N * math.cos(0.02 * n) ** 3 + 0.02 * rng.normal()
            _, z_bar, v_r, tangent, _, converged = solve_friction(
                free, 1.2, z, F_N, BOW.mu_S, tangent, model, string
            )
            r = 2.0 * RATE * (z_bar - z)
            law = elastoplastic_law(v_r, z_bar, F_N, string, BOW)
            sides["holds" if law == v_r else "gives"] += 1
            assert converged
            # Rounding of r itself: z is as large as mu_S F_N / epsilon_0.
            assert abs(law - r) <= 2.5e-13 + 4e-16 * 2.0 * RATE * abs(z_bar)
            z = 2.0 * z_bar - z
        assert min(sides["holds"], sides["gives"]) > 400


def test_at_absurd_speeds_the_answer_stays_finite_and_within_coulombs_law():
    """Up to 1 km/s. Rounding of free - v_r then hides the bristles: `converged` may be false."""
    model = kernel.prepare(YEHU, RATE)[0]
    for free, mobility, z, F_N, tangent, string in problems(2000, seed=16, fastest=1000.0):
        within = min(abs(z), BOW.mu_S * F_N / BOW.epsilon_0)
        answer = solve_friction(free, mobility, within, F_N, BOW.mu_S, tangent, model, string)
        f_b, _, v_r, _, iterations, _ = answer
        assert math.isfinite(f_b)
        assert math.isfinite(v_r)
        assert iterations < MAX_ITERATIONS
        assert abs(free - mobility * f_b - v_r) <= 1e-12 * max(1.0, abs(free))
        # epsilon_1 |v_r| <= mu_C F_N, eq. (25), so friction is below twice the static one.
        assert abs(f_b) <= 2.0 * BOW.mu_S * F_N * (1.0 + 1e-6)


@pytest.mark.parametrize(
    ("rate", "A"), [(44100.0, A) for A in (0.5, 1.0, 1.5, 2.0)] + [(22050.0, 1.0)]
)
def test_three_seconds_of_alternating_bow_force_stay_finite_and_converge(rate, A):
    """The case in which the paper's two-by-two Newton iteration blows up."""

    def alternating(t):
        turn = 2.0 * np.pi * t
        v_b = 0.5 * np.sin(1.3 * turn) * np.cos(7.0 * turn)
        return {"F_N": A * np.sin(2.1 * turn), "v_b": v_b}

    run = play(alternating, 3.0, rate)
    assert np.isfinite(run.probes).all()
    assert run.state["lost"][0] == 0
    assert run.state["unconverged"][0] == 0
    assert run["iterations"].max() < MAX_ITERATIONS
    assert np.abs(run["energy_error"]).max() <= 1e-9 * run.power
    assert run["v_r_residual"].max() <= 1e-9
    assert np.abs(run["bridge_force"]).max() < 10.0  # twice 2 N of friction, and room
