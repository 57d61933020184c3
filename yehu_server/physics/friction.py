"""Elasto-plastic friction between hair and string: [Yehu] eqs. (13)-(20), (25), (46)-(53).

Differs: instead of a Newton iteration in two unknowns, which blows up under an
alternating bow force, one scalar equation in the relative velocity is solved inside a
bracket (decisions/0001).
"""

from __future__ import annotations

import math
from typing import Any

from yehu_server.jit import compiled
from yehu_server.physics.elementary import exponential, sine_and_cosine

TOLERANCE = 2e-13  # m/s, on the residual of the bristle velocity
MAX_ITERATIONS = 100


@compiled
def bristles_hold(v_r: float, z_bar: float, z_ba: float) -> bool:
    """Whether chi = 0: bristles move as the hair does. Eqs. (18), (19)."""
    return v_r * z_bar <= 0.0 or abs(z_bar) <= z_ba


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
    if bristles_hold(v_r, z_bar, z_ba):
        return v_r, 1.0, 0.0
    deflection = abs(z_bar)
    steepness = 1.0 / (bow.v_s * bow.v_s)
    stribeck = reach * (bow.mu_S - bow.mu_C) * exponential(-v_r * v_r * steepness)
    z_ss = reach * bow.mu_C + stribeck  # |z_ss|, eq. (17)
    dz_ss = -2.0 * v_r * steepness * stribeck
    per_z_ss = 1.0 / z_ss
    w = deflection * per_z_ss
    if deflection >= z_ss:
        chi, dchi, dchi_ss = 1.0, 0.0, 0.0
    else:
        per_width = math.pi / (z_ss - z_ba)
        sine, cosine = sine_and_cosine((deflection - 0.5 * (z_ss + z_ba)) * per_width)
        chi = 0.5 * (1.0 + sine)  # eq. (20)
        dchi = 0.5 * cosine * per_width
        dchi_ss = -dchi * (deflection - z_ba) * per_width / math.pi
    r = v_r * (1.0 - chi * w)
    by_v = 1.0 - chi * w - v_r * dz_ss * (dchi_ss * w - chi * w * per_z_ss)
    by_z = -abs(v_r) * (dchi * w + chi * per_z_ss)  # sign(z_bar) = sign(v_r) here
    return r, by_v, by_z


@compiled
def solve_friction(
    free: float,
    compliance: float,
    z: float,
    F_N: float,
    tangent: tuple[float, float, float],
    bow: Any,
    string: int,
) -> tuple[float, float, float, tuple[float, float, float], int, bool]:
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
    tangent : (m/s, 1, 1/s)
        Where to start: the law r = t_0 + t_v v_r + t_z z_bar, as the last solution touched it.
    bow, string
        The model's record, and which string is bowed (0 or 1).

    Returns
    -------
    f_b, z_bar, v_r : float, N, m, m/s
    tangent : (m/s, 1, 1/s)
        For the next step.
    iterations : int
        How often the law was worked out.
    converged : bool
        Whether the residual is below 2e-13 m/s (relative above 1 m/s), or below 2e-10 where
        the bracket is down to neighbouring numbers.

    Real time: safe; at most 100 evaluations of the law.
    """
    k, epsilon_0, epsilon_1 = bow.k, bow.epsilon_0, bow.epsilon_1
    rate, per_compliance = 2.0 / k, 1.0 / compliance
    per_gamma = epsilon_1 / (bow.mu_C * F_N)
    reach = F_N / epsilon_0
    z_ba = bow.xi[string] * bow.mu_C * reach
    limit = max(1.2 * bow.mu_S * reach, abs(z))
    low = free - compliance * (epsilon_0 * limit + epsilon_1 * rate * (limit - z))
    high = free + compliance * (epsilon_0 * limit + epsilon_1 * rate * (limit + z))

    # Bristles that hold are nearly linear: try that first, else the last solution's tangent.
    stiffness = epsilon_0 + rate * epsilon_1
    pulled = free + compliance * rate * epsilon_1 * z
    v_r = (pulled - compliance * stiffness * z) / (1.0 + compliance * stiffness / rate)
    if not bristles_hold(v_r, z + v_r / rate, z_ba):
        t_0, t_v, t_z = tangent
        per_z = compliance * stiffness / (rate - t_z)
        v_r = (pulled - per_z * (t_0 + rate * z)) / (1.0 + per_z * t_v)
    v_r = min(max(v_r, low), high)

    # What a Newton step leaves is half the curvature times its square; no curvature of the law
    # is sharper than that of chi, over the breakaway, and that of z_ss, over v_s.
    per_v = math.pi * per_compliance / (stiffness * (bow.mu_C * reach - z_ba)) + 2.0 / bow.v_s
    curvature = (1.0 + limit / (bow.mu_C * reach)) * per_v

    iterations = 0
    converged = False
    z_bar, r, by_v, by_z = z, 0.0, 1.0, 0.0
    while True:
        iterations += 1
        slower = 1.0 + (v_r * per_gamma) ** 2
        root = math.sqrt(slower)  # epsilon_1(v_r) = epsilon_1 / root, eq. (25)
        per_stiffness = 1.0 / (epsilon_0 * root + rate * epsilon_1)  # over root
        z_bar = ((free - v_r) * per_compliance * root + rate * epsilon_1 * z) * per_stiffness
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
        d_damping = epsilon_1 * v_r * per_gamma**2 / slower  # times -root
        dz_bar = (d_damping * rate * (z_bar - z) - per_compliance * root) * per_stiffness
        way = -residual / (by_v + (by_z - rate) * dz_bar)
        step = v_r + way
        is_inside = low < step < high
        bend = curvature * (1.0 + abs(v_r) * per_v)
        if is_inside and 0.5 * bend * way * way <= TOLERANCE:
            held = bristles_hold(v_r, z_bar, z_ba)
            v_r, z_bar = step, z_bar + dz_bar * way
            if bristles_hold(v_r, z_bar, z_ba) == held:  # else a corner of the law is between
                converged = True
                break
            continue
        # Where the law is steep Newton's method can creep: then halve, so that a step
        # always ends well before MAX_ITERATIONS.
        creeping = iterations > 12 and iterations % 2 == 0
        if creeping or not is_inside:
            step = 0.5 * (low + high)
            if not low < step < high:  # the bracket is down to neighbouring floats
                converged = abs(residual) <= 1e3 * TOLERANCE * max(1.0, abs(r))
                break
        v_r = step
    f_b = (free - v_r) * per_compliance  # eq. (49)
    tangent = rate * (z_bar - z) - by_v * v_r - by_z * z_bar, by_v, by_z
    return f_b, z_bar, v_r, tangent, iterations, converged
