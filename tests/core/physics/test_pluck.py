"""A string pulled aside by a force or a finger: its shape, its sound, its tension."""

import numpy as np
import pytest
from core.physics.runs import play

from yehu_server.core.physics import layout
from yehu_server.core.physics.quantities import Quantities

YEHU = Quantities()


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
