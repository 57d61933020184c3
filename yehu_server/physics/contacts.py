"""Where bow and fingers touch the strings, and how each contact feels the others.

With A_s diagonal, a force at q moves the reading at p by ``G[p, q] = I_p J_q / A_s``,
less what the bridge, tied to the string, takes back, and what the string's tension does
(tension.py). Where no nodes are shared and tension is constant G is diagonal and the paper's
formulas (43), (45), (50) hold as printed; elsewhere they do not, and the contacts are solved
jointly (decisions/0003).
"""

from __future__ import annotations

from typing import Any

from yehu_server.jit import compiled
from yehu_server.physics.layout import BOW, CONTROLS_PER_FINGER, FINGER_CONTROLS, STRINGS, X_B
from yehu_server.physics.stencil import overlap, place_cubic, place_linear, read, spread
from yehu_server.physics.tension import take_up_slack

Array = Any


@compiled
def place_contacts(model: Any, s: Any, control: Array, bowed_string: int) -> None:
    """Move bow and fingers to where a row of controls has them.

    The bow keeps one node away from the bridge and from the loop, a finger one node
    away from the ends. Work is done only for what moved.
    Real time: safe.
    """
    x_b = control[X_B]
    if s.placed == 0 or s.x[BOW] != x_b or s.string[BOW] != bowed_string:
        i = bowed_string
        s.x[BOW], s.string[BOW] = x_b, i
        h = model.h[i]
        position = max(1.0, min(x_b / h, model.bridge_x / h - 1.0))
        s.first[BOW] = place_linear(position, model.N[i], s.weights[BOW])
        meet_bridge(model, s, BOW)
    for j in range(model.fingers):
        x_f = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j]
        if s.placed == 0 or s.x[STRINGS * j] != x_f:
            for i in range(STRINGS):
                p = STRINGS * j + i
                s.x[p], s.string[p] = x_f, i
                position = max(1.0, min(x_f / model.h[i], model.N[i] - 1.0))
                s.first[p] = place_cubic(position, model.N[i], s.weights[p])
                meet_bridge(model, s, p)
    s.placed = 1


@compiled
def meet_bridge(model: Any, s: Any, p: int) -> None:
    """Note how far a contact yields to itself, and which nodes it shares with the bridge."""
    i = s.string[p]
    first, weights = s.first[p], s.weights[p]
    s.yields[p] = model.spread[i] * overlap(first, weights, first, weights)
    s.shared_with_bridge[p] = model.spread[i] * overlap(
        model.bridge_first[i], model.bridge_weights[i], first, weights
    )


@compiled
def feel(s: Any, u_next: Array, p: int) -> None:
    """Find how contact `p` and the bridge feel each other in this step, and where it is free.

    ``s.free`` is the reading of u^{n+1} there, the bridge closed, but for the contacts' forces.
    """
    i = s.string[p]
    first, weights = s.first[p], s.weights[p]
    s.bend_at[p] = read(s.bend[i], first, weights)
    s.at_bridge[p] = s.shared_with_bridge[p] - s.give[i] * s.bend_at_bridge[i] * s.bend_at[p]
    for j in range(STRINGS):
        s.pull[p, j] = s.S_c_inverse[j, i] * s.at_bridge[p]
    s.free[p] = read(u_next[i], first, weights) + s.slack[i] * s.bend_at[p]
    s.free[p] += s.at_bridge[p] * s.f_c[i]


@compiled
def feel_all(model: Any, s: Any, u_next: Array, near: int) -> None:
    """Let the bow and the fingers' contacts that are near `feel` this step, and each other."""
    feel(s, u_next, BOW)
    for c in range(near):
        p = s.near[c]
        feel(s, u_next, p)
        s.at_bow[p] = answer(model, s, p, BOW)


@compiled
def answer(model: Any, s: Any, p: int, q: int) -> float:
    """G[p, q]: how far the reading at `p` gives way to a newton at `q` (m/N).

    Both must `feel` this step.
    """
    i = s.string[p]
    G = -s.at_bridge[p] * s.pull[q, i]
    if p == q:
        G += s.yields[p]
    elif s.string[q] == i:
        G += model.spread[i] * overlap(s.first[p], s.weights[p], s.first[q], s.weights[q])
    if s.string[q] == i:
        G -= s.give[i] * s.bend_at[p] * s.bend_at[q]
    return float(G)


@compiled
def push(s: Any, p: int, force: float) -> None:
    """Let contact `p` push its string by -J `force` (N): what bridge and tension do then.

    The bridge's share keeps eq. (44) true at n+1; the string itself follows in `move`.
    """
    s.slack[s.string[p]] += s.give[s.string[p]] * s.bend_at[p] * force
    s.f_c[0] += s.pull[p, 0] * force
    s.f_c[1] += s.pull[p, 1] * force


@compiled
def move(model: Any, s: Any, u_next: Array, touching: int, bowed: bool) -> None:
    """Let the strings go where all forces, known by now, move them: eqs. (30) and (59)."""
    for i in range(STRINGS):
        s.slack[i] -= s.give[i] * s.bend_at_bridge[i] * s.f_c[i]
    take_up_slack(model, s, u_next)
    for i in range(STRINGS):
        force = model.spread[i] * s.f_c[i]
        spread(u_next[i], model.bridge_first[i], model.bridge_weights[i], force)
    for c in range(touching):
        p = s.touching[c]
        i = s.string[p]
        spread(u_next[i], s.first[p], s.weights[p], -model.spread[i] * s.f_f[p])
    if bowed:
        i = s.string[BOW]
        spread(u_next[i], s.first[BOW], s.weights[BOW], -model.spread[i] * s.f_b)
