"""Where bow and fingers touch the strings, and how each contact feels the others.

With A_s diagonal, a force at q moves the reading at p by ``G[p, q] = I_p J_q / A_s``,
less what the bridge, tied to the string, takes back, and what the string's tension does
(tension.py). Where no nodes are shared and tension is constant G is diagonal and the paper's
formulas (43), (45), (50) hold as printed; elsewhere they do not, and the contacts are solved
jointly (decisions/0003).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.physics.layout import (
    BOW,
    CONTROLS_PER_FINGER,
    FINGER_CONTROLS,
    STENCIL,
    STRINGS,
    X_B,
)
from yehu_server.physics.stencil import overlap, place_cubic, place_linear, read, spread
from yehu_server.physics.tension import take_up_slack

Array = Any
Reply = tuple[float, float, float, float]


@compiled
def place_contacts(model: Any, s: Any, control: Array, bowed_string: int) -> bool:
    """Move bow and fingers to where a row of controls has them; return whether any moved.

    The bow keeps one node away from the bridge and from the loop, a finger one node
    away from the ends. Work is done only for what moved.
    Real time: safe.
    """
    moved = False
    x_b = control[X_B]
    if s.placed == 0 or s.x[BOW] != x_b or s.string[BOW] != bowed_string:
        i, moved = bowed_string, True
        s.x[BOW], s.string[BOW] = x_b, i
        h = model.h[i]
        position = max(1.0, min(x_b / h, model.bridge_x / h - 1.0))
        s.first[BOW] = place_linear(position, model.N[i], s.weights[BOW])
        meet_bridge(model, s, BOW)
    for j in range(model.fingers):
        x_f = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j]
        if s.placed == 0 or s.x[STRINGS * j] != x_f:
            moved = True
            for i in range(STRINGS):
                p = STRINGS * j + i
                s.x[p], s.string[p] = x_f, i
                position = max(1.0, min(x_f / model.h[i], model.N[i] - 1.0))
                s.first[p] = place_cubic(position, model.N[i], s.weights[p])
                meet_bridge(model, s, p)
    if moved:
        sort_fingers(model, s)
    s.placed = 1
    return moved


@compiled
def sort_fingers(model: Any, s: Any) -> None:
    """Note the fingers' order along the strings."""
    for j in range(model.fingers):
        k = j
        while k > 0 and s.x[STRINGS * s.order[k - 1]] > s.x[STRINGS * j]:
            s.order[k] = s.order[k - 1]
            k -= 1
        s.order[k] = j


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
def feel(s: Any, u_next: Array, p: int) -> float:
    """Return where contact `p` would find its string at n+1 but for the contacts' forces (m)."""
    i = s.string[p]
    reading = read(u_next[i], s.first[p], s.weights[p])
    return float(reading + s.slack[i] * s.bend_at[p] + s.shared_with_bridge[p] * s.f_c[i])


@compiled
def reply(s: Any, q: int) -> Reply:
    """Return what a newton at contact `q` does to both strings' slack (1/N) and f_c (1)."""
    i = s.string[q]
    bend, shared = s.bend_at[q], s.shared_with_bridge[q]
    return (
        s.give[0, i] * bend + s.tug[0, i] * shared,
        s.give[1, i] * bend + s.tug[1, i] * shared,
        s.tug[i, 0] * bend + s.S_c_inverse[0, i] * shared,
        s.tug[i, 1] * bend + s.S_c_inverse[1, i] * shared,
    )


@compiled
def answer(model: Any, s: Any, p: int, q: int, of_q: Reply) -> float:
    """G[p, q]: how far the reading at `p` gives way to a newton at `q`, whose `reply` is known.

    In m/N. ``s.bend_at`` of both must be this step's.
    """
    i = s.string[p]
    slack, pull = (of_q[0], of_q[2]) if i == 0 else (of_q[1], of_q[3])
    G = -s.bend_at[p] * slack - s.shared_with_bridge[p] * pull
    if p == q:
        G += s.yields[p]
    elif s.string[q] == i:
        G += model.spread[i] * overlap(s.first[p], s.weights[p], s.first[q], s.weights[q])
    return float(G)


@compiled
def is_apart(s: Any, p: int, q: int) -> bool:
    """Whether two contacts share no node."""
    distance = np.int64(s.first[p]) - np.int64(s.first[q])
    return bool(s.string[p] != s.string[q] or distance <= -STENCIL or distance >= STENCIL)


@compiled
def move(model: Any, s: Any, u_next: Array, near: int, bowed: bool) -> None:
    """Let the strings go where all forces, known by now, move them: eqs. (30) and (59)."""
    take_up_slack(model, s, u_next)
    for i in range(STRINGS):
        force = model.spread[i] * s.f_c[i]
        spread(u_next[i], model.bridge_first[i], model.bridge_weights[i], force)
    for c in range(near):
        for i in range(STRINGS):
            p = STRINGS * s.near[c] + i
            spread(u_next[i], s.first[p], s.weights[p], -model.spread[i] * s.f_f[p])
    if bowed:
        i = s.string[BOW]
        spread(u_next[i], s.first[BOW], s.weights[BOW], -model.spread[i] * s.f_b)
