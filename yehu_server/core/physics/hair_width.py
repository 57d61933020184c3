"""Hair of some width: several points across it, each with its own strip of hair and of rosin.

A point has an equal share of the bow force, and of the mass, stiffness and damping of hair and
bristles; its own deflections, and its own temperature. Points near each other would slip at
different times, since the string moves differently under each: they act on each other through the
string. Forces here are those of a strip times the number of strips, so that every one obeys the
very law of the whole hair, and

    v_e = free_e - sum of mobility[e, q] f_q.

The mobilities are symmetric and positive definite, and a friction force rises with v_r where
`bow.friction_bound` is below 1. Then the forces are where a convex function is least, and solving
one point after the other, each exactly, comes nearer to it by every solve.

Differs: [Yehu] has one point.
Source: [Pitteroff]; [Maestre]. Derivation: docs/derivation.md, section 9.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.contacts import place_hair
from yehu_server.core.physics.friction import solve_friction
from yehu_server.core.physics.friction_curve import solve_curve
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import LEVELS, POINT, STRINGS
from yehu_server.core.physics.quantities import Quantities
from yehu_server.core.physics.records import Contacts, Model, Motion, Refined, State, Work
from yehu_server.core.physics.rosin_heat import static_coefficient
from yehu_server.core.physics.torsion import twist_travel

TOLERANCE = 1e-12  # m/s, by which the last solves change the velocities of the others
MAX_SWEEPS = 100


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
    """Solve the friction of all points; advance their bristles.

    Returns the number of evaluations of the law.

    Real time: safe; at most MAX_SWEEPS solves of each point.
    """
    iterations, sweeps, is_solved = 0, 0, True
    while True:
        change, sweeps, is_solved = 0.0, sweeps + 1, True
        for e in range(t.points):
            free, mobility = t.free[e], t.mobility[e, e]
            for other in range(t.points):
                if other != e:
                    free -= t.mobility[e, other] * t.f_b[other]
            # Viscous friction is linear: the law proper sees a string that yields less.
            less = 1.0 / (1.0 + mobility * t.epsilon_2)
            if t.is_hyperbolic:
                f_b, v_r = solve_curve(free * less, mobility * less, F_N, t.v_r[e], m)
                iterations += 1
            else:
                mu_S = static_coefficient(m, t.w[e, string])
                tangent = (t.tangent[e, 0], t.tangent[e, 1], t.tangent[e, 2])
                f_b, t.z_bar[e], v_r, tangent, again, converged = solve_friction(
                    free * less, mobility * less, t.z[e, string], F_N, mu_S, tangent, m, string
                )
                t.tangent[e, 0], t.tangent[e, 1], t.tangent[e, 2] = tangent
                iterations += again
                is_solved = is_solved and converged
            f_b += t.epsilon_2 * v_r
            change = max(change, abs(f_b - t.f_b[e]) * mobility)
            t.f_b[e], t.v_r[e] = f_b, v_r
        if t.points == 1 or change <= TOLERANCE or sweeps == MAX_SWEEPS:
            break
    if not is_solved or (t.points > 1 and change > 100.0 * TOLERANCE):
        state.unconverged += 1
    for e in range(t.points):
        t.r[e] = 2.0 * m.rate * (t.z_bar[e] - t.z[e, string])
        t.z[e, string] = 2.0 * t.z_bar[e] - t.z[e, string]
    return iterations


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
