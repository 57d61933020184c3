"""The time loop of modal strings: the step of two_directions.py, in one direction of the string.

All forces are rows of the joint system (joint.py): tension, bridge, felt, fingers, and friction at
each point of the hair. docs/derivation.md, section 12.
"""

from yehu_server.compile.jit import compiled
from yehu_server.core.physics import finger, kernel, refined, torsion
from yehu_server.core.physics.bow import advance_hair, choose_string
from yehu_server.core.physics.bridge import advance_bridge, move_modes
from yehu_server.core.physics.contacts import place_contacts
from yehu_server.core.physics.hair_width import lift_points, place_points, solve_points, warm_points
from yehu_server.core.physics.joint import NO_FORCE, back_substitute, eliminate
from yehu_server.core.physics.layout import (
    F_HAMMER,
    F_N,
    F_PLUCK,
    GHOST,
    ITERATIONS,
    LEVELS,
    MAX_CONTACTS,
    POINT,
    STENCIL,
    STRINGS,
    V_B,
    X_B,
    X_PLUCK,
)
from yehu_server.core.physics.modal_string import (
    BRIDGE,
    FELT,
    FELTS,
    PLUCK,
    advance_partials,
    place,
    push,
    read_all,
    stretching,
)
from yehu_server.core.physics.records import Array, Contacts, Modal, Model, Motion, Records, State
from yehu_server.core.physics.rosin_texture import grip

BRIDGE_ROW = STRINGS  # after both tensions
FELT_ROW = 2 * STRINGS


@compiled
def come_to_rest(d: Modal) -> None:
    """Put the strings, and what refines friction, to rest. Real time: safe."""
    refined.come_to_rest(d.refined)
    d.a[:], d.w[:] = 0.0, 0.0


@compiled
def advance(model: Records, state: Records, modal: Records, controls: Array, probes: Array) -> None:
    """As ``kernel.advance``, with what `planes.prepare` made; `state` and `modal` are changed."""
    m, s, d = model[0], state[0], modal[0]
    level = int(s.motion.level)
    next_, now, prev = (level + 1) % LEVELS, level, (level + 2) % LEVELS
    for row in range(controls.shape[0]):
        step(m, s, d, controls[row], next_, now, prev)
        s.motion.level = next_
        kernel.measure(m, s, probes[row])
        if probes[row, ITERATIONS] < 0.0:  # lost
            come_to_rest(d)
        next_, now, prev = prev, next_, now


@compiled
def step(m: Model, state: State, d: Modal, control: Array, next_: int, now: int, prev: int) -> None:
    """Advance strings, bridge, bow and fingers by one sample."""
    s, c, w, t = state.motion, state.contacts, state.work, d.refined
    w.dropped_z, w.dropped_Psi, w.z_bar, w.r = 0.0, 0.0, 0.0, 0.0
    string, bowed = choose_string(m, s, c, w, control[F_N])
    lift_points(m, t, w, string, bowed)
    place_points(m, c, t, string, control[X_B])
    place_contacts(m, c, control, string)
    place_all(m, s, c, d, string, now, prev)
    advance_partials(d, next_, now, prev)
    pluck(m, s, c, d, control, next_, now, prev)
    read_all(d, s, next_)
    near = finger.advance_fingers(m, s, c, w, control, next_, now, prev)
    torsion.advance_torsion(m, t, c, w, near, next_, now, prev)
    q_sum = advance_bridge(m, s.q[next_], s.q[now], s.q[prev], control[F_HAMMER])

    add_strings(m, s, d, q_sum, next_, prev)
    contacts = d.rows
    add_fingers(m, state, d, near, next_)
    points = d.rows
    add_points(m, state, d, string, next_, now, prev)
    eliminate(d, 0, contacts)
    for row in range(contacts, points):  # theta of eq. (34), by the friction of the last step
        p, travel = d.slot[row], d.b[row]
        for e in range(t.points if bowed else 0):
            travel -= d.G[row, points + e] * t.share * t.f_b[e]
        w.g[p] = finger.limited_gradient(w.ghat[p], s.Psi[p], travel)
        A_f = finger.contact_stiffness(m, s, w, p)
        d.D[row] = NO_FORCE
        if A_f > 0.0:
            d.D[row] = 1.0 / A_f
            d.b[row] += w.g[p] * s.Psi[p] / A_f
    eliminate(d, contacts, points)

    # What is left of the rows of friction is what each point feels.
    for e in range(t.points):
        t.free[e] = 0.5 * m.rate * d.b[points + e] - control[V_B]
        for q in range(t.points):
            G = t.share * d.G[points + min(e, q), points + max(e, q)] + (m.C_h if e == q else 0.0)
            t.mobility[e, q] = 0.5 * m.rate * G
    F_N_now = abs(control[F_N]) * grip(m, s, c, control, now)
    w.F_N, w.iterations, s.f_b, s.v_r = F_N_now, 0, 0.0, 0.0
    for e in range(t.points if not bowed else 0):
        t.f_b[e], t.v_r[e] = 0.0, t.free[e]
    if bowed:
        w.iterations = solve_points(m, state, t, string, F_N_now)
    for e in range(t.points):
        d.x[points + e] = t.share * t.f_b[e]
        s.f_b += t.share * t.f_b[e]
        s.v_r += t.share * t.v_r[e]
    warm_points(m, t, string, bowed, F_N_now)
    back_substitute(d, points)
    move_all(m, state, d, string, contacts, points, next_, prev)


@compiled
def place_all(m: Model, s: Motion, c: Contacts, d: Modal, string: int, now: int, prev: int) -> None:
    """Put all slots to their places, and let what reads nodes read them."""
    for i in range(STRINGS):
        place(d, s, BRIDGE + i, i, m.bridge_x, now, prev)
        behind = (d.L[i] - m.bridge_x) / FELTS
        for each in range(FELTS):
            if d.R_felt[i, each] > 0.0:
                x = m.bridge_x + (each + 0.5) * behind
                place(d, s, FELT + FELTS * i + each, i, x, now, prev)
        m.bridge_first[i] = BRIDGE + i
        read_slot(m.bridge_weights[i])
        for j in range(m.fingers):
            p = STRINGS * j + i
            place(d, s, p, i, max(0.0, min(c.x[p], m.bridge_x)), now, prev)
    for e in range(d.refined.points):
        x = max(m.h[string], min(c.x[POINT + e], m.bridge_x - m.h[string]))
        place(d, s, POINT + e, string, x, now, prev)
    for p in range(MAX_CONTACTS):
        c.first[p] = p
        read_slot(c.weights[p])


@compiled
def read_slot(weights: Array) -> None:
    """Write the weights by which `interpolate` reads a slot in the place of nodes."""
    for l in range(STENCIL):
        weights[l] = 1.0 if l == 1 else 0.0


@compiled
def pluck(
    m: Model, s: Motion, c: Contacts, d: Modal, control: Array, next_: int, now: int, prev: int
) -> None:
    """Apply the plucking force, as ``pluck.pluck``."""
    force = control[F_PLUCK]
    if force == 0.0:
        return
    c.pluck_string, c.pluck_first = (0 if force > 0.0 else 1), PLUCK
    read_slot(c.pluck_weights)
    x = max(0.0, min(control[X_PLUCK], m.bridge_x))
    place(d, s, PLUCK, c.pluck_string, x, now, prev)
    push(d, PLUCK, next_, abs(force))


@compiled
def add_row(d: Modal, slot: int, b: float, D: float) -> None:
    """Add a force at a slot: how far those before it move it, and its own."""
    row, i = d.rows, d.string[slot]
    d.rows += 1
    d.slot[row], d.b[row], d.D[row] = slot, b, D
    for tension in range(STRINGS):
        G = stretching(d, i, slot) if tension == i else 0.0
        d.G[row, tension] = d.G[tension, row] = G
    for other in range(BRIDGE_ROW, row + 1):
        G = d.compliance[slot, d.slot[other]] if d.string[d.slot[other]] == i else 0.0
        d.G[row, other] = d.G[other, row] = G


@compiled
def travel_of(d: Modal, s: Motion, slot: int, next_: int, prev: int) -> float:
    """Return how far a slot moves in two samples (m)."""
    i, at = d.string[slot], GHOST + 1 + slot
    return float(s.u[next_, i, at] - s.u[prev, i, at])


@compiled
def add_strings(m: Model, s: Motion, d: Modal, q_sum: float, next_: int, prev: int) -> None:
    """Begin the system with tension, bridge and felt. `q_sum` (m) is that of the bridge's modes."""
    for i in range(STRINGS):
        squared, travel = 0.0, 0.0
        for n in range(d.partials):
            squared += d.C_s[i, n] * d.Delta[i, n] * d.Delta[i, n]
            travel += d.Delta[i, n] * (d.a[next_, i, n] + d.a[prev, i, n])
        d.G[i, i], d.b[i], stiffness = squared, travel, d.stretch_stiffness[i]
        d.D[i] = 1.0 / stiffness if stiffness > 0.0 else NO_FORCE
    d.G[0, 1] = d.G[1, 0] = 0.0
    d.rows = BRIDGE_ROW
    for i in range(STRINGS):
        add_row(d, BRIDGE + i, s.u[next_, i, GHOST + 1 + BRIDGE + i] - q_sum, 0.0)
    for row in range(BRIDGE_ROW, FELT_ROW):
        for other in range(BRIDGE_ROW, FELT_ROW):
            d.G[row, other] += m.C_q_sum
    for i in range(STRINGS):
        for each in range(FELTS):
            R, slot = d.R_felt[i, each], FELT + FELTS * i + each
            if R > 0.0:
                add_row(d, slot, travel_of(d, s, slot, next_, prev), 2.0 * m.k / R)


@compiled
def add_fingers(m: Model, state: State, d: Modal, near: int, next_: int) -> None:
    """Add the forces of the fingers that touch a string; their laws come later."""
    s, c, w, first = state.motion, state.contacts, state.work, d.rows
    for a in range(near):
        j = c.candidates[a]
        for i in range(STRINGS):
            p = STRINGS * j + i
            if w.ghat[p] == 0.0:
                continue
            row = d.rows
            free = s.u[next_, i, GHOST + 1 + p] - s.U[next_, j] - w.eta_prev[p]
            add_row(d, p, free, NO_FORCE)
            for other in range(first, row + 1):
                if d.slot[other] // STRINGS == j:
                    d.G[row, other] += m.C_f
                    if other != row:
                        d.G[other, row] += m.C_f


@compiled
def add_points(m: Model, state: State, d: Modal, i: int, next_: int, now: int, prev: int) -> None:
    """Add friction at each point of the hair."""
    s, c, t = state.motion, state.contacts, d.refined
    points = d.rows
    for e in range(t.points):
        advance_hair(m, t.zeta[next_, e], t.zeta[now, e], t.zeta[prev, e])
        torsion.yield_to_point(m, t, i, e, c.x[POINT + e])
        travel = travel_of(d, s, POINT + e, next_, prev)
        travel += t.zeta[next_, e, i] - t.zeta[prev, e, i]
        add_row(d, POINT + e, travel + torsion.twist_travel(t, i, STRINGS + e, next_), NO_FORCE)
    for e in range(t.points):
        for q in range(t.points):
            turned = torsion.read_twist(t, t.twist_shapes[STRINGS + e], t.twist_per_newton[q])
            d.G[points + e, points + q] += turned


@compiled
def move_all(
    m: Model, state: State, d: Modal, string: int, contacts: int, points: int, next_: int, prev: int
) -> None:
    """Move everything by the forces, known by now."""
    s, w, t = state.motion, state.work, d.refined
    for i in range(STRINGS):
        tension = d.x[i]
        for n in range(d.partials if tension != 0.0 else 0):
            d.a[next_, i, n] -= d.C_s[i, n] * d.Delta[i, n] * tension
        w.f_c[i] = -d.x[BRIDGE_ROW + i]
    for row in range(BRIDGE_ROW, d.rows):
        push(d, d.slot[row], next_, -d.x[row])
    w.bridge_travel = move_modes(m, s.q[next_], s.q[prev], w.f_c)
    for row in range(contacts, points):
        finger.advance_contact(m, s, w, next_, d.slot[row], d.x[row])
    for e in range(t.points):
        t.zeta[next_, e, string] -= m.C_h * t.f_b[e]
        torsion.move_twist(t, string, e, next_, t.share * t.f_b[e])
    read_all(d, s, next_)
