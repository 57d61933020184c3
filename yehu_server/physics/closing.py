"""The contacts' forces, all of one step together: [Yehu] eqs. (37)-(40), made joint.

Fingers are closed first, each taking its part of what others still feel, until only the bow's
force is open; friction is solved with what is left, and the fingers' forces follow from it.
Fingers feel each other where they share nodes, and through tension and bridge, that is by the
forces on each string times Delta u^n under them: so each is closed with those it meets, and two
equations for these sums remain. Where one shares a node with the bow or the bridge, each contact
feels each, and they are closed one after the other (decisions/0003).
"""

from __future__ import annotations

from typing import Any

from yehu_server.jit import compiled
from yehu_server.physics.contacts import Reply, answer, feel, is_apart, reply
from yehu_server.physics.finger import may_leave, settle, stiffness
from yehu_server.physics.layout import BOW, STRINGS
from yehu_server.physics.stencil import overlap

Array = Any
Weight = tuple[float, float, float]


@compiled
def note_neighbours(model: Any, s: Any, near: int) -> None:
    """Note which fingers share nodes with the one before, and whether nothing else is shared."""
    s.clear = 1
    for a in range(near):
        s.meets[a] = 0
        for i in range(STRINGS):
            p = STRINGS * s.near[a] + i
            if s.shared_with_bridge[p] != 0.0 or not is_apart(s, p, BOW):
                s.clear = 0
            for b in range(a - 1):
                if not is_apart(s, p, STRINGS * s.near[b] + i):
                    s.clear = 0
            if a > 0:
                q = STRINGS * s.near[a - 1] + i
                shared = overlap(s.first[p], s.weights[p], s.first[q], s.weights[q])
                s.shared[a, i] = model.spread[i] * shared
                if shared != 0.0:
                    s.meets[a] = 1


@compiled
def weigh_fingers(model: Any, s: Any, near: int) -> Weight:
    """Solve eq. (35) for both forces of each finger, one finger after the other.

    The forces are W times what the finger's contacts travel without them, plus ``s.held``; W times
    ``s.slackens`` for each metre of slack still to come, less W ``s.shared`` for each newton
    of the next finger. Returns Q: by how much the sums grow for each metre of slack (N m),
    symmetric, on strings 11, 12, 22.
    """
    C_f = model.C_f
    Q_11, Q_12, Q_22 = 0.0, 0.0, 0.0
    W_11, W_12, W_22 = 0.0, 0.0, 0.0
    Wb_11, Wb_12, Wb_21, Wb_22 = 0.0, 0.0, 0.0, 0.0
    for a in range(near):
        p, q = STRINGS * s.near[a], STRINGS * s.near[a] + 1
        yield_p, across, yield_q = s.yields[p] + C_f, C_f, s.yields[q] + C_f
        b_11, b_12, b_21, b_22 = s.bend_at[p], 0.0, 0.0, s.bend_at[q]
        if s.meets[a]:
            shared_p, shared_q = s.shared[a, 0], s.shared[a, 1]
            yield_p -= shared_p * shared_p * W_11
            across -= shared_p * shared_q * W_12
            yield_q -= shared_q * shared_q * W_22
            b_11, b_12 = b_11 - shared_p * Wb_11, -shared_p * Wb_12
            b_21, b_22 = -shared_q * Wb_21, b_22 - shared_q * Wb_22
        A_p, A_q = stiffness(model, s, p), stiffness(model, s, q)
        on_p, on_q = 1.0 + A_p * yield_p, 1.0 + A_q * yield_q
        W_12 = -A_p * across * A_q
        per_determinant = 1.0 / (on_p * on_q + W_12 * across)
        W_12 *= per_determinant
        W_11, W_22 = A_p * on_q * per_determinant, A_q * on_p * per_determinant
        s.W[a, 0], s.W[a, 1], s.W[a, 2] = W_11, W_12, W_22
        held_p, held_q = s.g[p] * s.Psi[p], s.g[q] * s.Psi[q]
        s.held[p] = (held_p * on_q - held_q * A_p * across) * per_determinant
        s.held[q] = (held_q * on_p - held_p * A_q * across) * per_determinant
        s.slackens[a, 0, 0], s.slackens[a, 0, 1] = b_11, b_12
        s.slackens[a, 1, 0], s.slackens[a, 1, 1] = b_21, b_22
        Wb_11, Wb_12 = W_11 * b_11 + W_12 * b_21, W_11 * b_12 + W_12 * b_22
        Wb_21, Wb_22 = W_12 * b_11 + W_22 * b_21, W_12 * b_12 + W_22 * b_22
        Q_11 += b_11 * Wb_11 + b_21 * Wb_21
        Q_12 += b_12 * Wb_11 + b_22 * Wb_21
        Q_22 += b_12 * Wb_12 + b_22 * Wb_22
    return Q_11, Q_12, Q_22


@compiled
def feel_fingers(
    model: Any,
    s: Any,
    u_next: Array,
    next_: int,
    near: int,
    of_bow: Reply,
    f_b: float,
    doubt: float,
) -> bool:
    """Find what the fingers' contacts travel in this step but for their own forces.

    Returns whether one of them may leave: see `may_leave` for `f_b` and `doubt` (N).
    """
    leaving = False
    for a in range(near):
        for i in range(STRINGS):
            p = STRINGS * s.near[a] + i
            if s.clear:
                s.at_bow[p] = -s.bend_at[p] * of_bow[i]
            else:
                s.at_bow[p] = answer(model, s, p, BOW, of_bow)
            s.travel[p] = feel(s, u_next, p) - s.U[next_, s.near[a]] - s.eta_prev[p]
            leaving |= may_leave(s, p, f_b, doubt)
    return leaving


@compiled
def close_fingers(model: Any, s: Any, near: int, Q: Weight, of_bow: Reply) -> tuple[float, float]:
    """Let all fingers press, until only the bow's force is open.

    Returns
    -------
    taken : float, m
        By how much the bow's reading moves with all contacts closed.
    taken_per_newton : float, m/N
        How much less it gives way.
    """
    if s.clear:
        return close_in_turn(s, near, Q, of_bow)
    return close_together(model, s, near)


@compiled
def close_in_turn(s: Any, near: int, Q: Weight, of_bow: Reply) -> tuple[float, float]:
    """Close fingers that meet their neighbours at most, weighed by `weigh_fingers`.

    What slack and f_c are by now, and what they become for each newton of the bow's, is written.
    """
    sum_1, sum_2 = 0.0, 0.0
    f_p, f_q = 0.0, 0.0
    for a in range(near):
        p, q = STRINGS * s.near[a], STRINGS * s.near[a] + 1
        travel_p, travel_q = s.travel[p], s.travel[q]
        if s.meets[a]:
            travel_p -= s.shared[a, 0] * f_p
            travel_q -= s.shared[a, 1] * f_q
        f_p = s.W[a, 0] * travel_p + s.W[a, 1] * travel_q + s.held[p]
        f_q = s.W[a, 1] * travel_p + s.W[a, 2] * travel_q + s.held[q]
        s.f_f[p], s.f_f[q] = f_p, f_q
        sum_1 += s.slackens[a, 0, 0] * f_p + s.slackens[a, 1, 0] * f_q
        sum_2 += s.slackens[a, 0, 1] * f_p + s.slackens[a, 1, 1] * f_q

    # (1 - Q give) sums: those without slack, and Q times the slack of the bow's newton.
    Q_11, Q_12, Q_22 = Q
    give_11, give_12, give_22 = s.give[0, 0], s.give[0, 1], s.give[1, 1]
    a_11, a_12 = 1.0 - (Q_11 * give_11 + Q_12 * give_12), Q_11 * give_12 + Q_12 * give_22
    a_21, a_22 = Q_12 * give_11 + Q_22 * give_12, 1.0 - (Q_12 * give_12 + Q_22 * give_22)
    per_determinant = 1.0 / (a_11 * a_22 - a_12 * a_21)
    a_11, a_12 = a_11 * per_determinant, a_12 * per_determinant
    a_21, a_22 = a_21 * per_determinant, a_22 * per_determinant
    bow_1, bow_2 = of_bow[0], of_bow[1]
    more_1, more_2 = Q_11 * bow_1 + Q_12 * bow_2, Q_12 * bow_1 + Q_22 * bow_2
    sum_1, sum_2 = a_22 * sum_1 + a_12 * sum_2, a_11 * sum_2 + a_21 * sum_1
    more_1, more_2 = a_22 * more_1 + a_12 * more_2, a_11 * more_2 + a_21 * more_1
    slack_1, slack_2 = give_11 * sum_1 + give_12 * sum_2, give_12 * sum_1 + give_22 * sum_2
    s.slackened[0], s.slackened[1] = slack_1, slack_2
    s.slack[0] += slack_1
    s.slack[1] += slack_2
    s.slack_per_newton[0] += give_11 * more_1 + give_12 * more_2
    s.slack_per_newton[1] += give_12 * more_1 + give_22 * more_2
    for i in range(STRINGS):
        s.f_c[i] += s.tug[0, i] * sum_1 + s.tug[1, i] * sum_2
        s.f_c_per_newton[i] += s.tug[0, i] * more_1 + s.tug[1, i] * more_2
    return -(bow_1 * sum_1 + bow_2 * sum_2), bow_1 * more_1 + bow_2 * more_2


@compiled
def push_fingers(model: Any, s: Any, next_: int, near: int, f_b: float) -> None:
    """Find the forces of the fingers, closed by `close_fingers`, the bow's known."""
    if s.clear:
        push_in_turn(model, s, next_, near, f_b)
    else:
        push_together(model, s, next_, f_b)


@compiled
def push_in_turn(model: Any, s: Any, next_: int, near: int, f_b: float) -> None:
    """Find the forces of fingers that `close_in_turn` has closed."""
    slack_1 = s.slackened[0] + s.slack_per_newton[0] * f_b
    slack_2 = s.slackened[1] + s.slack_per_newton[1] * f_b
    f_p, f_q = 0.0, 0.0
    for back in range(near):
        a = near - 1 - back
        p, q = STRINGS * s.near[a], STRINGS * s.near[a] + 1
        way_p = s.slackens[a, 0, 0] * slack_1 + s.slackens[a, 0, 1] * slack_2
        way_q = s.slackens[a, 1, 0] * slack_1 + s.slackens[a, 1, 1] * slack_2
        if back > 0 and s.meets[a + 1]:
            way_p -= s.shared[a + 1, 0] * f_p
            way_q -= s.shared[a + 1, 1] * f_q
        f_p = s.f_f[p] + s.W[a, 0] * way_p + s.W[a, 1] * way_q
        f_q = s.f_f[q] + s.W[a, 1] * way_p + s.W[a, 2] * way_q
        settle(model, s, next_, p, f_p)
        settle(model, s, next_, q, f_q)


@compiled
def close_together(model: Any, s: Any, near: int) -> tuple[float, float]:
    """Close contacts of which each feels each, by the matrix G."""
    bow = 0
    for c in range(near):
        for i in range(STRINGS):
            p = STRINGS * s.near[c] + i
            if s.g[p] > 0.0:
                s.touching[bow] = p
                s.A_f[bow] = stiffness(model, s, p)
                s.d[bow] = s.A_f[bow] * s.travel[p] + s.g[p] * s.Psi[p]
                bow += 1
    s.contacts = bow
    for row in range(bow):
        p = s.touching[row]
        of_p = reply(s, p)
        for column in range(row + 1):
            q = s.touching[column]
            G = answer(model, s, q, p, of_p)
            if p // STRINGS == q // STRINGS:
                G += model.C_f
            s.G[column, row] = G
        s.G[row, bow] = s.at_bow[p]
    taken, taken_per_newton = 0.0, 0.0
    for row in range(bow):
        per_stiffness = 1.0 / (1.0 + s.A_f[row] * s.G[row, row])
        d, A_f = s.d[row] * per_stiffness, s.A_f[row] * per_stiffness
        s.d[row], s.A_f[row] = d, A_f
        for other in range(row + 1, bow):
            G = s.G[row, other]
            s.d[other] -= s.A_f[other] * G * d
            for column in range(other, bow + 1):
                s.G[other, column] -= A_f * G * s.G[row, column]
        G = s.G[row, bow]
        taken += G * d
        taken_per_newton += G * G * A_f
    return taken, taken_per_newton


@compiled
def push_together(model: Any, s: Any, next_: int, f_b: float) -> None:
    """Find the forces of contacts that `close_together` has closed."""
    touching = s.contacts
    for row in range(touching - 1, -1, -1):
        p = s.touching[row]
        pushed = s.G[row, touching] * f_b
        for other in range(row + 1, touching):
            pushed += s.G[row, other] * s.f_f[s.touching[other]]
        f_f = s.d[row] - s.A_f[row] * pushed
        settle(model, s, next_, p, f_f)
        of_p = reply(s, p)
        for i in range(STRINGS):
            s.slack[i] += of_p[i] * f_f
            s.f_c[i] += of_p[STRINGS + i] * f_f
