"""Elasto-plastic friction between hair and string: [Yehu] eqs. (13)-(20), (25), (46)-(53).

Differs: instead of a Newton iteration in two unknowns, which blows up under an
alternating bow force, one scalar equation in the relative velocity is solved inside a
bracket (decisions/0001).
"""

from __future__ import annotations

import math
from typing import Any

from yehu_server.jit import compiled

TOLERANCE = 2e-13  # m/s, on the residual of the bristle velocity
MAX_ITERATIONS = 100


@compiled
def bristle_velocity(
    v_r: float, z_bar: float, F_N: float, bow: Any, string: int
) -> tuple[float, float, float]:
    """Return dz/dt (m/s) and its partial derivatives by v_r and by z_bar.

    Parameters
    ----------
    v_r, z_bar : float, m/s and m
        Relative velocity and average bristle deflection.
    F_N : float, N
        Normal force, positive.
    bow : record
        The model, for epsilon_0, mu_C, mu_S, v_s, xi.

    Real time: safe. Source: [Yehu] eqs. (16)-(20).
    """
    deflection = abs(z_bar)
    z_ba = bow.xi[string] * bow.mu_C * F_N / bow.epsilon_0
    if v_r * z_bar <= 0.0 or deflection <= z_ba:
        return v_r, 1.0, 0.0  # chi = 0: the bristles hold
    sign = 1.0 if v_r > 0.0 else -1.0
    ratio = v_r / bow.v_s
    stribeck = (bow.mu_S - bow.mu_C) * math.exp(-ratio * ratio)
    z_ss = F_N / bow.epsilon_0 * (bow.mu_C + stribeck)  # |z_ss|
    dz_ss = F_N / bow.epsilon_0 * stribeck * (-2.0 * ratio / bow.v_s)
    w = deflection / z_ss
    if deflection >= z_ss:
        chi, dchi, dchi_ss = 1.0, 0.0, 0.0
    else:
        width = z_ss - z_ba
        angle = math.pi * (deflection - 0.5 * (z_ss + z_ba)) / width
        chi = 0.5 * (1.0 + math.sin(angle))
        dchi = 0.5 * math.pi * math.cos(angle) / width
        dchi_ss = -dchi * (deflection - z_ba) / width
    r = v_r * (1.0 - chi * w)
    by_v = 1.0 - chi * w - v_r * dz_ss * (dchi_ss * w - chi * w / z_ss)
    by_z = -v_r * sign * (dchi * w + chi / z_ss)
    return r, by_v, by_z


@compiled
def solve_friction(
    free: float, compliance: float, z: float, F_N: float, v_start: float, bow: Any, string: int
) -> tuple[float, float, float, int, bool]:
    """Find the friction force of one step.

    Eliminating z_bar from v_r = free - compliance * f_b, eqs. (46) and (49), leaves one
    equation, r(v_r, z_bar(v_r)) = 2 (z_bar - z)/k. Its left side minus its right one
    changes sign between the velocities at which |z_bar| reaches
    max(1.2 mu_S F_N / epsilon_0, |z|), so Newton's method is kept between them.

    Parameters
    ----------
    free : float, m/s
        Relative velocity without friction, s - v_b of eq. (49).
    compliance : float, m/s/N
        The factor of f_b in eq. (49).
    z : float, m
        Bristle deflection half a step ago.
    F_N : float, N
        Normal force, positive.
    v_start : float, m/s
        Where to start, usually the last relative velocity.
    bow, string
        The model's record, and which string is bowed (0 or 1).

    Returns
    -------
    f_b, z_bar, v_r : float, N, m, m/s
    iterations : int
    converged : bool
        Whether the residual fell below 2e-13 m/s (relative above 1 m/s).

    Real time: safe; at most 100 evaluations of the law.
    """
    k, epsilon_0, epsilon_1 = bow.k, bow.epsilon_0, bow.epsilon_1
    gamma = bow.mu_C * F_N / epsilon_1
    limit = max(1.2 * bow.mu_S * F_N / epsilon_0, abs(z))
    low = free - compliance * (epsilon_0 * limit + epsilon_1 * 2.0 * (limit - z) / k)
    high = free + compliance * (epsilon_0 * limit + epsilon_1 * 2.0 * (limit + z) / k)

    # Sticking without plastic flow is nearly linear: try that first.
    v_r = (free - compliance * epsilon_0 * z) / (
        1.0 + compliance * (0.5 * k * epsilon_0 + epsilon_1)
    )
    z_bar = z + 0.5 * k * v_r
    if v_r * z_bar > 0.0 and abs(z_bar) > bow.xi[string] * bow.mu_C * F_N / epsilon_0:
        v_r = v_start
    v_r = min(max(v_r, low), high)

    iterations = 0
    converged = False
    damping = epsilon_1
    while True:
        iterations += 1
        damping = epsilon_1 / math.sqrt(1.0 + (v_r / gamma) ** 2)  # eq. (25)
        denominator = epsilon_0 + 2.0 * damping / k
        z_bar = ((free - v_r) / compliance + 2.0 * damping * z / k) / denominator
        r, by_v, by_z = bristle_velocity(v_r, z_bar, F_N, bow, string)
        residual = r - 2.0 * (z_bar - z) / k
        if abs(residual) <= TOLERANCE * max(1.0, abs(r)):
            converged = True
            break
        if iterations == MAX_ITERATIONS:
            break
        if residual > 0.0:
            high = v_r
        else:
            low = v_r
        d_damping = -damping * v_r / (v_r * v_r + gamma * gamma)
        dz_bar = (-1.0 / compliance + d_damping * 2.0 * (z - z_bar) / k) / denominator
        slope = by_v + (by_z - 2.0 / k) * dz_bar
        step = v_r - residual / slope
        # Where the law is steep Newton's method can creep: then halve, so that a step
        # always ends well before MAX_ITERATIONS.
        creeping = iterations > 12 and iterations % 2 == 0
        if creeping or not low < step < high:
            step = 0.5 * (low + high)
            if not low < step < high:  # the bracket is down to neighbouring floats
                converged = abs(residual) <= 1e3 * TOLERANCE * max(1.0, abs(r))
                break
        v_r = step
    f_b = epsilon_0 * z_bar + damping * 2.0 * (z_bar - z) / k  # eq. (46)
    return f_b, z_bar, v_r, iterations, converged
