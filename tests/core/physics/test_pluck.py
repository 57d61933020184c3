"""A string pulled aside by a force or a finger: its shape, its sound, its tension."""

import numpy as np
import pytest
from core.physics.runs import play

from yehu_server.core.physics import layout
from yehu_server.core.physics.default_quantities import Quantities

YEHU = Quantities()


def shape(run, string):
    now, N = int(run.state["motion"]["level"][0]), int(run.model["N"][0, string])
    return run.state["motion"]["u"][0, now, string, layout.GHOST : layout.GHOST + N + 1]


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
