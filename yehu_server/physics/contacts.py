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
from yehu_server.physics.bridge import pull_strings
from yehu_server.physics.layout import BOW, CONTROLS_PER_FINGER, FINGER_CONTROLS, STRINGS, X_B
from yehu_server.physics.stencil import overlap, place_cubic, place_linear, read, spread

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
def feel(s: Any, p: int) -> None:
    """How contact `p` and the bridge feel each other in this step: nodes shared, and tension."""
    i = s.string[p]
    s.bend_at[p] = read(s.bend[i], s.first[p], s.weights[p])
    s.at_bridge[p] = s.shared_with_bridge[p] - s.give[i] * s.bend_at_bridge[i] * s.bend_at[p]
    for j in range(STRINGS):
        s.pull[p, j] = s.S_c_inverse[j, i] * s.at_bridge[p]


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
def push(model: Any, s: Any, u_next: Array, p: int, force: float) -> None:
    """Let contact `p` push its string by -J `force` (N), bridge and tension following.

    Source: [Yehu] eq. (30); the bridge's share keeps eq. (44) true at n+1.
    """
    i = s.string[p]
    spread(u_next[i], s.first[p], s.weights[p], -model.spread[i] * force)
    s.slack[i] += s.give[i] * s.bend_at[p] * force
    if s.at_bridge[p] != 0.0:
        pull_strings(model, s, u_next, s.pull[p, 0] * force, s.pull[p, 1] * force)


@compiled
def eliminate(matrix: Array, sides: Array, n: int) -> None:
    """Solve the leading n by n system for two right-hand sides, in place.

    Gaussian elimination with row pivoting: n is at most eight, and LAPACK allocates.
    """
    for column in range(n):
        pivot = column
        for row in range(column + 1, n):
            if abs(matrix[row, column]) > abs(matrix[pivot, column]):
                pivot = row
        if pivot != column:
            for c in range(n):
                matrix[column, c], matrix[pivot, c] = matrix[pivot, c], matrix[column, c]
            for side in range(2):
                sides[side, column], sides[side, pivot] = sides[side, pivot], sides[side, column]
        for row in range(column + 1, n):
            factor = matrix[row, column] / matrix[column, column]
            for c in range(column, n):
                matrix[row, c] -= factor * matrix[column, c]
            for side in range(2):
                sides[side, row] -= factor * sides[side, column]
    for side in range(2):
        for row in range(n - 1, -1, -1):
            total = sides[side, row]
            for c in range(row + 1, n):
                total -= matrix[row, c] * sides[side, c]
            sides[side, row] = total / matrix[row, row]
