"""Elasto-plastic friction between hair and string: [Yehu] eqs. (13)-(20), (25), (46)-(49).

Differs: instead of the Newton iteration in two unknowns of (51)-(53), which diverges under an
alternating bow force, one scalar equation in the relative velocity is solved within a
bracket (decisions/0001).
Derivation: docs/derivation.md, section 6.
"""

import math

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.elementary import (
    kernel_exp2,
    kernel_sincospi,
    log,
    one_minus_inverse_root,
)
from yehu_server.core.physics.records import Model

TOLERANCE = 2e-13  # m/s, on the residual of the bristle velocity
MAX_ITERATIONS = 100
PER_LN_2 = 1.0 / log(2.0)

Tangent = tuple[float, float, float]


@compiled
def is_elastic(v_r: float, z_bar: float, z_ba: float) -> bool:
    """Whether chi = 0: bristles do not slip, and move as the hair does. Eqs. (18), (19)."""
    return v_r * z_bar <= 0.0 or abs(z_bar) <= z_ba


@compiled
def bristle_residual(
    v_r: float,
    z_bar: tuple[float, float],
    z_dot: tuple[float, float],
    z_ba: float,
    deflection_at_1: float,
    mu_S: float,
    m: Model,
) -> tuple[float, float, float, float, float, float]:
    """Return how far the law's dz/dt is from another one, and how that changes with v_r.

    Parameters
    ----------
    v_r : float, m/s
        Relative velocity.
    z_bar, z_dot : (m, s), (m/s, 1)
        Average bristle deflection and the other dz/dt, each with its derivative by v_r, which
        is taken for constant.
    z_ba, deflection_at_1 : float, m
        Breakaway deflection, and F_N / epsilon_0: the deflection at a friction coefficient of one.
    mu_S : float
        Static friction coefficient, as hot as the contact is.
    m : record
        The model, for mu_C and v_s.

    Returns
    -------
    residual, slope, curve : float, m/s, 1, s/m
        r - z_dot, its first and half its second derivative by v_r.
    by_z : float, 1/s
        The partial derivative of r by z_bar.
    below_z_ss, below_z_ss_slope : float, m, s
        |z_ss| - |z_bar|, at zero of which the curve has a corner, and its derivative by v_r.

    Real time: safe. Source: [Yehu] eqs. (16)-(20).
    """
    z, dz = z_bar
    other, dother = z_dot
    if is_elastic(v_r, z, z_ba):
        return v_r - other, 1.0 - dother, 0.0, 0.0, 1.0, 0.0
    side = math.copysign(1.0, z)  # and of v_r
    deflection, dz = abs(z), side * dz
    steepness = m.per_v_s * m.per_v_s
    mu_range = mu_S - m.mu_C
    stribeck = deflection_at_1 * mu_range * kernel_exp2(v_r * v_r * (-PER_LN_2 * steepness))
    z_ss = deflection_at_1 * m.mu_C + stribeck  # |z_ss|, eq. (17)
    dlog_stribeck = -2.0 * v_r * steepness
    dz_ss, ddz_ss = (
        dlog_stribeck * stribeck,
        (dlog_stribeck * dlog_stribeck - 2.0 * steepness) * stribeck,
    )
    per_z_ss = 1.0 / z_ss
    ratio = deflection * per_z_ss
    dratio = (dz - ratio * dz_ss) * per_z_ss
    ddratio = (-2.0 * dratio * dz_ss - ratio * ddz_ss) * per_z_ss
    below_z_ss, below_z_ss_slope = z_ss - deflection, dz_ss - dz
    per_width, sine, cosine, dangle, ddangle = 0.0, 1.0, 0.0, 0.0, 0.0
    if below_z_ss > 0.0:
        per_width = 1.0 / (stribeck + (deflection_at_1 * m.mu_C - z_ba))
        half_turns = (deflection - 0.5 * (z_ss + z_ba)) * per_width
        sine, cosine = kernel_sincospi(half_turns)
        part = half_turns + 0.5  # 0 at breakaway, 1 at z_ss
        dangle = math.pi * (dz - part * dz_ss) * per_width
        ddangle = (-math.pi * part * ddz_ss - 2.0 * dangle * dz_ss) * per_width
    # Eq. (20): chi = rise/2. What does not depend on sine and cosine is grouped apart.
    rise = 1.0 + sine
    half, dhalf = 0.5 * (v_r * ratio), 0.5 * (ratio + v_r * dratio)  # of v_r |z_bar / z_ss|
    turn = half * dangle
    residual = (v_r - other) - half * rise
    slope = (1.0 - dother - turn * cosine) - dhalf * rise
    curve = -0.5 * (turn * dangle) - (dangle * dhalf + 0.5 * (half * ddangle)) * cosine
    curve += 0.5 * (turn * dangle - dratio - 0.5 * (v_r * ddratio)) * rise
    by_z = -0.5 * abs(v_r) * (math.pi * ratio * per_width * cosine + per_z_ss * rise)
    return residual, slope, curve, by_z, below_z_ss, below_z_ss_slope


@compiled
def bound_third_derivative(
    m: Model, string: int, mobility: float, F_N: float, limit: float
) -> tuple[float, float]:
    """Bound the third derivative of r along a solve by 6 jerk (1 + |v_r| per_v).

    The law changes nowhere faster than chi does over the breakaway and z_ss over v_s.
    Returns: per_v (s/m), jerk (s^2/m^2), where |z_bar| is below `limit` (m).
    """
    per_F_N = 1.0 / F_N
    per_v = m.chi_slope[string] * per_F_N * (1.0 / mobility) + 2.0 * m.per_v_s
    ratio = limit * m.epsilon_0 / m.mu_C * per_F_N  # the largest |z_bar / z_ss|
    return per_v, (1.0 + ratio) * per_v * per_v / 6.0


@compiled
def solve_elastic(
    free: float, mobility: float, z: float, z_ba: float, per_gamma: float, m: Model
) -> tuple[bool, bool, float, float, float, float]:
    """Solve friction as if bristles did not slip (chi = 0).

    That is linear except for epsilon_1(v_r), which takes one more step where it decreases slightly.
    Returns whether bristles do not slip there and one step was enough, then f_b (N), z_bar (m), v_r
    and the linear solution (m/s).
    """
    half_k = 0.5 * m.k
    per_mobility = 1.0 / mobility
    load = free - mobility * m.epsilon_0 * z
    divisor = 1.0 + mobility * m.bristle_stiffness * half_k  # load / v_r
    per_divisor = 1.0 / divisor
    start = load * per_divisor
    if not is_elastic(load, divisor * z + load * half_k, divisor * z_ba):
        return False, False, 0.0, 0.0, 0.0, start
    damped = mobility * m.epsilon_1 * per_divisor
    damping_lost = one_minus_inverse_root((load * (per_divisor * per_gamma)) ** 2)
    v_r = start + start * damped * damping_lost
    f_b = (free - start) * per_mobility - start * (damped * per_mobility) * damping_lost
    z_bar = z + v_r * half_k
    # What is left is below 4 |v_r| damped^2: a hundredth of the tolerance is as good as exact.
    damped *= damping_lost
    exact = 400.0 * abs(start) * damped * damped <= TOLERANCE and is_elastic(v_r, z_bar, z_ba)
    return True, exact, f_b, z_bar, v_r, start


@compiled
def start_at_tangent(free: float, mobility: float, z: float, tangent: Tangent, m: Model) -> float:
    """Return the v_r (m/s) where the last step's tangent of the law meets this step's eq. (49)."""
    two_per_k = 2.0 * m.rate
    t_0, t_v, t_z = tangent
    f_b_per_r = m.bristle_stiffness / (two_per_k - t_z)
    v_r = free + mobility * (two_per_k * m.epsilon_1 * z - f_b_per_r * (t_0 + two_per_k * z))
    return float(v_r * (1.0 / (1.0 + mobility * (f_b_per_r * t_v))))


@compiled
def bracket(
    free: float, mobility: float, z: float, deflection_at_1: float, m: Model
) -> tuple[float, float, float]:
    """Return velocities (m/s) between which the equation changes sign, and a limit (m).

    |z_bar| reaches that limit at both; it exceeds it where epsilon_1 falls off with v_r, by 0.06 %
    with the measured epsilon_1.
    """
    epsilon_0, damping = m.epsilon_0, 2.0 * m.rate * m.epsilon_1
    limit = max(1.2 * m.mu_S * deflection_at_1, abs(z))
    low = free - mobility * (epsilon_0 * limit + damping * (limit - z))
    high = free + mobility * (epsilon_0 * limit + damping * (limit + z))
    return low, high, limit


@compiled
def eliminate_z_bar(
    v_r: float, force_at_rest: float, per_mobility: float, per_gamma_2: float, m: Model
) -> tuple[float, float]:
    """Return z_bar - z (m) and its derivative by v_r (s), from eqs. (25), (46), (49).

    `force_at_rest` (N) is f_b of (49) at v_r = 0, less the bristles' spring force epsilon_0 z.
    """
    damping = 2.0 * m.rate * m.epsilon_1
    damping_lost = one_minus_inverse_root(v_r * v_r * per_gamma_2)
    per_stiffness = 1.0 / (m.bristle_stiffness - damping * damping_lost)
    z_change = (force_at_rest - v_r * per_mobility) * per_stiffness
    ddamping_lost = (1.0 - damping_lost) ** 3 * per_gamma_2 * v_r
    return z_change, (z_change * damping * ddamping_lost - per_mobility) * per_stiffness


@compiled
def power_off_law(
    m: Model, string: int, F_N: float, mu_S: float, f_b: float, v_r: float, z_bar: float, r: float
) -> float:
    """Return how much more friction takes than its law says at v_r (W).

    The power f_b v_r - epsilon_0 z_bar r, less that with the law's f_b and r: zero but for
    rounding where the friction of the step is solved.
    """
    z_ba = m.xi[string] * m.mu_C * F_N / m.epsilon_0
    residual = bristle_residual(v_r, (z_bar, 0.0), (r, 0.0), z_ba, F_N / m.epsilon_0, mu_S, m)[0]
    lost = one_minus_inverse_root((v_r * m.epsilon_1 / (m.mu_C * F_N)) ** 2)
    law = m.epsilon_0 * z_bar + m.epsilon_1 * (1.0 - lost) * (r + residual)
    return float((f_b - law) * v_r + m.epsilon_0 * z_bar * residual)


@compiled
def solve_friction(
    free: float,
    mobility: float,
    z: float,
    F_N: float,
    mu_S: float,
    tangent: Tangent,
    m: Model,
    string: int,
) -> tuple[float, float, float, Tangent, int, bool]:
    """Find the friction force of one step.

    Eliminating z_bar from v_r = free - mobility * f_b, eqs. (46) and (49), leaves one
    equation, r(v_r, z_bar(v_r)) = 2 (z_bar - z)/k. Its left side minus its right one
    changes sign between the velocities at which |z_bar| reaches
    max(1.2 mu_S F_N / epsilon_0, |z|), so Halley's method is kept between them.

    Parameters
    ----------
    free : float, m/s
        Relative velocity without friction, s - v_b of eq. (49).
    mobility : float, m/s/N
        The factor of f_b in eq. (49).
    z : float, m
        Bristle deflection half a step ago.
    F_N : float, N
        Normal force, positive.
    mu_S : float
        Static friction coefficient now; at most the model's.
    tangent : (m/s, 1, 1/s)
        Where to start: the law r = t_0 + t_v v_r + t_z z_bar, linearised at the last solution.
    m, string
        The model's record, and which string is bowed (0 or 1).

    Returns
    -------
    f_b, z_bar, v_r : float, N, m, m/s
    tangent : (m/s, 1, 1/s)
        For the next step.
    iterations : int
        Number of evaluations of the law.
    converged : bool
        Whether the residual is below 2e-13 m/s (relative above 1 m/s), or below 2e-10 where
        the bracket is down to neighbouring numbers.

    Real time: safe; at most 100 evaluations of the law.
    """
    two_per_k = 2.0 * m.rate
    per_F_N, per_mobility = 1.0 / F_N, 1.0 / mobility
    per_gamma = m.epsilon_1 / m.mu_C * per_F_N  # gamma of eq. (25)
    per_gamma_2 = per_gamma * per_gamma
    deflection_at_1 = F_N / m.epsilon_0
    z_ba = m.xi[string] * m.mu_C * deflection_at_1

    elastic, exact, f_b, z_bar, v_r, start = solve_elastic(free, mobility, z, z_ba, per_gamma, m)
    if exact:
        return f_b, z_bar, v_r, (0.0, 1.0, 0.0), 1, True
    if not elastic:
        start = start_at_tangent(free, mobility, z, tangent, m)
    low, high, limit = bracket(free, mobility, z, deflection_at_1, m)
    v_r = min(max(start, low), high)

    per_v, jerk = bound_third_derivative(m, string, mobility, F_N, limit)
    # Half the largest part of epsilon_1(v_r) in the second derivative of z_bar, times rate.
    fastest = max(high, -low)
    damping_curve = (
        two_per_k * m.epsilon_1 * two_per_k * (limit + per_mobility * fastest / m.epsilon_0)
    )
    damping_curve *= per_gamma_2 / m.epsilon_0

    iterations = 0
    converged = False
    f_b, z_bar, r, slope, by_z, dz = 0.0, z, 0.0, 1.0, 0.0, 0.0
    force_at_rest = free * per_mobility - m.epsilon_0 * z
    while True:
        iterations += 1
        z_change, dz = eliminate_z_bar(v_r, force_at_rest, per_mobility, per_gamma_2, m)
        z_bar = z + z_change
        r = two_per_k * z_change
        residual, slope, curve, by_z, below_z_ss, below_z_ss_slope = bristle_residual(
            v_r, (z_bar, dz), (r, two_per_k * dz), z_ba, deflection_at_1, mu_S, m
        )
        f_b = (free - v_r) * per_mobility  # eq. (49)
        if abs(residual) <= TOLERANCE * max(1.0, abs(r)):
            converged = True
            break
        if iterations == MAX_ITERATIONS:
            break
        if residual > 0.0:
            high = v_r
        else:
            low = v_r
        # Halley's step, and a bound on the residual that it leaves.
        slope_2 = slope * slope
        step = -residual * slope / max(slope_2 - residual * curve, 0.5 * slope_2)
        reached = v_r + step
        is_inside = low < reached < high
        error_bound = curve * curve * abs(residual)
        error_bound += (jerk * (1.0 + abs(v_r) * per_v) * abs(step) + damping_curve) * slope_2
        error_bound *= step * step
        if (
            is_inside
            and error_bound <= TOLERANCE * slope_2
            and below_z_ss * (below_z_ss + below_z_ss_slope * step) > 0.0
        ):
            was_elastic = is_elastic(v_r, z_bar, z_ba)
            v_r, z_bar = reached, z_bar + step * dz
            if is_elastic(v_r, z_bar, z_ba) == was_elastic:  # else a corner of the law is between
                f_b -= step * per_mobility
                converged = True
                break
            continue
        # Where the law is steep Halley's method can be slow: then bisect, so that a solve
        # always ends well before MAX_ITERATIONS.
        is_slow = iterations > 12 and iterations % 2 == 0
        if is_slow or not is_inside:
            reached = 0.5 * (low + high)
            if not low < reached < high:  # the bracket is down to neighbouring floats
                converged = abs(residual) <= 1e3 * TOLERANCE * max(1.0, abs(r))
                break
        v_r = reached
    by_v = slope + (two_per_k - by_z) * dz
    tangent = two_per_k * (z_bar - z) - by_v * v_r - by_z * z_bar, by_v, by_z
    return f_b, z_bar, v_r, tangent, iterations, converged
