"""Elasto-plastic friction between hair and string: [Yehu] eqs. (13)-(20), (25), (46)-(53).

Differs: instead of a Newton iteration in two unknowns, which blows up under an
alternating bow force, one scalar equation in the relative velocity is solved inside a
bracket (decisions/0001).
"""

from __future__ import annotations

import math
from typing import Any

from yehu_server.jit import compiled
from yehu_server.physics.elementary import power_of_2, sine_and_cosine, slowing

TOLERANCE = 2e-13  # m/s, on the residual of the bristle velocity
MAX_ITERATIONS = 100
PER_LN_2 = 1.0 / math.log(2.0)


@compiled
def bristles_hold(v_r: float, z_bar: float, z_ba: float) -> bool:
    """Whether chi = 0: bristles move as the hair does. Eqs. (18), (19)."""
    return v_r * z_bar <= 0.0 or abs(z_bar) <= z_ba


@compiled
def imbalance(
    v_r: float,
    z_bar: tuple[float, float],
    z_dot: tuple[float, float],
    z_ba: float,
    reach: float,
    bow: Any,
) -> tuple[float, float, float, float, float, float]:
    """Return how far the law's dz/dt is from another one, and how that changes with v_r.

    Parameters
    ----------
    v_r : float, m/s
        Relative velocity.
    z_bar, z_dot : (m, s), (m/s, 1)
        Average bristle deflection and the other dz/dt, each with its derivative by v_r, which
        is taken for constant.
    z_ba, reach : float, m
        Breakaway deflection, and F_N / epsilon_0: the deflection at a friction of one.
    bow : record
        The model, for mu_C, mu_S, v_s.

    Returns
    -------
    residual, slope, curve : float, m/s, 1, s/m
        r - z_dot, its first and half its second derivative by v_r.
    by_z : float, 1/s
        The partial derivative of r by z_bar.
    room, closing : float, m and s
        |z_ss| - |z_bar|, at zero of which the curve leaps, and its derivative by v_r.

    Real time: safe. Source: [Yehu] eqs. (16)-(20).
    """
    z, turn = z_bar
    other, turn_other = z_dot
    if bristles_hold(v_r, z, z_ba):
        return v_r - other, 1.0 - turn_other, 0.0, 0.0, 1.0, 0.0
    side = math.copysign(1.0, z)  # and of v_r
    deflection, turn = abs(z), side * turn
    steepness = bow.per_v_s * bow.per_v_s
    stribeck = reach * (bow.mu_S - bow.mu_C) * power_of_2(v_r * v_r * (-PER_LN_2 * steepness))
    z_ss = reach * bow.mu_C + stribeck  # |z_ss|, eq. (17)
    fall = -2.0 * v_r * steepness
    dz_ss, ddz_ss = fall * stribeck, (fall * fall - 2.0 * steepness) * stribeck
    per_z_ss = 1.0 / z_ss
    w = deflection * per_z_ss
    dw = (turn - w * dz_ss) * per_z_ss
    ddw = (-2.0 * dw * dz_ss - w * ddz_ss) * per_z_ss
    room, closing = z_ss - deflection, dz_ss - turn
    per_width, sine, cosine, dangle, ddangle = 0.0, 1.0, 0.0, 0.0, 0.0
    if room > 0.0:
        per_width = 1.0 / (stribeck + (reach * bow.mu_C - z_ba))
        place = (deflection - 0.5 * (z_ss + z_ba)) * per_width
        sine, cosine = sine_and_cosine(place)
        part = place + 0.5  # of the way from breakaway to z_ss
        dangle = math.pi * (turn - part * dz_ss) * per_width
        ddangle = (-math.pi * part * ddz_ss - 2.0 * dangle * dz_ss) * per_width
    # Eq. (20): chi = (1 + sine)/2. All that does not wait for sine and cosine is done apart.
    rise = 1.0 + sine
    half, dhalf = 0.5 * (v_r * w), 0.5 * (w + v_r * dw)  # of v_r |z_bar / z_ss|
    swing = half * dangle
    residual = (v_r - other) - half * rise
    slope = (1.0 - turn_other - swing * cosine) - dhalf * rise
    curve = -0.5 * (swing * dangle) - (dangle * dhalf + 0.5 * (half * ddangle)) * cosine
    curve += 0.5 * (swing * dangle - dw - 0.5 * (v_r * ddw)) * rise
    by_z = -0.5 * abs(v_r) * (math.pi * w * per_width * cosine + per_z_ss * rise)
    return residual, slope, curve, by_z, room, closing


@compiled
def most_sudden(
    bow: Any, string: int, compliance: float, F_N: float, limit: float
) -> tuple[float, float]:
    """Bound the third derivative of r as a solve goes through it: 6 jolt (1 + |v_r| per_v).

    The law changes nowhere faster than chi does over the breakaway and z_ss over v_s.
    Returns: per_v (s/m), jolt (s^2/m^2), where |z_bar| is below `limit` (m).
    """
    per_F_N = 1.0 / F_N
    per_v = bow.sharpness[string] * per_F_N * (1.0 / compliance) + 2.0 * bow.per_v_s
    w = limit * bow.epsilon_0 / bow.mu_C * per_F_N  # the most of |z_bar / z_ss|
    return per_v, (1.0 + w) * per_v * per_v / 6.0


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
    max(1.2 mu_S F_N / epsilon_0, |z|), so Halley's method is kept between them.

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
    epsilon_0, stiffness = bow.epsilon_0, bow.stiffness
    rate, half_k = 2.0 * bow.rate, 0.5 * bow.k
    damping = rate * bow.epsilon_1
    per_F_N = 1.0 / F_N
    per_gamma = bow.epsilon_1 / bow.mu_C * per_F_N
    per_gamma_2 = per_gamma * per_gamma
    reach = F_N / epsilon_0
    z_ba = bow.xi[string] * bow.mu_C * reach
    per_compliance = 1.0 / compliance

    # Bristles that hold are linear but for epsilon_1(v_r), which takes one more step where it
    # falls off only slightly.
    pulled = free - compliance * epsilon_0 * z
    firmness = 1.0 + compliance * stiffness * half_k  # pulled / v_r
    per_firmness = 1.0 / firmness
    v_r = pulled * per_firmness
    if bristles_hold(pulled, firmness * z + pulled * half_k, firmness * z_ba):
        excess = compliance * bow.epsilon_1 * per_firmness
        slow = slowing((pulled * (per_firmness * per_gamma)) ** 2)
        step = v_r + v_r * excess * slow
        f_b = (free - v_r) * per_compliance - v_r * (excess * per_compliance) * slow
        z_bar = z + step * half_k
        # That leaves less than 4 |v_r| excess^2: a hundredth of the tolerance is as good as exact.
        excess *= slow
        if 400.0 * abs(v_r) * excess * excess <= TOLERANCE and bristles_hold(step, z_bar, z_ba):
            return f_b, z_bar, step, (0.0, 1.0, 0.0), 1, True
    else:
        t_0, t_v, t_z = tangent
        per_z = stiffness / (rate - t_z)
        v_r = free + compliance * (damping * z - per_z * (t_0 + rate * z))
        v_r *= 1.0 / (1.0 + compliance * (per_z * t_v))
    limit = max(1.2 * bow.mu_S * reach, abs(z))
    low = free - compliance * (epsilon_0 * limit + damping * (limit - z))
    high = free + compliance * (epsilon_0 * limit + damping * (limit + z))
    v_r = min(max(v_r, low), high)

    per_v, jolt = most_sudden(bow, string, compliance, F_N, limit)
    # Half the most that epsilon_1(v_r) makes of the second derivative of z_bar, times rate.
    fastest = max(high, -low)
    sag = damping * rate * (limit + per_compliance * fastest / epsilon_0)
    sag *= per_gamma_2 / epsilon_0

    iterations = 0
    converged = False
    f_b, z_bar, r, slope, by_z, turn = 0.0, z, 0.0, 1.0, 0.0, 0.0
    at_rest = free * per_compliance - epsilon_0 * z
    while True:
        iterations += 1
        # Eqs. (25) and (46): z_bar - z is what the bristles' spring leaves of f_b, times ease.
        slow = slowing(v_r * v_r * per_gamma_2)
        ease = 1.0 / (stiffness - damping * slow)
        left = at_rest - v_r * per_compliance
        moved = left * ease
        z_bar = z + moved
        dslow = (1.0 - slow) ** 3 * per_gamma_2 * v_r
        turn = (moved * damping * dslow - per_compliance) * ease
        r = rate * moved
        residual, slope, curve, by_z, room, closing = imbalance(
            v_r, (z_bar, turn), (r, rate * turn), z_ba, reach, bow
        )
        f_b = (free - v_r) * per_compliance  # eq. (49)
        if abs(residual) <= TOLERANCE * max(1.0, abs(r)):
            converged = True
            break
        if iterations == MAX_ITERATIONS:
            break
        if residual > 0.0:
            high = v_r
        else:
            low = v_r
        steep_2 = slope * slope
        way = -residual * slope / max(steep_2 - residual * curve, 0.5 * steep_2)
        step = v_r + way
        is_inside = low < step < high
        missed = curve * curve * abs(residual)
        missed += (jolt * (1.0 + abs(v_r) * per_v) * abs(way) + sag) * steep_2
        missed *= way * way
        if is_inside and missed <= TOLERANCE * steep_2 and room * (room + closing * way) > 0.0:
            held = bristles_hold(v_r, z_bar, z_ba)
            v_r, z_bar = step, z_bar + way * turn
            if bristles_hold(v_r, z_bar, z_ba) == held:  # else a corner of the law is between
                f_b -= way * per_compliance
                converged = True
                break
            continue
        # Where the law is steep Halley's method can creep: then halve, so that a step
        # always ends well before MAX_ITERATIONS.
        creeping = iterations > 12 and iterations % 2 == 0
        if creeping or not is_inside:
            step = 0.5 * (low + high)
            if not low < step < high:  # the bracket is down to neighbouring floats
                converged = abs(residual) <= 1e3 * TOLERANCE * max(1.0, abs(r))
                break
        v_r = step
    by_v = slope + (rate - by_z) * turn
    tangent = rate * (z_bar - z) - by_v * v_r - by_z * z_bar, by_v, by_z
    return f_b, z_bar, v_r, tangent, iterations, converged
