"""Interpolation I and spreading J = I^T / h: how a point force meets the grid.

Every contact touches four neighbouring nodes, ``first`` to ``first + 3``. Nodes 0 and
N are the fixed ends: their weights are zero, so that J stays the transpose of I.
Source: [Bilbao] section 5.2.4; [Yehu] eq. (28).
"""

from __future__ import annotations

import numpy as np

from yehu_server.jit import compiled
from yehu_server.physics.layout import GHOST, STENCIL
from yehu_server.physics.records import Array


@compiled
def _place(position: float, N: int, weights: Array, cubic: bool) -> int:
    l = int(position)
    l = max(1, min(l, N - 2))
    a = position - l
    if cubic:
        weights[0] = -a * (a - 1.0) * (a - 2.0) / 6.0
        weights[1] = (a - 1.0) * (a + 1.0) * (a - 2.0) / 2.0
        weights[2] = -a * (a + 1.0) * (a - 2.0) / 2.0
        weights[3] = a * (a + 1.0) * (a - 1.0) / 6.0
    else:
        weights[0] = 0.0
        weights[1] = 1.0 - a
        weights[2] = a
        weights[3] = 0.0
    first = l - 1
    if first == 0:
        weights[0] = 0.0
    if first + 3 == N:
        weights[3] = 0.0
    return first


@compiled
def place_cubic(position: float, N: int, weights: Array) -> int:
    """Write the weights of a contact at `position` (in nodes, 1 to N-1); return its first node."""
    return _place(position, N, weights, True)


@compiled
def place_linear(position: float, N: int, weights: Array) -> int:
    """As `place_cubic`, with linear interpolation between two nodes."""
    return _place(position, N, weights, False)


@compiled
def read(u: Array, first: int, weights: Array) -> float:
    """Return I u, the displacement at a contact (m)."""
    total = 0.0
    for j in range(STENCIL):
        total += weights[j] * u[GHOST + first + j]
    return total


@compiled
def spread(u: Array, first: int, weights: Array, amount: float) -> None:
    """Add J * amount * h to u: a force's displacement around a contact."""
    for j in range(STENCIL):
        u[GHOST + first + j] += weights[j] * amount


@compiled
def overlap(first_p: int, weights_p: Array, first_q: int, weights_q: Array) -> float:
    """Return h I_p J_q; zero where no node is shared."""
    shift = np.int64(first_p) - np.int64(first_q)
    total = 0.0
    if -STENCIL < shift < STENCIL:
        for j in range(STENCIL):
            at = j + shift
            if 0 <= at < STENCIL:
                total += weights_p[j] * weights_q[at]
    return total
