"""Where bow and fingers touch the strings, and how each contact feels the others.

With A_s diagonal, a force at q moves the reading at p by ``G[p, q] = I_p J_q / A_s``,
less what the bridge, tied to the string, takes back. Where no nodes are shared G is
diagonal and the paper's formulas (43), (45), (50) hold as printed; where stencils
overlap they do not, and the contacts are solved jointly (decisions/0003).
"""

from __future__ import annotations

from typing import Any

from yehu_server.jit import compiled
from yehu_server.physics.bridge import bridge_pull, pull_string
from yehu_server.physics.layout import BOW, CONTROLS_PER_FINGER, FINGER_CONTROLS, STRINGS, X_B
from yehu_server.physics.stencil import overlap, place_cubic, place_linear, spread

Array = Any


@compiled
def place_contacts(model: Any, s: Any, control: Array, bowed_string: int) -> None:
    """Move bow and fingers to where a row of controls has them.

    The bow keeps one node away from the bridge and from the loop, a finger one node
    away from the ends. Work is done only for what moved.
    Real time: safe.
    """
    moved = s.placed == 0
    x_b = control[X_B]
    if moved or s.x[BOW] != x_b or s.string[BOW] != bowed_string:
        i = bowed_string
        s.x[BOW], s.string[BOW] = x_b, i
        h = model.h[i]
        position = max(1.0, min(x_b / h, model.bridge_x / h - 1.0))
        s.first[BOW] = place_linear(position, model.N[i], s.weights[BOW])
        moved = True
    for j in range(model.fingers):
        x_f = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j]
        if s.placed == 0 or s.x[STRINGS * j] != x_f:
            for i in range(STRINGS):
                p = STRINGS * j + i
                s.x[p], s.string[p] = x_f, i
                position = max(1.0, min(x_f / model.h[i], model.N[i] - 1.0))
                s.first[p] = place_cubic(position, model.N[i], s.weights[p])
            moved = True
    if moved:
        couple(model, s)
        s.placed = 1


@compiled
def couple(model: Any, s: Any) -> None:
    """Fill G, and whether any contact feels another."""
    contacts = STRINGS * model.fingers
    for n in range(contacts + 1):
        p = BOW if n == contacts else n
        i = s.string[p]
        s.at_bridge[p] = model.spread[i] * overlap(
            model.bridge_first[i], model.bridge_weights[i], s.first[p], s.weights[p]
        )
        bridge_pull(model, i, s.first[p], s.weights[p], s.pull[p])
    s.overlapping = 0
    for n in range(contacts + 1):
        p = BOW if n == contacts else n
        for m in range(n + 1):
            q = BOW if m == contacts else m
            i = s.string[p]
            G = -s.at_bridge[p] * s.pull[q, i]
            if s.string[q] == i:
                G += model.spread[i] * overlap(s.first[p], s.weights[p], s.first[q], s.weights[q])
            s.G[p, q] = G
            s.G[q, p] = G
            if p != q and G != 0.0:
                s.overlapping = 1


@compiled
def push(model: Any, s: Any, u_next: Array, p: int, force: float) -> None:
    """Let contact `p` push its string by -J `force` (N), the bridge following.

    Source: [Yehu] eq. (30); the bridge's share keeps eq. (44) true at n+1.
    """
    i = s.string[p]
    spread(u_next[i], s.first[p], s.weights[p], -model.spread[i] * force)
    if s.at_bridge[p] != 0.0:
        for j in range(STRINGS):
            more = s.pull[p, j] * force
            s.f_c[j] += more
            pull_string(model, u_next, j, more)


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
