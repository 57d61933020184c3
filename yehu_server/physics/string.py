"""A stiff string with two losses: [Yehu] eqs. (30)-(32), boundaries eq. (3)."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.physics.grid import intervals
from yehu_server.physics.layout import GHOST, STRINGS, whole_vectors
from yehu_server.physics.quantities import Quantities

Array = Any


def prepare_strings(model: np.void, quantities: Quantities) -> None:
    """Write the strings' grids and coefficients into `model`. Source: [Yehu] eq. (57)."""
    for i, string in enumerate(quantities.strings):
        N = intervals(string, model["k"], quantities.tension_headroom)
        model["N"][i], model["h"][i] = N, string.L / N
        model["inside"][i, GHOST + 1 : GHOST + N] = 1.0
        model["rho_A"][i], model["EI"][i] = string.rho_A, string.EI
        weigh_string(model, i, string.T, string.sigma_0, string.sigma_1)


@compiled
def weigh_string(model: Any, i: int, T: float, sigma_0: float, sigma_1: float) -> None:
    """Write the scheme's weights for a tension (N) and losses, both sides divided by A_s.

    The grid stays: it must bear the tension (see `most_loss`).
    Real time: safe. Source: [Yehu] eqs. (27), (31), (32).
    """
    k, h, rho_A, EI = model.k, model.h[i], model.rho_A[i], model.EI[i]
    A_s = rho_A / k**2 + rho_A * sigma_0 / k
    # D2 u = (u[l-1] - 2 u[l] + u[l+1]) / h^2, and D4 = D2 D2.
    d2 = (T + 2.0 * rho_A * sigma_1 / k) / h**2
    d4 = EI / h**4
    model.B[i, 0] = (2.0 * rho_A / k**2 - 2.0 * d2 - 6.0 * d4) / A_s
    model.B[i, 1] = (d2 + 4.0 * d4) / A_s
    model.B[i, 2] = -d4 / A_s
    loss = 2.0 * rho_A * sigma_1 / (k * h**2)
    model.C[i, 0] = (-rho_A / k**2 + rho_A * sigma_0 / k + 2.0 * loss) / A_s
    model.C[i, 1] = -loss / A_s
    model.spread[i] = 1.0 / (h * A_s)
    model.T[i], model.sigma_0[i], model.sigma_1[i] = T, sigma_0, sigma_1


@compiled
def most_loss(model: Any, i: int, T: float) -> float:
    """The largest sigma_1 (m^2/s) that a string's grid bears at a tension (N): eq. (57) for it."""
    k, h_squared = model.k, model.h[i] ** 2
    rho_A = model.rho_A[i]
    kappa_squared = model.EI[i] / rho_A
    room = h_squared - 4.0 * k**2 * kappa_squared / h_squared - T / rho_A * k**2
    return float(max(0.0, room / (4.0 * k)))


@compiled
def advance_string(
    u_next: Array,
    u: Array,
    u_prev: Array,
    bend: Array,
    inside: Array,
    N: int,
    B: Array,
    C: Array,
) -> tuple[float, float]:
    """Advance one stiff string by one sample, free of contact forces: u* of eq. (58).

    Parameters
    ----------
    u_next, u, u_prev : ndarray [shape=(POINTS,), m]
        Displacement one sample ahead, now and one sample ago, with one ghost node at
        each end, and zeros beyond.
    bend : ndarray [shape=(POINTS,), m]
        Written: Delta u, the second difference now.
    inside : ndarray [shape=(POINTS,)]
        One between the ends of the string, zero there and beyond.
    B : ndarray [shape=(3,)]
        Weights of u at distance 0, 1 and 2.
    C : ndarray [shape=(2,)]
        Weights of u_prev at distance 0 and 1.

    Returns
    -------
    square, along : float, m^2
        <Delta u, Delta u> and <Delta u, u* + u_prev> over the nodes, for tension.py.

    Real time: safe; no allocation, linear in N.
    Source: [Yehu] eq. (32) with simple supports, eq. (3).
    """
    B_0, B_1, B_2 = B[0], B[1], B[2]
    C_0, C_1 = C[0], C[1]
    square, along = 0.0, 0.0
    for l in range(whole_vectors(N - 1)):
        at = GHOST + 1 + l
        beside = u[at - 1] + u[at + 1]
        star = (
            B_0 * u[at]
            + B_1 * beside
            + B_2 * (u[at - 2] + u[at + 2])
            + C_0 * u_prev[at]
            + C_1 * (u_prev[at - 1] + u_prev[at + 1])
        )
        delta = (beside - 2.0 * u[at]) * inside[at]
        u_next[at], bend[at] = star * inside[at], delta
        square += delta * delta
        along += delta * (star + u_prev[at])
    return square, along


@compiled
def support(u: Array, N: int) -> None:
    """Mirror the ghost nodes: u = 0 and D2 u = 0 at both ends, eq. (3)."""
    u[0] = -u[2]
    u[N + 2] = -u[N]


@compiled
def advance_strings(model: Any, s: Any, u_next: Array, u: Array, u_prev: Array) -> None:
    """Both strings, free of contact forces: arrays of shape (2, points)."""
    for i in range(STRINGS):
        s.square[i], s.along[i] = advance_string(
            u_next[i],
            u[i],
            u_prev[i],
            s.bend[i],
            model.inside[i],
            model.N[i],
            model.B[i],
            model.C[i],
        )
