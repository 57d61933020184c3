"""The time loop of an instrument whose strings move in two directions.

The step of refined.py, with its torsion, wide hair and laws of friction, on strings that also move
normal to the bow. All forces are one linear system (joint.py), but for friction, which is solved
with what the system leaves of it. Fingers and hair press normal to the bow; friction sees the
normal force of the step before.
docs/derivation.md, section 11.
"""

from yehu_server.compile.jit import compiled
from yehu_server.core.physics import kernel, press, refined, torsion
from yehu_server.core.physics.bow import advance_hair, choose_string
from yehu_server.core.physics.bridge import advance_bridge, move_modes
from yehu_server.core.physics.contacts import place_contacts
from yehu_server.core.physics.energy import string_energy, string_loss
from yehu_server.core.physics.finger import (
    advance_contact,
    advance_fingers,
    contact_stiffness,
    limited_gradient,
)
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.hair_width import lift_points, place_points, solve_points, warm_points
from yehu_server.core.physics.joint import (
    NO_FORCE,
    add_row,
    back_substitute,
    bridge_reads,
    eliminate,
    push_bridge,
    push_strings,
    write_strings,
)
from yehu_server.core.physics.layout import (
    BOW,
    CONSTRAINT_RESIDUAL,
    ENERGY,
    ENERGY_ERROR,
    F_HAMMER,
    F_N,
    GHOST,
    ITERATIONS,
    LEVELS,
    LOSS_BRIDGE,
    LOSS_FINGER,
    LOSS_HAIR,
    LOSS_STRINGS,
    POINT,
    POWER_IN,
    STRINGS,
    V_B,
    X_B,
    padded_length,
)
from yehu_server.core.physics.planes import BOWING, BRIDGE_ROW, CONTACT_ROW, NORMAL
from yehu_server.core.physics.pluck import pluck
from yehu_server.core.physics.records import Array, Model, Planes, Records, State
from yehu_server.core.physics.rosin_texture import grip
from yehu_server.core.physics.skin import advance_skin, let_go, prepare_skin, skin_power
from yehu_server.core.physics.string import advance_strings, support
from yehu_server.core.physics.tension import move_by_tension


@compiled
def come_to_rest(m: Model, d: Planes) -> None:
    """Put the second direction, and what refines friction, to rest. Real time: safe."""
    refined.come_to_rest(d.refined)
    n = d.normal
    n.u[:], n.Delta_u[:], n.q[:], n.Psi[:], n.resting[:] = 0.0, 0.0, 0.0, 0.0, 0
    n.U[:] = m.rest_height
    d.s[:], d.skin_velocity[:], d.f_n[:], d.Y[:] = 0.0, 0.0, 0.0, 0.0
    d.is_on, d.Psi = 0, 0.0


@compiled
def advance(
    model: Records, state: Records, planes: Records, controls: Array, probes: Array
) -> None:
    """As ``kernel.advance``, with what `planes.prepare` made; `state` and `planes` are changed.

    Fingers in the probes are those of the normal direction, the bridge's forces those along its
    measured motion.
    """
    m, s, d = model[0], state[0], planes[0]
    level = int(s.motion.level)
    next_, now, prev = (level + 1) % LEVELS, level, (level + 2) % LEVELS
    for row in range(controls.shape[0]):
        step(m, s, d, controls[row], next_, now, prev)
        s.motion.level = next_
        kernel.measure(m, s, probes[row])
        if probes[row, ITERATIONS] < 0.0:  # lost
            come_to_rest(m, d)
        next_, now, prev = prev, next_, now


@compiled
def step(
    m: Model, state: State, d: Planes, control: Array, next_: int, now: int, prev: int
) -> None:
    """Advance strings, bridge, bow and fingers by one sample."""
    s, n, c, w, wn, t = state.motion, d.normal, state.contacts, state.work, d.normal_work, d.refined
    w.dropped_z, w.dropped_Psi, wn.dropped_Psi, w.z_bar, w.r = 0.0, 0.0, 0.0, 0.0, 0.0
    advance_strings(m, s, w, s.u[next_], s.u[now], s.u[prev])
    advance_strings(m, n, wn, n.u[next_], n.u[now], n.u[prev])
    pluck(m, s, c, w, control, s.u[next_])
    q_sum = advance_bridge(m, s.q[next_], s.q[now], s.q[prev], control[F_HAMMER])
    p_sum = advance_bridge(m, n.q[next_], n.q[now], n.q[prev], 0.0)
    write_strings(m, d, s, n, w, wn, next_, q_sum, p_sum)

    # Places; fingers and bow without forces. Friction sees the normal force of the last step.
    string, is_pressed = choose_string(m, s, c, w, control[F_N])
    place_points(m, c, t, string, control[X_B])
    place_contacts(m, c, control, string)
    press.press_hair(m, d, c, n, w, control[F_N], is_pressed, next_, now, prev)
    d.F_N = max(0.0, d.f_n[BOW]) * grip(m, s, c, control, now)
    bowed = is_pressed and m.lift_force <= d.F_N
    lift_points(m, t, w, string, bowed)
    near = advance_fingers(m, n, c, wn, control, next_, now, prev)
    torsion.advance_torsion(m, t, c, wn, near, next_, now, prev)

    add_contacts(m, state, d, near, next_, prev)
    points = d.rows
    add_points(m, state, d, string, next_, now, prev)
    eliminate(d, 0, CONTACT_ROW)
    write_laws(m, d, bowed, points)
    eliminate(d, CONTACT_ROW, points)

    # What is left of the rows of friction is what each point feels.
    for e in range(t.points):
        t.free[e] = 0.5 * m.rate * d.b[points + e] - control[V_B]
        t.f_b[e] = t.f_b[e] if bowed else 0.0
        for q in range(t.points):
            G = t.share * d.G[points + min(e, q), points + max(e, q)] + (m.C_h if e == q else 0.0)
            t.mobility[e, q] = 0.5 * m.rate * G
    w.F_N, w.iterations, s.f_b, s.v_r = d.F_N if bowed else 0.0, 0, 0.0, 0.0
    if bowed:
        w.iterations = solve_points(m, state, t, string, d.F_N)
    for e in range(t.points):
        if not bowed:
            t.v_r[e], t.z_bar[e], t.r[e] = t.free[e], 0.0, 0.0
        d.x[points + e] = t.share * t.f_b[e]
        s.f_b += t.share * t.f_b[e]
        s.v_r += t.share * t.v_r[e]
    warm_points(m, t, string, bowed, d.F_N)
    back_substitute(d, points)
    move_all(m, state, d, string, points, next_, prev)


@compiled
def add_contacts(m: Model, state: State, d: Planes, near: int, next_: int, prev: int) -> None:
    """Add the forces of fingers, of their skin, and of the hair normal to the string."""
    s, n, c, w, wn = state.motion, d.normal, state.contacts, state.work, d.normal_work
    for p in range(STRINGS * m.fingers):
        wn.g[p] = 0.0
    for a in range(near):
        j = c.candidates[a]
        for i in range(STRINGS):
            p = STRINGS * j + i
            first, weights = c.first[p], c.weights[p]
            wn.g[p] = wn.ghat[p]
            if wn.ghat[p] == 0.0:
                continue
            row = d.rows
            add_row(m, d, s, n, NORMAL, i, p, first, weights, 1.0)
            d.b[row] = interpolate(n.u[next_, i], first, weights) - n.U[next_, j] - wn.eta_prev[p]
            for other in range(CONTACT_ROW, row + 1):
                if d.plane[other] == NORMAL and d.contact[other] // STRINGS == j:
                    d.G[row, other] += m.C_f
                    if other != row:
                        d.G[other, row] += m.C_f
            if d.f_n[p] > 0.0:
                row = d.rows
                add_row(m, d, s, n, BOWING, i, p, first, weights, 1.0)
                d.b[row] = interpolate(s.u[next_, i], first, weights)
                d.b[row] -= interpolate(s.u[prev, i], first, weights)
    for p in range(STRINGS * m.fingers):
        if wn.g[p] == 0.0 or d.f_n[p] <= 0.0:
            let_go(d, w, p)
            d.skin_force[p], d.s_bar[p], d.s_rate[p], d.skin_velocity[p] = 0.0, 0.0, 0.0, 0.0
    if d.g > 0.0:
        row, i = d.rows, c.string[BOW]
        add_row(m, d, s, n, NORMAL, i, BOW, c.first[BOW], c.weights[BOW], d.side)
        d.G[row, row] += d.C_n
        d.b[row] = press.hair_position(d, c, n, next_) - d.Y[next_] - d.eta_prev


@compiled
def add_points(m: Model, state: State, d: Planes, i: int, next_: int, now: int, prev: int) -> None:
    """Add friction at each point of the hair."""
    s, n, c, t = state.motion, d.normal, state.contacts, d.refined
    points = d.rows
    for e in range(t.points):
        p, row = POINT + e, points + e
        advance_hair(m, t.zeta[next_, e], t.zeta[now, e], t.zeta[prev, e])
        torsion.yield_to_point(m, t, i, e, c.x[p])
        add_row(m, d, s, n, BOWING, i, BOW, c.first[p], c.weights[p], 1.0)
        d.b[row] = interpolate(s.u[next_, i], c.first[p], c.weights[p])
        d.b[row] -= interpolate(s.u[prev, i], c.first[p], c.weights[p])
        d.b[row] += t.zeta[next_, e, i] - t.zeta[prev, e, i]
        d.b[row] += torsion.twist_travel(t, i, STRINGS + e, next_)
    for e in range(t.points):
        for q in range(t.points):
            turned = torsion.read_twist(t, t.twist_shapes[STRINGS + e], t.twist_per_newton[q])
            d.G[points + e, points + q] += turned


@compiled
def write_laws(m: Model, d: Planes, bowed: bool, points: int) -> None:
    """Write the laws of all contacts into their rows, tension and bridge being eliminated.

    theta of eq. (34) is found with the friction of the last step.
    """
    n, wn, t = d.normal, d.normal_work, d.refined
    for row in range(CONTACT_ROW, points):
        p = d.contact[row]
        if d.plane[row] == BOWING:
            slack, Z = prepare_skin(m, d, p)
            d.D[row] = 2.0 * m.k / Z
            d.b[row] += 2.0 * m.k * slack
            continue
        travel = d.b[row]
        for e in range(t.points if bowed else 0):
            travel -= d.G[row, points + e] * t.share * t.f_b[e]
        if p == BOW:
            A_f = press.hair_stiffness(m, d, travel)
            held = d.g * d.Psi
        else:
            wn.g[p] = limited_gradient(wn.ghat[p], n.Psi[p], travel)
            A_f = contact_stiffness(m, n, wn, p)
            held = wn.g[p] * n.Psi[p]
        d.D[row] = NO_FORCE
        if A_f > 0.0:
            d.D[row] = 1.0 / A_f
            d.b[row] += held / A_f


@compiled
def move_all(
    m: Model, state: State, d: Planes, string: int, points: int, next_: int, prev: int
) -> None:
    """Move everything by the forces, known by now."""
    s, n, c, w, wn, t = state.motion, d.normal, state.contacts, state.work, d.normal_work, d.refined
    for i in range(STRINGS):
        w.tau[i] = wn.tau[i] = -m.spread[i] * d.x[i]
    move_by_tension(m, s, w, s.u[next_])
    move_by_tension(m, n, wn, n.u[next_])
    push_strings(m, d, s, n, next_)
    push_bridge(d, w, wn)
    w.bridge_travel = move_modes(m, s.q[next_], s.q[prev], w.f_c)
    move_modes(m, n.q[next_], n.q[prev], wn.f_c)
    for p in range(STRINGS * m.fingers):
        d.f_n[p] = 0.0
    d.f_n[BOW] = 0.0
    for row in range(CONTACT_ROW, points):
        p, f = d.contact[row], d.x[row]
        if d.plane[row] == BOWING:
            i, first, weights = d.string[row], c.first[p], c.weights[p]
            travel = interpolate(s.u[next_, i], first, weights)
            travel -= interpolate(s.u[prev, i], first, weights)
            advance_skin(m, d, p, 0.5 * m.rate * travel, f)
        elif p == BOW:
            press.move_hair(m, d, next_, f)
        else:
            advance_contact(m, n, wn, next_, p, f)
            d.f_n[p] = f
    for e in range(t.points):
        t.zeta[next_, e, string] -= m.C_h * t.f_b[e]
        torsion.move_twist(t, string, e, next_, t.share * t.f_b[e])
    size = 0.0
    for i in range(STRINGS):
        support(s.u[next_, i], m.N[i])
        support(n.u[next_, i], m.N[i])
        size += abs(wn.f_c[i]) + abs(d.f_n[BOW])
    w.bridge_travel += 0.0 * size  # NaN, or infinity, reaches what `measure` checks
    # Where `measure` and the ledger read the fingers.
    w.dropped_Psi += wn.dropped_Psi
    for j in range(m.fingers):
        s.U[next_, j], w.f_ext[j] = n.U[next_, j], wn.f_ext[j]
        for i in range(STRINGS):
            w.f_f[STRINGS * j + i] = d.f_n[STRINGS * j + i]


# ---------------------------------------------------------------- for the ledger


@compiled
def slope_product(m: Model, i: int, u_next: Array, u: Array) -> float:
    """Return the sum of slopes at n + 1 times those at n, in steps (m^2)."""
    total = 0.0
    for l in range(1, m.N[i] + 1):
        at = GHOST + l
        total += (u_next[at] - u_next[at - 1]) * (u[at] - u[at - 1])
    return total


@compiled
def stored_energy(m: Model, state: State, d: Planes, next_: int, now: int) -> float:
    """The energy that ``energy.stored_energy`` does not count, at n + 1/2 (J)."""
    s, n = state.motion, d.normal
    stored = refined.stored_energy(m, d.refined, next_, now) + press.press_energy(m, d, next_, now)
    for i in range(STRINGS):
        stored += string_energy(m, i, n.u[next_, i], n.u[now, i])
        along = slope_product(m, i, s.u[next_, i], s.u[now, i])
        normal = slope_product(m, i, n.u[next_, i], n.u[now, i])
        stored += m.stretch_stiffness[i] * along * normal / m.h[i]
    for mode in range(padded_length(m.modes)):
        velocity = m.rate * (n.q[next_, mode] - n.q[now, mode])
        mean = 0.5 * (n.q[next_, mode] + n.q[now, mode])
        stored += 0.5 * m.M_m[mode] * velocity * velocity + 0.5 * m.K_m[mode] * mean * mean
    for p in range(STRINGS * m.fingers):
        stored += 0.5 * n.Psi[p] * n.Psi[p] + 0.5 * d.K_s * d.s[p] * d.s[p]
    return float(stored)


@compiled
def record_planes(
    m: Model, state: State, d: Planes, control: Array, before: float, row: Array
) -> float:
    """Write what the second direction, and ``refined.record_points``, add to the ledger."""
    s, n, c, wn, t = state.motion, d.normal, state.contacts, d.normal_work, d.refined
    next_, now, prev = s.level, (s.level + 2) % LEVELS, (s.level + 1) % LEVELS
    refined_stored = refined.record_points(m, state, t, control, 0.0, row)
    stored = stored_energy(m, state, d, next_, now)
    strings, bridge, finger = 0.0, 0.0, 0.0
    Q, P = 0.0, 0.0
    for i in range(STRINGS):
        strings += string_loss(m, i, n.u[next_, i], n.u[prev, i])
    for mode in range(padded_length(m.modes)):
        velocity = 0.5 * m.rate * (n.q[next_, mode] - n.q[prev, mode])
        bridge += m.R_m[mode] * velocity * velocity
        Q += s.q[next_, mode]
        P += n.q[next_, mode]
    for p in range(STRINGS * m.fingers):
        i, j = p % STRINGS, p // STRINGS
        if wn.g[p] != 0.0:
            travel = interpolate(n.u[next_, i], c.first[p], c.weights[p]) - n.U[next_, j]
            travel -= wn.eta_prev[p]
            Psi = n.Psi[p] - 0.5 * wn.g[p] * travel
            finger += m.beta * wn.g[p] * Psi * (0.5 * m.rate * travel) ** 2
        finger += skin_power(m, s, c, d, p, next_)
    hair = press.press_loss(m, d, c, n, next_)
    power = 0.5 * m.rate * d.f_ext * (d.Y[next_] - d.Y[prev])
    for r in range(BRIDGE_ROW, CONTACT_ROW):
        i = d.string[r]
        motion = s if d.plane[r] == BOWING else n
        of_q, of_p = bridge_reads(d, r)
        at_bridge = interpolate(motion.u[next_, i], m.bridge_first[i], m.bridge_weights[i])
        gap = abs(at_bridge - of_q * Q - of_p * P)
        row[CONSTRAINT_RESIDUAL] = max(row[CONSTRAINT_RESIDUAL], gap)
    losses = strings + bridge + finger + hair
    row[ENERGY_ERROR] += (stored - refined_stored - before) * m.rate - power + losses
    row[ENERGY] += stored - refined_stored
    row[POWER_IN] += power
    row[LOSS_STRINGS] += strings
    row[LOSS_BRIDGE] += bridge
    row[LOSS_FINGER] += finger
    row[LOSS_HAIR] += hair
    return stored
