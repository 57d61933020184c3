"""Torsion: its modes, what the bow's force does to it, and the finger's drag."""

import numpy as np
import pytest
from core.physics.runs import play

from yehu_server.core.physics import kernel, layout, refined, time_loop
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.torsion import place_twist
from yehu_server.errors import ParameterError

YEHU = Quantities()
TWISTED = override(YEHU, {"torsion": "on"})
RATES = (44100.0, 352800.0)


def modes(string, rate):
    """Angular frequencies and decay rates (1/s) of the modes that a rate has, and their mass."""
    s = TWISTED.strings[string]
    omega = np.pi * np.arange(1, 17) / TWISTED.bridge_x * np.sqrt(s.G / s.rho)
    omega = omega[omega < 0.9 * np.pi * rate]
    return omega, omega / (2.0 * s.Q_t), s.rho_A / 2.0 * TWISTED.bridge_x / 2.0


def advanced(model, more, frames):
    """Let frames pass in which nothing touches the strings; the level that is now."""
    rows = np.zeros((frames, layout.control_columns(1)))
    rows[:, layout.X_B] = 0.255
    state = kernel.at_rest(model)
    time_loop.run(model, state, more, rows, np.zeros((frames, layout.probe_columns(1))))
    return int(state["motion"]["level"][0])


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("string", [0, 1], ids=["F4", "C5"])
def test_torsional_modes_ring_at_their_frequencies_and_decay_by_their_quality(string, rate):
    omega, sigma, _ = modes(string, rate)
    damped = np.sqrt(omega**2 - sigma**2)
    k, frames = 1.0 / rate, round(0.003 * rate)

    def free(time):
        return 1e-5 * np.exp(-sigma * time) * np.cos(damped * time)

    model, more = kernel.prepare(TWISTED, rate), refined.prepare(TWISTED, rate)
    assert more["twists"][0] >= len(omega)
    twist = more["twist"][0]
    twist[2, string, : len(omega)], twist[0, string, : len(omega)] = free(-k), free(0.0)
    level = advanced(model, more, frames)
    found = more["twist"][0, level, string, : len(omega)]
    np.testing.assert_allclose(found, free(frames * k), atol=1e-14)
    assert not more["twist"][0, :, 1 - string].any()


@pytest.mark.parametrize("rate", RATES)
def test_the_surface_turns_as_the_torque_of_friction_makes_it(rate):
    """The modes are the convolution of the friction force with their responses to an impulse."""
    run = play({"F_N": 0.5, "v_b": 0.2}, 0.02, rate, quantities=TWISTED, ledger=False)
    omega, sigma, mass = modes(0, rate)
    damped = np.sqrt(omega**2 - sigma**2)
    ago = np.arange(len(run["f_b"]), 0, -1)[:, None] / rate
    response = np.exp(-sigma * ago) * np.sin(damped * ago) / (mass * damped)
    n = np.arange(1, len(omega) + 1)
    torque = -run["f_b"][:, None] / rate * np.sin(n * np.pi * 0.255 / TWISTED.bridge_x)
    level = int(run.state["motion"]["level"][0])
    found = run.refined["twist"][0, level, 0, : len(omega)]
    assert np.abs(found).max() > 1e-7
    np.testing.assert_allclose(found, (response * torque).sum(axis=0), atol=1e-9 * found.max())


def test_a_finger_that_grips_holds_the_surface():
    travel = {}
    for grip in (0.0, 1e4):
        quantities = override(TWISTED, {"finger": {"R_t": grip}})
        run = play({"F_N": 0.5, "v_b": 0.2, "press": [2.0]}, 0.2, quantities=quantities)
        level, twist = int(run.state["motion"]["level"][0]), run.refined["twist"][0, :, 0]
        change = twist[level] - twist[(level + 1) % 3]
        shapes = np.sin(np.pi * np.arange(1, 17) * 0.1 / YEHU.bridge_x)
        travel[grip] = abs(change @ shapes) / np.abs(change).max()
    assert travel[1e4] < 0.01 * travel[0.0]


def test_shapes_of_modes_follow_the_bow():
    model, more = kernel.prepare(TWISTED, 44100.0), refined.prepare(TWISTED, 44100.0)
    for x in (0.0, 0.05, 0.15, 0.3, 0.26):
        place_twist(model[0], more[0], 2, x)
        expected = np.sin(np.arange(1, 17) * np.pi * x / YEHU.bridge_x)
        np.testing.assert_allclose(more["twist_shapes"][0, 2], expected, atol=1e-13)


def test_a_stiffness_without_a_mode_at_this_rate_is_refused():
    stiff = override(TWISTED, {"string_2": {"G": 1e12}})
    with pytest.raises(ParameterError, match="string_2: G 1e\\+12 Pa puts its torsional modes"):
        refined.prepare(stiff, 44100.0)
    assert refined.prepare(YEHU, 44100.0) is None  # there is nothing to refine
