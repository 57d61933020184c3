"""Where bow and fingers touch the strings, and how a force at one contact moves another.

Tension and bridge are eliminated before the contacts (bridge.py). From then on a contact's force
moves the string under it, and through tension and bridge all other contacts. G[p, q], the
compliance between two contacts, is

    G[p, q] = I_p J_q / A_s - (I_p Delta u^n) tau_q - (I_p J_c / A_s) f_c,q,

where tau_q and f_c,q are the `response` of tension and bridge to one newton at q. Where no node is
shared and tension is constant, G is diagonal, and the paper's formulas (43), (45), (50) hold
as printed; elsewhere they do not, and contacts are solved jointly (decisions/0003).
Derivation: docs/derivation.md, section 3.
"""

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.grid import (
    cubic_weights,
    interpolate,
    linear_weights,
    overlap,
    spread,
)
from yehu_server.core.physics.layout import (
    BOW,
    CONTROLS_PER_FINGER,
    FINGER_CONTROLS,
    STENCIL,
    STRINGS,
    X_B,
)
from yehu_server.core.physics.records import Array, Contacts, Model, Motion, Work
from yehu_server.core.physics.tension import move_by_tension

Response = tuple[float, float, float, float]


@compiled
def place_contacts(model: Model, c: Contacts, control: Array, bowed_string: int) -> bool:
    """Move bow and fingers to the places in a row of controls; only what moved is worked out anew.

    The bow keeps one node away from the bridge and from the loop, a finger one node away from the
    loop, and it goes no farther than to the bridge. Returns whether contacts may share other nodes
    now: a finger moved, or the bow touches others. Real time: safe.
    """
    moved = False
    x_b = control[X_B]
    if c.placed == 0 or c.x[BOW] != x_b or c.string[BOW] != bowed_string:
        i, first, string = bowed_string, c.first[BOW], c.string[BOW]
        place_hair(model, c, BOW, i, x_b)
        moved = c.first[BOW] != first or string != i
    fingers_moved = False
    for j in range(model.fingers):
        x_f = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j]
        if c.placed == 0 or c.x[STRINGS * j] != x_f:
            fingers_moved = True
            for i in range(STRINGS):
                p = STRINGS * j + i
                c.x[p], c.string[p] = x_f, i
                position = max(1.0, min(x_f, model.bridge_x) / model.h[i])
                c.first[p] = cubic_weights(position, model.N[i], c.weights[p])
                set_compliances(model, c, p)
    if fingers_moved:
        sort_fingers(model, c)
    c.placed = 1
    return bool(moved or fingers_moved)


@compiled
def place_hair(model: Model, c: Contacts, p: int, i: int, x: float) -> None:
    """Put contact `p`, of hair, onto string `i` at `x` (m)."""
    c.x[p], c.string[p] = x, i
    h = model.h[i]
    position = max(1.0, min(x / h, model.bridge_x / h - 1.0))
    c.first[p] = linear_weights(position, model.N[i], c.weights[p])
    set_compliances(model, c, p)


@compiled
def sort_fingers(model: Model, c: Contacts) -> None:
    """Write the fingers' order along the strings, from the loop to the bridge."""
    for j in range(model.fingers):
        k = j
        while k > 0 and c.x[STRINGS * c.order[k - 1]] > c.x[STRINGS * j]:
            c.order[k] = c.order[k - 1]
            k -= 1
        c.order[k] = j


@compiled
def set_compliances(model: Model, c: Contacts, p: int) -> None:
    """Write I_p J_p / A_s and I_c J_p / A_s: how a newton at `p` moves its string there (m/N)."""
    i = c.string[p]
    first, weights = c.first[p], c.weights[p]
    c.self_compliance[p] = model.spread[i] * overlap(first, weights, first, weights)
    c.bridge_coupling[p] = model.spread[i] * overlap(
        model.bridge_first[i], model.bridge_weights[i], first, weights
    )


@compiled
def free_displacement(c: Contacts, w: Work, u_next: Array, p: int) -> float:
    """Return I_p u^{n+1} as it would be without the forces of bow and fingers (m)."""
    i = c.string[p]
    free = interpolate(u_next[i], c.first[p], c.weights[p])
    return float(free + w.tau[i] * w.Delta_u_at[p] + c.bridge_coupling[p] * w.f_c[i])


@compiled
def response(c: Contacts, w: Work, q: int) -> Response:
    """Return how tau (1/N) and f_c (1) of both strings respond to one newton at contact `q`."""
    i = c.string[q]
    Delta_u, coupling = w.Delta_u_at[q], c.bridge_coupling[q]
    return (
        w.K_tt[0, i] * Delta_u + w.K_tc[0, i] * coupling,
        w.K_tt[1, i] * Delta_u + w.K_tc[1, i] * coupling,
        w.K_tc[i, 0] * Delta_u + w.K_cc[0, i] * coupling,
        w.K_tc[i, 1] * Delta_u + w.K_cc[1, i] * coupling,
    )


@compiled
def compliance(model: Model, c: Contacts, w: Work, p: int, q: int, q_response: Response) -> float:
    """Return G[p, q] (m/N): -d(I_p u^{n+1}) / d f_q.

    `q_response` is the `response` to one newton at `q`; ``Delta_u_at`` of both must be this step's.
    """
    i = c.string[p]
    tau, f_c = (q_response[0], q_response[2]) if i == 0 else (q_response[1], q_response[3])
    G = -w.Delta_u_at[p] * tau - c.bridge_coupling[p] * f_c
    if p == q:
        G += c.self_compliance[p]
    elif c.string[q] == i:
        G += model.spread[i] * overlap(c.first[p], c.weights[p], c.first[q], c.weights[q])
    return float(G)


@compiled
def share_no_node(c: Contacts, p: int, q: int) -> bool:
    """Whether two contacts touch no common node."""
    distance = np.int64(c.first[p]) - np.int64(c.first[q])
    return bool(c.string[p] != c.string[q] or distance <= -STENCIL or distance >= STENCIL)


@compiled
def move_strings(
    model: Model, s: Motion, c: Contacts, w: Work, u_next: Array, near: int, bowed: bool
) -> None:
    """Add the displacement of all forces, known by now, to u^{n+1}: eq. (30)."""
    move_by_tension(model, s, w, u_next)
    for i in range(STRINGS):
        force = model.spread[i] * w.f_c[i]
        spread(u_next[i], model.bridge_first[i], model.bridge_weights[i], force)
    for a in range(near):
        for i in range(STRINGS):
            p = STRINGS * c.candidates[a] + i
            spread(u_next[i], c.first[p], c.weights[p], -model.spread[i] * w.f_f[p])
    if bowed:
        i = c.string[BOW]
        spread(u_next[i], c.first[BOW], c.weights[BOW], -model.spread[i] * s.f_b)
