"""Schelleng's limits of the bow force."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest

from yehu_server.core.physics import kernel
from yehu_server.core.physics.default_quantities import Quantities, override
from yehu_server.core.physics.layout import MAX_FINGERS
from yehu_server.core.physics.schelleng import (
    PARTIALS,
    bridge_conductance,
    finger_conductance,
    lower_limit,
    resistance,
    upper_limit,
)
from yehu_server.scores.gesture import gesture_from
from yehu_server.simulation.run import simulate

YEHU = Quantities()


def admittance(f):
    """Of the bridge (s/kg), in continuous time."""
    body, w = YEHU.body, 2.0 * math.pi * f
    return sum(
        1j * w / (mass * (w_m**2 - w**2) + 1j * w * damping)
        for mass, damping, w_m in zip(body.mass, body.damping, body.omega, strict=True)
    )


@pytest.mark.parametrize("f", [349.2, 440.0, 850.0, 1396.9])
def test_the_bridges_conductance_is_that_of_its_modes_but_for_the_scheme(f):
    model = kernel.prepare(YEHU, 48000.0, MAX_FINGERS)[0]
    assert bridge_conductance(model, f) == pytest.approx(admittance(f).real, rel=0.02)


@pytest.mark.parametrize(("f", "x_f", "press"), [(466.0, 0.07, 1.5), (800.0, 0.15, 4.0)])
def test_the_fingers_conductance_is_that_of_its_circuit(f, x_f, press):
    """Dashpot, mass and other string in series, and the string behind, in complex numbers."""
    model, w = kernel.prepare(YEHU, 48000.0)[0], 2.0 * math.pi * f
    Z, other = (math.sqrt(string.T * string.rho_A) for string in YEHU.strings)
    c = math.sqrt(YEHU.string_1.T / YEHU.string_1.rho_A)
    dashpot = YEHU.finger.beta * press / 2.0
    behind_it = 1j * w * YEHU.finger.M_f + 1.0 / (1.0 / dashpot + 0.5 / other)
    finger = 1.0 / (1.0 / dashpot + 1.0 / behind_it)
    seen = 1.0 / (finger - 1j * Z / cmath.tan(w * x_f / c))
    assert finger_conductance(model, 0, f, x_f, press) == pytest.approx(seen.real, rel=1e-9)


def test_a_bridge_of_one_resistance_has_that_one():
    mode = {"frequency_hz": (1000.0,), "mass": (2e-5,), "damping": (25.0,)}
    lossless = {"sigma_0": 0.0, "sigma_1": 0.0}
    quantities = override(YEHU, {"string_1": lossless, "string_2": lossless})
    model = kernel.prepare(replace(quantities, body=replace(YEHU.body, **mode)), 48000.0)[0]
    assert resistance(model, 0, 400.0, 0.0, 0.0) == pytest.approx(25.0, rel=1e-3)


def test_the_resistance_is_woodhouses_sum_over_partials():
    model, f = kernel.prepare(YEHU, 192000.0)[0], 349.2
    n, string = np.arange(1, PARTIALS + 1), YEHU.string_1
    Z = math.sqrt(string.T * string.rho_A)
    own = (string.sigma_0 + string.sigma_1 * (n * math.pi / YEHU.bridge_x) ** 2) / (2.0 * f * Z)
    shares = (np.array([admittance(f * each).real for each in n]) + own) / n**2
    turns = np.cos(2.0 * math.pi * np.outer(np.linspace(0.0, 0.5, 500), n))
    most = (shares.sum() - turns @ shares).max()
    pure = ((1.0 - turns[-1]) / n**2).sum()
    assert resistance(model, 0, f, 0.0, 0.0) == pytest.approx(pure / most, rel=0.01)


@pytest.mark.parametrize(
    ("string", "x_f", "press", "off"),
    [(2, 0.0, 0.0, 0.1), (1, 0.0715, 1.5, 0.25), (2, 0.0345, 1.5, 0.1), (2, 0.1, 1.5, 0.1)],
)
def test_a_plucked_note_decays_as_bridge_finger_and_string_say(string, x_f, press, off):
    """What takes energy in Helmholtz motion does so from a free note: alpha = 2 f Z Re(Y)."""
    own, i = YEHU.strings[string - 1], string - 1
    stop = {"finger_position": x_f, "press_force": press} if press else {}
    force = 0.5 if string == 1 else -0.5
    curve = [[0, 0.0], [0.2, force], [0.25, force], [0.2501, 0.0]]
    controls = {"pluck_force": curve, "pluck_position": 0.2, **stop}
    run = simulate(gesture_from({"duration": 0.6, "controls": controls})).arrays
    signal = run[f"bridge_force_{string}"][12000:]
    time = np.arange(len(signal)) / 44100.0
    guess = math.sqrt(own.T / own.rho_A) / (2.0 * (YEHU.bridge_x - x_f))
    near = np.linspace(0.95, 1.05, 401) * guess
    window = np.hanning(len(signal))
    levels = np.abs(
        np.exp(-2j * np.pi * np.outer(near, time)) @ (window * (signal - signal.mean()))
    )
    f = near[levels.argmax()]
    size = round(44100.0 / f * 8)
    turned = (signal - signal.mean()) * np.exp(-2j * np.pi * f * time)
    starts = np.arange(0, 3000, 300)
    sizes = [abs((turned[at : at + size] * np.hanning(size)).sum()) for at in starts]
    decay = -np.polyfit(starts / 44100.0, np.log(sizes), 1)[0]
    model, Z = kernel.prepare(YEHU, 44100.0)[0], math.sqrt(own.T * own.rho_A)
    Y = bridge_conductance(model, f) + (
        finger_conductance(model, i, f, x_f, press) if press else 0.0
    )
    losses = own.sigma_0 + own.sigma_1 * (math.pi / (YEHU.bridge_x - x_f)) ** 2
    assert decay == pytest.approx(2.0 * f * Z * Y + losses, rel=off)


def test_both_limits_grow_with_speed_and_meet_near_the_bridge():
    Z, grip, R, v_b = 0.2, 0.4, 5.0, 0.2
    assert upper_limit(Z, grip, 2 * v_b, 0.1) == pytest.approx(2 * upper_limit(Z, grip, v_b, 0.1))
    assert lower_limit(Z, grip, R, 2 * v_b, 0.1) == pytest.approx(
        2 * lower_limit(Z, grip, R, v_b, 0.1)
    )
    meeting = Z / (4.0 * R)  # [Schelleng]: 2 Z v / (beta d) = Z^2 v / (2 R beta^2 d)
    assert lower_limit(Z, grip, R, v_b, meeting) == pytest.approx(
        upper_limit(Z, grip, v_b, meeting)
    )
    assert lower_limit(Z, grip, R, v_b, 2 * meeting) < upper_limit(Z, grip, v_b, 2 * meeting)
