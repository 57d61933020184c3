"""The grid of a string, the finest that is stable, and how a point force meets it.

Every contact touches four neighbouring nodes, ``first`` to ``first + 3``. Nodes 0 and
N are the fixed ends: their weights are zero, so that J stays the transpose of I.
Source: [Bilbao] section 5.2.4; [Yehu] eq. (28).
"""

import math

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import StringQuantities
from yehu_server.core.physics.layout import GHOST, MAX_INTERVALS, STENCIL
from yehu_server.core.physics.records import Array
from yehu_server.errors import ParameterError

MIN_RATE, MAX_RATE = 22050.0, 192000.0  # Hz


def least_spacing(string: StringQuantities, k: float, headroom: float = 1.0) -> float:
    """Return the smallest stable grid spacing h_min (m) for time step `k` (s).

    `headroom` multiplies the tension: the grid stays stable up to there.
    Source: [Yehu] eq. (57); Differs: its term in sigma_1 is 2 k sigma_1, see docs/physics.md.
    """
    c_squared = headroom * string.T / string.rho_A
    kappa_squared = string.EI / string.rho_A
    middle = c_squared * k + 4.0 * string.sigma_1
    return math.sqrt(
        c_squared * k * k / 2.0
        + 2.0 * k * string.sigma_1
        + k / 2.0 * math.sqrt(middle * middle + 16.0 * kappa_squared)
    )


def intervals(string: StringQuantities, k: float, headroom: float = 1.0) -> int:
    """The number N of a string's grid intervals of L/N; ParameterError for too few or too many."""
    N = math.floor(string.L / least_spacing(string, k, headroom))
    if not 12 <= N <= MAX_INTERVALS:
        raise ParameterError(
            f"a string of {string.L} m needs {N} grid intervals at {1.0 / k:.0f} Hz; "
            f"12 to {MAX_INTERVALS} are possible"
        )
    return N


def check_rate(rate: float) -> None:
    """Raise ParameterError for a sample rate (Hz) outside 22,050 to 192,000."""
    if not MIN_RATE <= rate <= MAX_RATE:
        raise ParameterError(
            f"sample rate: {rate} Hz is not within {MIN_RATE:g} to {MAX_RATE:g} Hz"
        )


@compiled
def _write_weights(position: float, N: int, weights: Array, cubic: bool) -> int:
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
def cubic_weights(position: float, N: int, weights: Array) -> int:
    """Write the weights of a contact at `position` (in nodes, 1 to N-1); return its first node."""
    return _write_weights(position, N, weights, True)


@compiled
def linear_weights(position: float, N: int, weights: Array) -> int:
    """As `cubic_weights`, with linear interpolation between two nodes."""
    return _write_weights(position, N, weights, False)


@compiled
def interpolate(u: Array, first: int, weights: Array) -> float:
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
