"""Plucking: a string pulled aside by a force and let go, or let go from a triangle."""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled, uncompiled
from yehu_server.core.physics.grid import cubic_weights, interpolate, spread
from yehu_server.core.physics.layout import F_PLUCK, GHOST, POINTS, X_PLUCK
from yehu_server.core.physics.records import Array, Contacts, Model, Motion, Work
from yehu_server.core.physics.string import set_Delta_u, support


@compiled
def pluck(model: Model, s: Motion, c: Contacts, w: Work, control: Array, u_next: Array) -> None:
    """Apply the plucking force to the string that its sign chooses. Eq. (30)."""
    force = control[F_PLUCK]
    if force == 0.0:
        return
    i = 0 if force > 0.0 else 1
    x = control[X_PLUCK]
    if x != c.x_pluck or i != c.pluck_string:
        c.x_pluck, c.pluck_string = x, i
        position = max(1.0, min(x, model.bridge_x) / model.h[i])
        c.pluck_first = cubic_weights(position, model.N[i], c.pluck_weights)
    moved = model.spread[i] * abs(force)
    spread(u_next[i], c.pluck_first, c.pluck_weights, moved)
    w.Delta_u_travel[i] += moved * interpolate(s.Delta_u[i], c.pluck_first, c.pluck_weights)


@compiled
def pluck_power(model: Model, c: Contacts, control: Array, u_next: Array, u_prev: Array) -> float:
    """Return the power of the plucking force (W)."""
    if control[F_PLUCK] == 0.0:
        return 0.0
    i = c.pluck_string
    travel = interpolate(u_next[i], c.pluck_first, c.pluck_weights)
    travel -= interpolate(u_prev[i], c.pluck_first, c.pluck_weights)
    return float(abs(control[F_PLUCK]) * travel / (2.0 * model.k))


def pluck_string(model: Any, state: Any, i: int, position: float, amplitude: float) -> None:
    """Pull string `i` into a triangle with a corner (m), at rest, up to the bridge.

    The nodes at the bridge are moved by what it takes to leave the bridge at rest, so that the
    constraint of [Yehu] eq. (12) holds from the first sample.
    """
    pull_string(model[0], state[0]["motion"], i, position, amplitude)


def pull_string(m: Any, motion: Any, i: int, position: float, amplitude: float) -> None:
    """As `pluck_string`, in one direction of the string's motion (a record of MOTION)."""
    intervals, h = int(m["N"][i]), float(m["h"][i])
    x, x_c = np.arange(intervals + 1) * h, float(m["bridge_x"])
    foot = (0.0, x_c) if position < x_c else (x_c, intervals * h)
    shape = amplitude * np.interp(x, [foot[0], position, foot[1]], [0.0, 1.0, 0.0])
    shape[[0, -1]] = 0.0
    u = np.zeros(POINTS)
    u[GHOST : GHOST + intervals + 1] = shape
    first, weights = int(m["bridge_first"][i]), m["bridge_weights"][i]
    at_bridge = uncompiled(interpolate)(u, first, weights) / float((weights * weights).sum())
    u[GHOST + first : GHOST + first + len(weights)] -= weights * at_bridge
    uncompiled(support)(u, intervals)
    motion["u"][:, i, :] = u
    set_Delta_u(m, motion)
