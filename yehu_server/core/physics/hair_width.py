"""Hair of some width: several points across it, each with its own strip of hair and of rosin.

A point has an equal share of the bow force, and of the mass, stiffness and damping of hair and
bristles; its own deflections, and its own temperature. Points near each other would slip at
different times, since the string moves differently under each: they act on each other through the
string. Forces here are those of a strip times the number of strips, so that every one obeys the
very law of the whole hair, and

    v_e = free_e - sum of mobility[e, q] f_q.

The mobilities are symmetric and positive definite. While friction rises with v_r the forces are
where a convex function is least, and solving one point after the other, each exactly, comes nearer
to it by every solve. Where friction falls steeply that may go in circles: then another function
is lowered, whose minima are solutions, too (`descend`). What is not solved by MAX_EVALUATIONS of
the law stays passive (`release_points`).

Differs: [Yehu] has one point.
Source: [Pitteroff]; [Maestre]. Derivation: docs/derivation.md, section 9.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.bow import STEEPEST
from yehu_server.core.physics.contacts import place_hair
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.friction import power_off_law, solve_friction
from yehu_server.core.physics.friction_curve import curve_force, solve_curve
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import LEVELS, POINT, STRINGS
from yehu_server.core.physics.records import Contacts, Model, Motion, Refined, State, Work
from yehu_server.core.physics.rosin_heat import static_coefficient
from yehu_server.core.physics.torsion import twist_travel

TOLERANCE = 1e-12  # m/s, by which the last solves change the velocities of the others
MAX_TURNS, MAX_WEIGHTS = 30, 30
MAX_EVALUATIONS = 12_000  # for a sample: some 0.2 ms; 20 to 90 are enough for most
ENOUGH = 0.8  # of a slope: both together over two are then a tenth of it


def prepare_width(refined: Any, quantities: Quantities) -> None:
    """Write the points into `refined`, each in the middle of its strip."""
    width = quantities.bow.width
    points = round(quantities.bow.points) if width > 0.0 else 1
    refined["points"], refined["share"] = points, 1.0 / points
    refined["offset"][:points] = width * ((np.arange(points) + 0.5) / points - 0.5)


@compiled
def place_points(model: Model, c: Contacts, t: Refined, i: int, x_b: float) -> None:
    """Put the points onto string `i` around `x_b` (m)."""
    for e in range(t.points):
        p, x = POINT + e, x_b + t.offset[e]
        if c.placed == 0 or c.x[p] != x or c.string[p] != i:
            place_hair(model, c, p, i, x)


@compiled
def lift_points(m: Model, t: Refined, w: Work, string: int, bowed: bool) -> None:
    """Take the deflection of bristles that are off the string; record its energy as a loss."""
    for e in range(t.points):
        for i in range(STRINGS):
            if t.z[e, i] != 0.0 and not (bowed and i == string):
                w.dropped_z += 0.5 * t.share * m.epsilon_0 * t.z[e, i] * t.z[e, i]
                t.z[e, i] = 0.0


@compiled
def point_velocity(m: Model, s: Motion, c: Contacts, t: Refined, e: int, next_: int) -> float:
    """Return the velocity of the string's surface on the hair at point `e`, bow at rest (m/s)."""
    p, prev = POINT + e, (next_ + 1) % LEVELS
    i = c.string[p]
    travel = interpolate(s.u[next_, i], c.first[p], c.weights[p])
    travel -= interpolate(s.u[prev, i], c.first[p], c.weights[p])
    travel += t.zeta[next_, e, i] - t.zeta[prev, e, i] + twist_travel(t, i, STRINGS + e, next_)
    return float(0.5 * m.rate * travel)


@compiled
def solve_points(m: Model, state: State, t: Refined, string: int, F_N: float) -> int:
    """Solve the friction of all points, advance bristles; return how often the law was evaluated.

    Real time: safe; at most MAX_EVALUATIONS, and those of two solves of each point.
    """
    for e in range(t.points):
        t.mu_S[e] = static_coefficient(m, t.w[e, string])
    iterations, is_solved = solve_in_turn(m, t, string, F_N)
    if not is_solved and t.points > 1:
        iterations, is_solved = descend(m, t, string, F_N, iterations)
        if not is_solved:
            release_points(m, t, state.work, string)
    state.unconverged += 0 if is_solved else 1
    for e in range(t.points):
        t.r[e] = 2.0 * m.rate * (t.z_bar[e] - t.z[e, string])
        t.z[e, string] = 2.0 * t.z_bar[e] - t.z[e, string]
    return iterations


@compiled
def solve_point(
    m: Model, t: Refined, string: int, F_N: float, e: int, free: float, mobility: float
) -> tuple[int, bool]:
    """Solve v_r = free - mobility f_b of one point.

    Returns how often the law was evaluated, and whether the solve converged.
    """
    # Viscous friction is linear: the law proper sees a string that yields less.
    less = 1.0 / (1.0 + mobility * t.epsilon_2)
    free, mobility, iterations, converged = free * less, mobility * less, 1, True
    if t.is_hyperbolic:
        f_b, v_r = solve_curve(free, mobility, F_N, t.v_r[e], m)
    else:
        tangent = (t.tangent[e, 0], t.tangent[e, 1], t.tangent[e, 2])
        f_b, t.z_bar[e], v_r, tangent, iterations, converged = solve_friction(
            free, mobility, t.z[e, string], F_N, t.mu_S[e], tangent, m, string
        )
        t.tangent[e, 0], t.tangent[e, 1], t.tangent[e, 2] = tangent
    t.f_b[e], t.v_r[e] = f_b + t.epsilon_2 * v_r, v_r
    return iterations, converged


@compiled
def solve_in_turn(m: Model, t: Refined, string: int, F_N: float) -> tuple[int, bool]:
    """Solve one point after the other, with the forces of the others, until none changes.

    Returns how often the law was evaluated, and whether all points are solved.
    """
    iterations, is_solved = 0, False
    for _ in range(MAX_TURNS):
        change, is_solved = 0.0, True
        for e in range(t.points):
            free, before = t.free[e], t.f_b[e]
            for other in range(t.points):
                if other != e:
                    free -= t.mobility[e, other] * t.f_b[other]
            again, converged = solve_point(m, t, string, F_N, e, free, t.mobility[e, e])
            iterations += again
            is_solved = is_solved and converged
            change = max(change, abs(t.f_b[e] - before) * t.mobility[e, e])
        if t.points == 1 or change <= TOLERANCE:
            return iterations, is_solved
        if iterations >= MAX_EVALUATIONS:
            break
    return iterations, is_solved and change <= 100.0 * TOLERANCE


@compiled
def descend(m: Model, t: Refined, string: int, F_N: float, iterations: int) -> tuple[int, bool]:
    """Solve all points where friction falls so steeply with v_r that turns go in circles.

    The velocities are where Phi = (v - free) K (v - free)/2 + sum of the integrals of f_e(v_e) has
    a minimum, K being the inverse of the mobilities. With a weight c on the change of each, c above
    the steepest fall of f_e, a point has one solution only, and each solve lowers Phi by
    c/2 times the change squared at least: so changes go to zero, whatever friction does. A step of
    Newton's for all points together comes between. It is taken back where Phi has not fallen by a
    tenth of what its slope promised, as the slopes at both ends tell.
    `iterations`: how often the law was evaluated before. Returns as `solve_in_turn`.
    """
    invert_mobility(t)
    c = STEEPEST * 0.5 * m.k * m.epsilon_0 + m.epsilon_1
    has_stepped, weight = False, 0.0
    while True:
        is_solved = True
        for e in range(t.points):
            load = c * t.v_r[e]
            for other in range(t.points):
                load += t.stiffness[e, other] * t.free[other]
                if other != e:
                    load -= t.stiffness[e, other] * t.v_r[other]
            mobility = 1.0 / (t.stiffness[e, e] + c)
            again, converged = solve_point(m, t, string, F_N, e, load * mobility, mobility)
            iterations += again
            is_solved = is_solved and converged
        off, rise = 0.0, 0.0
        for e in range(t.points):
            v_r, slope = t.free[e], t.f_b[e]  # of Phi
            for other in range(t.points):
                v_r -= t.mobility[e, other] * t.f_b[other]
                slope += t.stiffness[e, other] * (t.v_r[other] - t.free[other])
            off = max(off, abs(v_r - t.v_r[e]))
            rise += (t.v_r[e] - t.v_kept[e]) * (slope + ENOUGH * t.slope[e])
            t.newton[e, t.points] = -slope
        if off <= TOLERANCE or iterations >= MAX_EVALUATIONS:
            return iterations, is_solved and off <= 100.0 * TOLERANCE
        if has_stepped and rise >= 0.0:
            has_stepped, weight = False, max(0.01 * c, 4.0 * weight)
            for e in range(t.points):
                t.v_r[e] = t.v_kept[e]
            continue
        for e in range(t.points):
            t.v_kept[e], t.slope[e] = t.v_r[e], -t.newton[e, t.points]
        weight = step_all(m, t, weight, c)
        has_stepped, weight = True, 0.25 * weight if weight > 1e-3 * c else 0.0


@compiled
def release_points(m: Model, t: Refined, w: Work, string: int) -> None:
    """Let the hair go for a sample, where forces that are not solved would give energy.

    They would where what they take at the string's velocities is less than at those of the law. The
    bristles' energy is recorded as a loss.
    """
    taken = 0.0
    for e in range(t.points):
        v_r = t.free[e]
        for other in range(t.points):
            v_r -= t.mobility[e, other] * t.f_b[other]
        taken += t.f_b[e] * (v_r - t.v_r[e])
    if taken >= 0.0:
        return
    for e in range(t.points):
        w.dropped_z += 0.5 * t.share * m.epsilon_0 * t.z[e, string] * t.z[e, string]
        t.z[e, string] = t.z_bar[e] = t.f_b[e] = 0.0
        t.v_r[e] = t.free[e]


@compiled
def step_all(m: Model, t: Refined, weight: float, c: float) -> float:
    """Take Newton's step for all points, by the tangents of their laws.

    It is shortened by a weight, and by a larger one where Phi bends down, so that it goes downhill:
    Levenberg's and Marquardt's way. Returns the weight.
    """
    n, A = t.points, t.newton
    is_downhill = False
    for _ in range(MAX_WEIGHTS):
        is_downhill = True
        for e in range(n):
            A[e, n] = -t.slope[e]
            for q in range(n):
                A[e, q] = t.stiffness[e, q]
            rise = m.bristle_stiffness * t.tangent[e, 1] / (2.0 * m.rate - t.tangent[e, 2])
            A[e, e] += rise + t.epsilon_2 + weight
        for pivot in range(n):
            is_downhill = is_downhill and A[pivot, pivot] > 0.0
            if not is_downhill:
                break
            for row in range(pivot + 1, n):
                factor = A[row, pivot] / A[pivot, pivot]
                for column in range(pivot, n + 1):
                    A[row, column] -= factor * A[pivot, column]
        if is_downhill:
            break
        weight = max(0.01 * c, 2.0 * weight)
    if not is_downhill:  # not even numbers
        return weight
    for e in range(n - 1, -1, -1):
        for q in range(e + 1, n):
            A[e, n] -= A[e, q] * A[q, n]
        A[e, n] /= A[e, e]
        t.v_r[e] += A[e, n]
    return weight


@compiled
def invert_mobility(t: Refined) -> None:
    """Write the inverse of the mobilities, which are symmetric and positive definite."""
    n, A = t.points, t.stiffness
    for row in range(n):
        for column in range(n):
            A[row, column] = t.mobility[row, column]
    for pivot in range(n):
        per_pivot = 1.0 / A[pivot, pivot]
        A[pivot, pivot] = 1.0
        for column in range(n):
            A[pivot, column] *= per_pivot
        for row in range(n):
            if row == pivot:
                continue
            factor = A[row, pivot]
            A[row, pivot] = 0.0
            for column in range(n):
                A[row, column] -= factor * A[pivot, column]


@compiled
def warm_points(m: Model, t: Refined, string: int, bowed: bool, F_N: float) -> None:
    """Advance the temperature of each point, as ``rosin_heat.warm`` does."""
    if m.is_thermal == 0:
        return
    for e in range(t.points):
        for i in range(STRINGS):
            heating = 0.0
            if bowed and i == string:
                heating = t.f_b[e] * t.v_r[e] - m.epsilon_0 * t.z_bar[e] * t.r[e]
                heating = max(0.0, heating / F_N)
            t.w[e, i] += m.cooled * (heating - t.w[e, i])


# ---------------------------------------------------------------- for the ledger


@compiled
def hair_energy(m: Model, t: Refined, next_: int, now: int) -> float:
    """Return the energy of hair and bristles at n + 1/2 (J)."""
    total = 0.0
    for e in range(t.points):
        for i in range(STRINGS):
            zeta_next, zeta = t.zeta[next_, e, i], t.zeta[now, e, i]
            total += 0.5 * m.M_h * (m.rate * (zeta_next - zeta)) ** 2
            total += 0.5 * m.K_h * (0.5 * (zeta_next + zeta)) ** 2
            total += 0.5 * m.epsilon_0 * t.z[e, i] ** 2
    return float(t.share * total)


@compiled
def hair_loss(m: Model, t: Refined, next_: int, prev: int) -> float:
    """Return what the damping of the hair takes (W)."""
    total = 0.0
    for e in range(t.points):
        for i in range(STRINGS):
            total += (0.5 * m.rate * (t.zeta[next_, e, i] - t.zeta[prev, e, i])) ** 2
    return float(t.share * m.R_h * total)


@compiled
def point_power_off_law(m: Model, c: Contacts, t: Refined, e: int, F_N: float, v_r: float) -> float:
    """As ``friction.power_off_law``, of point `e` by whatever law it has (W)."""
    f_b = t.f_b[e] - t.epsilon_2 * v_r
    if t.is_hyperbolic:
        return float((f_b - curve_force(m, F_N, f_b, t.v_r[e])) * v_r)
    i = c.string[POINT + e]
    return power_off_law(m, i, F_N, t.mu_S[e], f_b, v_r, t.z_bar[e], t.r[e])
