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
    v_r: float, z_bar: float, z_ba: float, reach: float, bow: Any
) -> tuple[float, float, float]:
    """Return dz/dt (m/s) and its partial derivatives by v_r and by z_bar.

    Parameters
    ----------
    v_r, z_bar : float, m/s and m
        Relative velocity and average bristle deflection.
    z_ba, reach : float, m
        Breakaway deflection, and F_N / epsilon_0: the deflection at a friction of one.
    bow : record
        The model, for mu_C, mu_S, v_s.

    Real time: safe. Source: [Yehu] eqs. (16)-(20).
    """
    deflection = abs(z_bar)
    if v_r * z_bar <= 0.0 or deflection <= z_ba:
        return v_r, 1.0, 0.0  # chi = 0: the bristles hold
    sign = 1.0 if v_r > 0.0 else -1.0
    steepness = 1.0 / (bow.v_s * bow.v_s)
    stribeck = reach * (bow.mu_S - bow.mu_C) * math.exp(-v_r * v_r * steepness)
    z_ss = reach * bow.mu_C + stribeck  # |z_ss|, eq. (17)
    dz_ss = -2.0 * v_r * steepness * stribeck
    per_z_ss = 1.0 / z_ss
    w = deflection * per_z_ss
    if deflection >= z_ss:
        chi, dchi, dchi_ss = 1.0, 0.0, 0.0
    else:
        per_width = math.pi / (z_ss - z_ba)
        angle = (deflection - 0.5 * (z_ss + z_ba)) * per_width
        chi = 0.5 * (1.0 + math.sin(angle))  # eq. (20)
        dchi = 0.5 * math.cos(angle) * per_width
        dchi_ss = -dchi * (deflection - z_ba) * per_width / math.pi
    r = v_r * (1.0 - chi * w)
    by_v = 1.0 - chi * w - v_r * dz_ss * (dchi_ss * w - chi * w * per_z_ss)
    by_z = -v_r * sign * (dchi * w + chi * per_z_ss)
    return r, by_v, by_z


@compiled
def solve_friction(
    free: float, compliance: float, z: float, F_N: float, f_start: float, bow: Any, string: int
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
    f_start : float, N
        Where to start: the last friction force, which changes less than the velocity.
    bow, string
        The model's record, and which string is bowed (0 or 1).

    Returns
    -------
    f_b, z_bar, v_r : float, N, m, m/s
    iterations : int
    converged : bool
        Whether the residual fell below 2e-13 m/s (relative above 1 m/s), or below 2e-10
        where the bracket is down to neighbouring numbers.

    Real time: safe; at most 100 evaluations of the law.
    """
    k, epsilon_0, epsilon_1 = bow.k, bow.epsilon_0, bow.epsilon_1
    gamma = bow.mu_C * F_N / epsilon_1
    reach = F_N / epsilon_0
    z_ba = bow.xi[string] * bow.mu_C * reach
    limit = max(1.2 * bow.mu_S * reach, abs(z))
    low = free - compliance * (epsilon_0 * limit + epsilon_1 * 2.0 * (limit - z) / k)
    high = free + compliance * (epsilon_0 * limit + epsilon_1 * 2.0 * (limit + z) / k)

    # Sticking without plastic flow is nearly linear: try that first.
    v_r = (free - compliance * epsilon_0 * z) / (
        1.0 + compliance * (0.5 * k * epsilon_0 + epsilon_1)
    )
    z_bar = z + 0.5 * k * v_r
    if v_r * z_bar > 0.0 and abs(z_bar) > z_ba:
        v_r = free - compliance * f_start
    v_r = min(max(v_r, low), high)

    rate, per_compliance, per_gamma = 2.0 / k, 1.0 / compliance, 1.0 / gamma
    iterations = 0
    converged = False
    damping = epsilon_1
    while True:
        iterations += 1
        damping = epsilon_1 / math.sqrt(1.0 + (v_r * per_gamma) ** 2)  # eq. (25)
        per_stiffness = 1.0 / (epsilon_0 + rate * damping)
        z_bar = ((free - v_r) * per_compliance + rate * damping * z) * per_stiffness
        r, by_v, by_z = bristle_velocity(v_r, z_bar, z_ba, reach, bow)
        residual = r - rate * (z_bar - z)
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
        dz_bar = (d_damping * rate * (z - z_bar) - per_compliance) * per_stiffness
        slope = by_v + (by_z - rate) * dz_bar
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
    f_b = epsilon_0 * z_bar + damping * rate * (z_bar - z)  # eq. (46)
    return f_b, z_bar, v_r, iterations, converged
