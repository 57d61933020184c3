"""A plucked start: one string let go from a triangle."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.physics.layout import GHOST, POINTS
from yehu_server.physics.stencil import read
from yehu_server.physics.string import support


def pluck_string(model: Any, state: Any, i: int, position: float, amplitude: float) -> None:
    """Pull string `i` into a triangle, at rest, between the loop or stub and the bridge.

    Parameters
    ----------
    position, amplitude : float, m
        Of the triangle's corner.

    The nodes at the bridge are moved by what it takes to leave the bridge at rest, so
    that the constraint of [Yehu] eq. (12) holds from the first sample.
    """
    m, s = model[0], state[0]
    intervals, h = int(m["N"][i]), float(m["h"][i])
    x, x_c = np.arange(intervals + 1) * h, float(m["bridge_x"])
    foot = (0.0, x_c) if position < x_c else (x_c, intervals * h)
    shape = amplitude * np.interp(x, [foot[0], position, foot[1]], [0.0, 1.0, 0.0])
    shape[[0, -1]] = 0.0
    u = np.zeros(POINTS)
    u[GHOST : GHOST + intervals + 1] = shape
    first, weights = int(m["bridge_first"][i]), m["bridge_weights"][i]
    at_bridge = read(u, first, weights) / float(weights @ weights)
    u[GHOST + first : GHOST + first + len(weights)] -= weights * at_bridge
    support(u, intervals)
    s["u"][:, i, :] = u
