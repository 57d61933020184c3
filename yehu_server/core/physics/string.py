"""A stiff string with two losses: [Yehu] eqs. (30)-(32), boundaries eq. (3)."""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.elementary import elementwise, sin
from yehu_server.core.physics.grid import intervals
from yehu_server.core.physics.layout import GHOST, LEVELS, STENCIL, padded_length
from yehu_server.core.physics.records import Array, Model, Motion, Work


def prepare_strings(model: Any, quantities: Quantities) -> None:
    """Write the strings' grids and quantities into `model`. Source: [Yehu] eq. (57)."""
    for i, string in enumerate(quantities.strings):
        N = intervals(string, model["k"], quantities.tension_headroom)
        model["N"][i], model["h"][i] = N, string.L / N
        felt = felt_at_nodes(string.L, N, quantities)
        held = felt / (1.0 / model["k"] + string.sigma_0 + felt)
        model["held"][i, GHOST + 1 : GHOST + N] = held
        model["inside"][i, GHOST + 1 : GHOST + N] = 1.0 - held
        model["rho_A"][i], model["EI"][i] = string.rho_A, string.EI
        model["T"][i], model["sigma_0"][i] = string.T, string.sigma_0
        model["sigma_1"][i] = string.sigma_1


def felt_at_nodes(L: float, N: int, quantities: Quantities) -> np.ndarray:
    """Return what felt behind the bridge adds to sigma_0 at the inner nodes of a string (1/s).

    It fills the space between bridge and stub, and presses most in the middle. It leaves out the
    nodes that the bridge touches, as would be a contact's: they move by their mass alone.
    """
    nodes, bridge = np.arange(1, N), quantities.bridge_x * N / L
    behind = np.where(nodes > int(bridge) + STENCIL // 2, (nodes - bridge) / (N - bridge), 0.0)
    return np.asarray(quantities.felt_loss * elementwise(sin, np.pi * behind) ** 2)


@compiled
def set_string_weights(model: Model, i: int, T: float, sigma_0: float, sigma_1: float) -> None:
    """Write the scheme's weights for a tension (N) and losses, both sides divided by A_s.

    The grid stays as it is, and must be stable at the tension (see `max_stable_sigma_1`).
    Real time: safe. Source: [Yehu] eqs. (27), (31), (32).
    """
    k, h, rho_A, EI = model.k, model.h[i], model.rho_A[i], model.EI[i]
    A_s = rho_A / (k * k) + rho_A * sigma_0 / k
    # D2 u = (u[l-1] - 2 u[l] + u[l+1]) / h^2, and D4 = D2 D2.
    d2 = (T + 2.0 * rho_A * sigma_1 / k) / (h * h)
    d4 = EI / (h * h * h * h)
    model.B[i, 0] = (2.0 * rho_A / (k * k) - 2.0 * d2 - 6.0 * d4) / A_s
    model.B[i, 1] = (d2 + 4.0 * d4) / A_s
    model.B[i, 2] = -d4 / A_s
    loss = 2.0 * rho_A * sigma_1 / (k * h * h)
    model.C[i, 0] = (-rho_A / (k * k) + rho_A * sigma_0 / k + 2.0 * loss) / A_s
    model.C[i, 1] = -loss / A_s
    model.spread[i] = 1.0 / (h * A_s)
    model.T[i], model.sigma_0[i], model.sigma_1[i] = T, sigma_0, sigma_1


@compiled
def max_stable_sigma_1(model: Model, i: int, T: float) -> float:
    """Return the largest sigma_1 (m^2/s) that is stable at a tension (N), by eq. (57)."""
    k, h_squared = model.k, model.h[i] * model.h[i]
    rho_A = model.rho_A[i]
    kappa_squared = model.EI[i] / rho_A
    room = h_squared - 4.0 * k * k * kappa_squared / h_squared - T / rho_A * k * k
    return float(max(0.0, room / (4.0 * k)))


@compiled
def advance_node(
    u_next: Array,
    u: Array,
    u_prev: Array,
    Delta_u: Array,
    inside: Array,
    held: Array,
    at: int,
    B: Array,
    C: Array,
) -> tuple[float, float]:
    """Advance one node; return its terms of the two sums of `advance_nodes`."""
    beside = u[at - 1] + u[at + 1]
    star = B[0] * u[at] + B[1] * beside + B[2] * (u[at - 2] + u[at + 2])
    star += (C[0] + 2.0 * C[1]) * u_prev[at] + C[1] * Delta_u[at]
    delta = (beside - 2.0 * u[at]) * (inside[at] + held[at])
    star = star * inside[at] + u_prev[at] * held[at]
    u_next[at], Delta_u[at] = star, delta
    return delta * delta * inside[at], delta * (star + u_prev[at])


@compiled
def advance_nodes(
    u_next: Array,
    u: Array,
    u_prev: Array,
    Delta_u: Array,
    inside: Array,
    held: Array,
    N: int,
    B: Array,
    C: Array,
) -> tuple[float, float, float, float]:
    """Advance two stiff strings by one sample, without forces: the first two terms of eq. (58).

    Both in one loop, so that the sums of both are computed in parallel.

    Parameters
    ----------
    u_next, u, u_prev : ndarray [shape=(STRINGS, POINTS), m]
        Displacement one sample ahead, now and one sample ago, with one ghost node at
        each end, and zeros beyond.
    Delta_u : ndarray [shape=(STRINGS, POINTS), m]
        The second difference of u_prev; written: that of u.
    inside, held : ndarray [shape=(STRINGS, POINTS)]
        The share of its free motion that a node makes, and that of u_prev that it keeps: 1 and 0
        between the ends of a string, r and 1 - r where felt damps it, 0 and 0 at the ends and
        beyond.
    N : int
        The grid intervals of the longer string.
    B : ndarray [shape=(STRINGS, 3)]
        Weights of u at distance 0, 1 and 2.
    C : ndarray [shape=(STRINGS, 2)]
        Weights of u_prev at distance 0 and 1.

    Returns
    -------
    squared_1, travel_1, squared_2, travel_2 : float, m^2
        <Delta u, inside Delta u> and <Delta u, u* + u_prev> over the nodes, for tension.py.

    Real time: safe; no allocation, linear in N.
    Source: [Yehu] eq. (32) with simple supports, eq. (3).
    """
    squared_1, travel_1, squared_2, travel_2 = 0.0, 0.0, 0.0, 0.0
    for l in range(padded_length(N - 1)):
        at = GHOST + 1 + l
        squared, travel = advance_node(
            u_next[0], u[0], u_prev[0], Delta_u[0], inside[0], held[0], at, B[0], C[0]
        )
        squared_1 += squared
        travel_1 += travel
        squared, travel = advance_node(
            u_next[1], u[1], u_prev[1], Delta_u[1], inside[1], held[1], at, B[1], C[1]
        )
        squared_2 += squared
        travel_2 += travel
    return squared_1, travel_1, squared_2, travel_2


def set_Delta_u(model: np.void, s: np.void) -> None:
    """Write Delta u^{n-1} into a motion whose displacements were set from outside."""
    u_prev = s["u"][(int(s["level"]) + 2) % LEVELS]
    delta = u_prev[:, :-2] - 2.0 * u_prev[:, 1:-1] + u_prev[:, 2:]
    s["Delta_u"][:, 1:-1] = delta * (model["inside"] + model["held"])[:, 1:-1]


@compiled
def support(u: Array, N: int) -> None:
    """Mirror the ghost nodes: u = 0 and D2 u = 0 at both ends, eq. (3)."""
    u[0] = -u[2]
    u[N + 2] = -u[N]


@compiled
def advance_strings(
    model: Model, s: Motion, w: Work, u_next: Array, u: Array, u_prev: Array
) -> None:
    """Advance both strings, free of contact forces: arrays of shape (2, points)."""
    N = max(model.N[0], model.N[1])
    squared, travel = w.Delta_u_squared, w.Delta_u_travel
    squared[0], travel[0], squared[1], travel[1] = advance_nodes(
        u_next, u, u_prev, s.Delta_u, model.inside, model.held, N, model.B, model.C
    )
