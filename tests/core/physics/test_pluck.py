"""A string pulled aside by a force or a finger: its shape, its sound, its tension."""

import numpy as np
import pytest
from core.physics.runs import play
from pitch import cents, pitch_of

from yehu_server.core.physics import layout
from yehu_server.core.physics.quantities import Quantities

YEHU = Quantities()
RATE = 44100.0


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


def test_a_string_let_go_sounds_its_pitch():
    run = play(lambda t: {"pluck": np.where(t < 0.01, t / 0.01, 0.0), "x_pluck": 0.2}, 0.6)
    silk = YEHU.string_1
    ideal = (silk.T / silk.rho_A) ** 0.5 / (2.0 * YEHU.bridge_x)
    assert abs(cents(pitch_of(run["bridge_force"][round(0.1 * RATE) :], RATE), ideal)) < 40.0


def test_a_pressed_string_is_tighter_by_its_stretch():
    """T' = EA/(2 L) int u_x^2 dx once all is at rest."""
    for press in (0.5, 3.0):
        run = play({"press": [press], "x_f": [0.1]}, 1.5, ledger=False)
        for i, string in enumerate(YEHU.strings):
            h = run.model["h"][0, i]
            expected = string.EA / (2.0 * string.L) * np.sum(np.diff(shape(run, i)) ** 2) / h
            assert expected > 0.0
            T_more = run.state["work"]["tau"][0, i] * h / run.model["spread"][0, i]
            assert T_more == pytest.approx(expected, rel=1e-3)
