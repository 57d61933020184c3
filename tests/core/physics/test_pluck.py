"""A string pulled aside by a force: its shape, its energy, its sound."""

import numpy as np
import pytest
from core.physics.runs import play
from pitch import cents, pitch_of

from yehu_server.core.physics import layout
from yehu_server.core.physics.quantities import Quantities

YEHU = Quantities()
RATE = 44100.0
PULL = {"pluck": 1.0, "x_pluck": 0.2}


def shape(run, string):
    now, N = int(run.state["motion"]["level"][0]), int(run.model["N"][0, string])
    return run.state["motion"]["u"][0, now, string, layout.GHOST : layout.GHOST + N + 1]


@pytest.mark.parametrize("string", [0, 1], ids=["F4", "C5"])
def test_a_steady_pull_bends_the_string_into_a_triangle(string):
    """F x (x_c - x) / (T x_c) at the place of the force, between the loop and the bridge.

    A little less: the string is stiff, and tighter for being pulled.
    """
    sign = 1.0 if string == 0 else -1.0
    run = play(lambda t: {"pluck": sign * np.minimum(1.0, t / 0.5), "x_pluck": 0.2}, 4.0)
    silk, x_c = YEHU.strings[string], YEHU.bridge_x
    ideal = 0.2 * (x_c - 0.2) / (silk.T * x_c)
    assert ideal * 0.8 < shape(run, string).max() < ideal
    assert np.abs(shape(run, 1 - string)).max() < 0.05 * ideal


@pytest.mark.parametrize("string", [0, 1], ids=["F4", "C5"])
def test_plucking_creates_no_energy(string):
    sign = 1.0 if string == 0 else -1.0

    def plucks(t):
        phase = (4.0 * t) % 1.0
        return {
            "pluck": sign * np.where(phase < 0.05, phase / 0.05, 0.0) * 2.0,
            "x_pluck": 0.2 + 0.03 * np.sin(3.0 * t),
            "x_f": [np.full(len(t), 0.1)],
            "press": [np.where((t % 1.0) < 0.5, 1.5, 0.0)],
        }

    run = play(plucks, 2.0)
    assert np.abs(run["energy_error"]).max() <= 1e-9 * run.power
    assert run["power_in"].max() > 0.01
    assert run["constraint_residual"].max() <= 1e-15


def test_a_string_let_go_sounds_its_pitch():
    run = play(lambda t: {"pluck": np.where(t < 0.01, t / 0.01, 0.0), "x_pluck": 0.2}, 0.6)
    silk = YEHU.string_1
    ideal = (silk.T / silk.rho_A) ** 0.5 / (2.0 * YEHU.bridge_x)
    assert abs(cents(pitch_of(run["bridge_force"][round(0.1 * RATE) :], RATE), ideal)) < 40.0
