"""The time loop of an instrument with torsion, hair of some width, or another law of friction.

The step of kernel.py with several points in the place of the bow, each of which also twists the
string. It is apart from that one, so that an instrument without them pays nothing. All contacts
are solved jointly; the fingers are eliminated with a column for each point.
docs/derivation.md, sections 8 to 10.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics import hair_width, kernel, torsion
from yehu_server.core.physics.bow import (
    FRICTION_MARGIN,
    advance_hair,
    choose_string,
    friction_limit,
)
from yehu_server.core.physics.bridge import advance_bridge, eliminate_tension_and_bridge, move_modes
from yehu_server.core.physics.contacts import (
    compliance,
    free_displacement,
    move_strings,
    place_contacts,
    response,
)
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.elimination import (
    assemble_contacts,
    back_substitute_jointly,
    find_travel,
)
from yehu_server.core.physics.finger import advance_fingers, limit_gradients
from yehu_server.core.physics.friction_curve import prepare_friction
from yehu_server.core.physics.grid import interpolate, spread
from yehu_server.core.physics.layout import (
    BOW,
    ENERGY,
    ENERGY_ERROR,
    F_HAMMER,
    F_N,
    FRICTION_RESIDUAL,
    ITERATIONS,
    LEVELS,
    LOSS_FINGER,
    LOSS_FRICTION,
    LOSS_HAIR,
    LOSS_STRINGS,
    POINT,
    REFINED,
    STRINGS,
    V_B,
    V_R_RESIDUAL,
    X_B,
    new_record,
)
from yehu_server.core.physics.pluck import pluck
from yehu_server.core.physics.records import Array, Model, Records, Refined, State
from yehu_server.core.physics.rosin_texture import grip
from yehu_server.core.physics.string import advance_strings, support
from yehu_server.errors import ParameterError


def prepare(quantities: Quantities, rate: float) -> Any:
    """What an instrument has besides ``kernel.prepare``, of dtype layout.REFINED, at rest, or None.

    Raises ParameterError where no torsional mode is low enough for the sample rate, hair with a
    hyperbolic friction has some width; where strings are ``planes.prepare``'s: modal, or in two
    directions.
    """
    if quantities.directions == "two":
        raise ParameterError("directions: strings move in two only for simulate and sweeps")
    if quantities.scheme == "modal":
        raise ParameterError("scheme: strings are modal only for simulate and sweeps")
    bow = quantities.bow
    is_plain = bow.width == 0.0 and bow.friction != "hyperbolic" and bow.epsilon_2 == 0.0
    if is_plain and quantities.torsion == "off":
        return None
    refined = new_record(REFINED)
    prepare_into(refined[0], quantities, rate)
    return refined


def prepare_into(refined: Any, quantities: Quantities, rate: float) -> None:
    """As `prepare`, into a record at rest, of any instrument."""
    prepare_friction(refined, quantities)
    hair_width.prepare_width(refined, quantities)
    if quantities.torsion == "on":
        torsion.prepare_torsion(refined, quantities, 1.0 / rate)


@compiled
def come_to_rest(t: Refined) -> None:
    """Put torsion, hair and rosin to rest. Real time: safe."""
    t.zeta[:], t.z[:], t.w[:], t.f_b[:], t.v_r[:] = 0.0, 0.0, 0.0, 0.0, 0.0
    t.tangent[:], t.twist[:] = 0.0, 0.0


@compiled
def advance(
    model: Records, state: Records, refined: Records, controls: Array, probes: Array
) -> None:
    """As ``kernel.advance``, with what `prepare` made; `state` and `refined` are changed.

    Friction force and relative velocity in the probes are the sum and the mean over the points.
    """
    m, s, t = model[0], state[0], refined[0]
    now = int(np.int64(s.motion.level))
    next_, prev = (now + 1) % LEVELS, (now + 2) % LEVELS
    for n in range(controls.shape[0]):
        step(m, s, t, controls[n], next_, now, prev)
        s.motion.level = next_
        kernel.measure(m, s, probes[n])
        if probes[n, ITERATIONS] < 0.0:  # lost
            come_to_rest(t)
        next_, now, prev = prev, next_, now


@compiled
def step(
    m: Model, state: State, t: Refined, control: Array, next_: int, now: int, prev: int
) -> None:
    """Advance strings, bridge, bow and fingers by one sample. See ``kernel.step``."""
    s, c, w = state.motion, state.contacts, state.work
    u_next, u, u_prev = s.u[next_], s.u[now], s.u[prev]
    w.dropped_z, w.dropped_Psi, w.z_bar, w.r = 0.0, 0.0, 0.0, 0.0
    advance_strings(m, s, w, u_next, u, u_prev)
    pluck(m, s, c, w, control, u_next)
    q_sum = advance_bridge(m, s.q[next_], s.q[now], s.q[prev], control[F_HAMMER])
    eliminate_tension_and_bridge(m, s, w, u_next, q_sum)

    string, bowed = choose_string(m, s, c, w, control[F_N])
    hair_width.lift_points(m, t, w, string, bowed)
    hair_width.place_points(m, c, t, string, control[X_B])
    place_contacts(m, c, control, string)
    near = advance_fingers(m, s, c, w, control, next_, now, prev)
    torsion.advance_torsion(m, t, c, w, near, next_, now, prev)

    # What each point would see without friction, and how friction moves it and the others.
    for e in range(t.points):
        p = POINT + e
        w.Delta_u_at[p] = interpolate(s.Delta_u[string], c.first[p], c.weights[p])
        for column, each in enumerate(response(c, w, p)):
            t.responses[e, column] = each
        advance_hair(m, t.zeta[next_, e], t.zeta[now, e], t.zeta[prev, e])
        torsion.yield_to_point(m, t, string, e, c.x[p])
        travel = free_displacement(c, w, u_next, p) - interpolate(
            u_prev[string], c.first[p], c.weights[p]
        )
        travel += t.zeta[next_, e, string] - t.zeta[prev, e, string]
        travel += torsion.twist_travel(t, string, STRINGS + e, next_)
        t.free[e] = 0.5 * m.rate * travel - control[V_B]
    for e in range(t.points):
        for q in range(t.points):
            G = compliance(m, c, w, POINT + e, POINT + q, response(c, w, POINT + q))
            G += torsion.read_twist(t, t.twist_shapes[STRINGS + e], t.twist_per_newton[q])
            G = t.share * G + (m.C_h if e == q else 0.0)
            t.mobility[e, q] = 0.5 * m.rate * G

    w.touching_count = 0
    if near > 0:
        eliminate_fingers(m, state, t, u_next, next_, near, bowed, control[F_N])
    F_N_now = abs(control[F_N]) * grip(m, s, c, control, now)
    w.F_N, w.iterations, s.f_b, s.v_r = F_N_now, 0, 0.0, 0.0
    for e in range(t.points if not bowed else 0):
        t.f_b[e], t.v_r[e] = 0.0, t.free[e]
    if bowed:
        w.iterations = hair_width.solve_points(m, state, t, string, F_N_now)
    for e in range(t.points):
        s.f_b += t.share * t.f_b[e]
        s.v_r += t.share * t.v_r[e]
    hair_width.warm_points(m, t, string, bowed, F_N_now)

    # All that the forces move.
    for i in range(STRINGS):
        for e in range(t.points):
            w.tau[i] += t.responses[e, i] * t.share * t.f_b[e]
            w.f_c[i] += t.responses[e, STRINGS + i] * t.share * t.f_b[e]
    back_substitute_fingers(m, state, t, next_)
    move_strings(m, s, c, w, u_next, near, bowed=False)
    for e in range(t.points):
        p, f = POINT + e, t.share * t.f_b[e]
        spread(u_next[string], c.first[p], c.weights[p], -m.spread[string] * f)
        t.zeta[next_, e, string] -= m.C_h * t.f_b[e]
        torsion.move_twist(t, string, e, next_, f)
    w.bridge_travel = move_modes(m, s.q[next_], s.q[prev], w.f_c)
    for i in range(STRINGS):
        support(u_next[i], m.N[i])


@compiled
def eliminate_fingers(
    m: Model,
    state: State,
    t: Refined,
    u_next: Array,
    next_: int,
    near: int,
    bowed: bool,
    F_N: float,
) -> None:
    """Eliminate the fingers' forces, until only those of the points are unknown.

    As ``elimination.eliminate_jointly``, with a column of G for each point.
    """
    s, c, w = state.motion, state.contacts, state.work
    c.is_chain = 0
    w.Delta_u_at[BOW] = interpolate(s.Delta_u[c.string[BOW]], c.first[BOW], c.weights[BOW])
    f_b, margin = 0.0, 0.0
    if bowed:
        viscous = FRICTION_MARGIN * t.epsilon_2 * abs(t.free[0])
        f_b, margin = s.f_b, abs(s.f_b) + friction_limit(m, F_N) + viscous
    # theta is found with the friction of the last step, in the middle of the hair.
    if find_travel(m, s, c, w, u_next, next_, near, response(c, w, BOW), f_b, margin):
        limit_gradients(s, c, w, near, f_b)
    assemble_contacts(m, s, c, w, near)
    count = w.touching_count
    end = count + t.points
    for e in range(t.points):
        e_response = response(c, w, POINT + e)
        for row in range(count):
            w.G[row, count + e] = compliance(m, c, w, w.touching[row], POINT + e, e_response)
    for row in range(count):
        per_pivot = 1.0 / (1.0 + w.A_f[row] * w.G[row, row])
        w.d[row] *= per_pivot
        w.A_f[row] *= per_pivot
        for other in range(row + 1, count):
            G = w.G[row, other]
            w.d[other] -= w.A_f[other] * G * w.d[row]
            for column in range(other, end):
                w.G[other, column] -= w.A_f[row] * G * w.G[row, column]
        for e in range(t.points):
            G = 0.5 * m.rate * w.G[row, count + e]
            t.free[e] -= G * w.d[row]
            for q in range(t.points):
                t.mobility[e, q] -= t.share * G * w.A_f[row] * w.G[row, count + q]


@compiled
def back_substitute_fingers(m: Model, state: State, t: Refined, next_: int) -> None:
    """Find the fingers' forces from those of the points.

    What all points move each contact by is folded into one column, that of one newton.
    """
    w = state.work
    count = w.touching_count
    for row in range(count):
        displacement = 0.0
        for e in range(t.points):
            displacement += w.G[row, count + e] * t.share * t.f_b[e]
        w.G[row, count] = displacement
    back_substitute_jointly(m, state.motion, state.contacts, w, next_, 1.0)


@compiled
def stored_energy(m: Model, t: Refined, next_: int, now: int) -> float:
    """The energy of torsion, hair and bristles at n + 1/2 (J)."""
    stored = hair_width.hair_energy(m, t, next_, now)
    for i in range(STRINGS):
        stored += torsion.torsion_energy(m, t, i, next_, now)
    return stored


@compiled
def record_points(
    m: Model, state: State, t: Refined, control: Array, before: float, row: Array
) -> float:
    """Write torsion, hair and friction of all points to the ledger, as ``energy.record_energy``."""
    s, c = state.motion, state.contacts
    next_, now, prev = s.level, (s.level + 2) % LEVELS, (s.level + 1) % LEVELS
    stored = stored_energy(m, t, next_, now)
    strings, finger, friction, residual, off_law = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(STRINGS):
        strings += torsion.torsion_loss(m, t, i, next_, prev)
        finger += torsion.skin_loss(m, t, i, next_)
    for e in range(t.points):
        v_r = hair_width.point_velocity(m, s, c, t, e, next_) - control[V_B]
        if abs(control[F_N]) >= m.lift_force and state.work.F_N > 0.0:
            friction += t.share * (t.f_b[e] * v_r - m.epsilon_0 * t.z_bar[e] * t.r[e])
            residual = max(residual, abs(v_r - t.v_r[e]))
            off_law += t.share * hair_width.point_power_off_law(m, c, t, e, state.work.F_N, v_r)
    hair = hair_width.hair_loss(m, t, next_, prev)
    losses = strings + finger + hair + friction - row[LOSS_FRICTION]
    row[ENERGY_ERROR] += (stored - before) * m.rate + losses
    row[ENERGY] += stored
    row[LOSS_STRINGS] += strings
    row[LOSS_FINGER] += finger
    row[LOSS_HAIR], row[LOSS_FRICTION] = hair, friction
    row[V_R_RESIDUAL], row[FRICTION_RESIDUAL] = residual, off_law
    return stored
