"""Elimination of the fingers' forces, until only the bow's is unknown.

The fingers' contacts are one linear system, (1 + A G) f = A travel + g Psi, G including the
finger's own displacement C_f; its right-hand side still depends on the friction force f_b.
Fingers are eliminated first, in place of [Yehu] eqs. (37)-(40); friction is solved with the Schur
complement that is left (friction.py); the fingers' forces follow by back substitution.

There are two ways through it. Mostly a finger shares nodes with its neighbours at most: apart
from those, fingers act on each other only through tension and bridge, that is through two sums,
the forces on each string times Delta u^n under them. The system is then a block-tridiagonal
chain plus a term of rank two, solved block by block and by Woodbury's identity. Where a
finger shares a node with the bow, the bridge or a finger beyond its neighbour, the matrix G
is dense, and contacts are eliminated one after the other (decisions/0003).
Derivation: docs/derivation.md, sections 4 and 5.
"""

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.contacts import (
    Response,
    compliance,
    free_displacement,
    response,
    share_no_node,
)
from yehu_server.core.physics.finger import advance_contact, contact_stiffness, may_detach
from yehu_server.core.physics.grid import overlap
from yehu_server.core.physics.layout import BOW, STRINGS
from yehu_server.core.physics.records import Array, Contacts, Model, Motion, Work

Symmetric = tuple[float, float, float]  # entries 11, 12, 22
Matrix = tuple[float, float, float, float]  # entries 11, 12, 21, 22


@compiled
def find_shared_nodes(model: Model, c: Contacts, near: int) -> None:
    """Write which fingers share nodes with the one before, and whether they share no others."""
    c.is_chain = 1
    for a in range(near):
        c.meets_previous[a] = 0
        for i in range(STRINGS):
            p = STRINGS * c.candidates[a] + i
            if c.bridge_coupling[p] != 0.0 or not share_no_node(c, p, BOW):
                c.is_chain = 0
            for b in range(a - 1):
                if not share_no_node(c, p, STRINGS * c.candidates[b] + i):
                    c.is_chain = 0
            if a > 0:
                q = STRINGS * c.candidates[a - 1] + i
                shared = overlap(c.first[p], c.weights[p], c.first[q], c.weights[q])
                c.previous_coupling[a, i] = model.spread[i] * shared
                if shared != 0.0:
                    c.meets_previous[a] = 1


@compiled
def find_travel(
    model: Model,
    s: Motion,
    c: Contacts,
    w: Work,
    u_next: Array,
    next_: int,
    near: int,
    bow_response: Response,
    f_b: float,
    margin: float,
) -> bool:
    """Write how far the fingers' contacts travel in this step without their own forces (m).

    Returns whether one of them may detach: see `may_detach` for `f_b` and `margin` (N).
    """
    detaching = False
    for a in range(near):
        for i in range(STRINGS):
            p = STRINGS * c.candidates[a] + i
            if c.is_chain:
                w.bow_compliance[p] = -w.Delta_u_at[p] * bow_response[i]
            else:
                w.bow_compliance[p] = compliance(model, c, w, p, BOW, bow_response)
            w.travel[p] = (
                free_displacement(c, w, u_next, p) - s.U[next_, c.candidates[a]] - w.eta_prev[p]
            )
            detaching |= may_detach(s, w, p, f_b, margin)
    return detaching


@compiled
def eliminate_fingers(
    model: Model, s: Motion, c: Contacts, w: Work, near: int, Q: Symmetric, bow_response: Response
) -> tuple[float, float]:
    """Eliminate the forces of all fingers, until only the bow's is unknown.

    Returns by how much they move the string under the bow, against its force (m), and lower its
    compliance there (m/N).
    """
    if c.is_chain:
        return eliminate_chain(c, w, near, Q, bow_response)
    return eliminate_jointly(model, s, c, w, near)


@compiled
def back_substitute_fingers(
    model: Model, s: Motion, c: Contacts, w: Work, next_: int, near: int, f_b: float
) -> None:
    """Find the forces of the fingers from the friction force (N); advance them by it."""
    if c.is_chain:
        back_substitute_chain(model, s, c, w, next_, near, f_b)
    else:
        back_substitute_jointly(model, s, c, w, next_, f_b)


# ---------------------------------------------------------------- fingers as a chain


@compiled
def pivot_block(
    A_p: float, A_q: float, C_pp: float, C_pq: float, C_qq: float
) -> tuple[float, float, float, float, float, float]:
    """Invert one finger's block, 1 + A C, with A diagonal and C symmetric (m/N).

    Returns W = (1 + A C)^-1 A (entries 11, 12, 22; N/m), then one over the determinant of
    1 + A C, and its diagonal.
    """
    on_p, on_q = 1.0 + A_p * C_pp, 1.0 + A_q * C_qq
    W_12 = -A_p * C_pq * A_q
    per_determinant = 1.0 / (on_p * on_q + W_12 * C_pq)
    W_12 *= per_determinant
    W_11, W_22 = A_p * on_q * per_determinant, A_q * on_p * per_determinant
    return W_11, W_12, W_22, per_determinant, on_p, on_q


@compiled
def factor_fingers(model: Model, s: Motion, c: Contacts, w: Work, near: int) -> Symmetric:
    """Factor the chain of fingers, block by block, from eq. (35) for both forces of each.

    A finger's forces are then W times what its contacts travel, plus ``f_0``; plus W times
    ``Delta_u_chain`` times tau, less W times ``previous_coupling`` times the next finger's
    forces. While theta is 1 all of this is known before the strings' update.

    Returns Q (N m), the sum of B^T W B over the fingers, B being Delta u^n under a finger with the
    ones before it eliminated: how the sums B^T f of each string respond to tau.
    """
    C_f = model.C_f
    Q_11, Q_12, Q_22 = 0.0, 0.0, 0.0
    W_11, W_12, W_22 = 0.0, 0.0, 0.0
    WB_11, WB_12, WB_21, WB_22 = 0.0, 0.0, 0.0, 0.0
    for a in range(near):
        p, q = STRINGS * c.candidates[a], STRINGS * c.candidates[a] + 1
        C_pp, C_pq, C_qq = c.self_compliance[p] + C_f, C_f, c.self_compliance[q] + C_f
        B_11, B_12, B_21, B_22 = w.Delta_u_at[p], 0.0, 0.0, w.Delta_u_at[q]
        if c.meets_previous[a]:
            X_p, X_q = c.previous_coupling[a, 0], c.previous_coupling[a, 1]
            C_pp -= X_p * X_p * W_11
            C_pq -= X_p * X_q * W_12
            C_qq -= X_q * X_q * W_22
            B_11, B_12 = B_11 - X_p * WB_11, -X_p * WB_12
            B_21, B_22 = -X_q * WB_21, B_22 - X_q * WB_22
        A_p, A_q = contact_stiffness(model, s, w, p), contact_stiffness(model, s, w, q)
        W_11, W_12, W_22, per_determinant, on_p, on_q = pivot_block(A_p, A_q, C_pp, C_pq, C_qq)
        w.W[a, 0], w.W[a, 1], w.W[a, 2] = W_11, W_12, W_22
        gPsi_p, gPsi_q = w.g[p] * s.Psi[p], w.g[q] * s.Psi[q]
        w.f_0[p] = (gPsi_p * on_q - gPsi_q * A_p * C_pq) * per_determinant
        w.f_0[q] = (gPsi_q * on_p - gPsi_p * A_q * C_pq) * per_determinant
        w.Delta_u_chain[a, 0, 0], w.Delta_u_chain[a, 0, 1] = B_11, B_12
        w.Delta_u_chain[a, 1, 0], w.Delta_u_chain[a, 1, 1] = B_21, B_22
        WB_11, WB_12 = W_11 * B_11 + W_12 * B_21, W_11 * B_12 + W_12 * B_22
        WB_21, WB_22 = W_12 * B_11 + W_22 * B_21, W_12 * B_12 + W_22 * B_22
        Q_11 += B_11 * WB_11 + B_21 * WB_21
        Q_12 += B_12 * WB_11 + B_22 * WB_21
        Q_22 += B_12 * WB_12 + B_22 * WB_22
    return Q_11, Q_12, Q_22


@compiled
def eliminate_chain(
    c: Contacts, w: Work, near: int, Q: Symmetric, bow_response: Response
) -> tuple[float, float]:
    """Eliminate fingers factored by `factor_fingers`; returns as `eliminate_fingers` does.

    Writes tau and f_c with the fingers in place, and how they respond to a newton of the bow's.
    """
    sum_1, sum_2 = substitute_forward(c, w, near)
    inverse = inverse_of_sums(Q, w.K_tt[0, 0], w.K_tt[0, 1], w.K_tt[1, 1])
    return couple_sums(w, Q, inverse, sum_1, sum_2, bow_response)


@compiled
def substitute_forward(c: Contacts, w: Work, near: int) -> tuple[float, float]:
    """Forward substitution of the fingers' forces for no change of tau; return the sums (N m)."""
    sum_1, sum_2 = 0.0, 0.0
    f_p, f_q = 0.0, 0.0
    for a in range(near):
        p, q = STRINGS * c.candidates[a], STRINGS * c.candidates[a] + 1
        travel_p, travel_q = w.travel[p], w.travel[q]
        if c.meets_previous[a]:
            travel_p -= c.previous_coupling[a, 0] * f_p
            travel_q -= c.previous_coupling[a, 1] * f_q
        f_p = w.W[a, 0] * travel_p + w.W[a, 1] * travel_q + w.f_0[p]
        f_q = w.W[a, 1] * travel_p + w.W[a, 2] * travel_q + w.f_0[q]
        w.f_f[p], w.f_f[q] = f_p, f_q
        sum_1 += w.Delta_u_chain[a, 0, 0] * f_p + w.Delta_u_chain[a, 1, 0] * f_q
        sum_2 += w.Delta_u_chain[a, 0, 1] * f_p + w.Delta_u_chain[a, 1, 1] * f_q
    return sum_1, sum_2


@compiled
def inverse_of_sums(Q: Symmetric, K_11: float, K_12: float, K_22: float) -> Matrix:
    """Return (1 - Q K_tt)^-1, which lets tension follow the sums."""
    Q_11, Q_12, Q_22 = Q
    a_11, a_12 = 1.0 - (Q_11 * K_11 + Q_12 * K_12), Q_11 * K_12 + Q_12 * K_22
    a_21, a_22 = Q_12 * K_11 + Q_22 * K_12, 1.0 - (Q_12 * K_12 + Q_22 * K_22)
    per_determinant = 1.0 / (a_11 * a_22 - a_12 * a_21)
    return (
        a_22 * per_determinant,
        a_12 * per_determinant,
        a_21 * per_determinant,
        a_11 * per_determinant,
    )


@compiled
def couple_sums(
    w: Work, Q: Symmetric, inverse: Matrix, sum_1: float, sum_2: float, bow_response: Response
) -> tuple[float, float]:
    """Let tension and bridge follow the fingers' sums; returns as `eliminate_fingers` does."""
    Q_11, Q_12, Q_22 = Q
    i_11, i_12, i_21, i_22 = inverse
    K_11, K_12, K_22 = w.K_tt[0, 0], w.K_tt[0, 1], w.K_tt[1, 1]
    bow_1, bow_2 = bow_response[0], bow_response[1]
    # The sums for no change of tau per newton of the bow's, then both with tension following.
    sum_1_per_f_b, sum_2_per_f_b = Q_11 * bow_1 + Q_12 * bow_2, Q_12 * bow_1 + Q_22 * bow_2
    sum_1, sum_2 = i_11 * sum_1 + i_12 * sum_2, i_22 * sum_2 + i_21 * sum_1
    sum_1_per_f_b, sum_2_per_f_b = (
        i_11 * sum_1_per_f_b + i_12 * sum_2_per_f_b,
        i_22 * sum_2_per_f_b + i_21 * sum_1_per_f_b,
    )
    tau_1, tau_2 = K_11 * sum_1 + K_12 * sum_2, K_12 * sum_1 + K_22 * sum_2
    w.tau_fingers[0], w.tau_fingers[1] = tau_1, tau_2
    w.tau[0] += tau_1
    w.tau[1] += tau_2
    w.tau_per_newton[0] += K_11 * sum_1_per_f_b + K_12 * sum_2_per_f_b
    w.tau_per_newton[1] += K_12 * sum_1_per_f_b + K_22 * sum_2_per_f_b
    for i in range(STRINGS):
        w.f_c[i] += w.K_tc[0, i] * sum_1 + w.K_tc[1, i] * sum_2
        w.f_c_per_newton[i] += w.K_tc[0, i] * sum_1_per_f_b + w.K_tc[1, i] * sum_2_per_f_b
    return -(bow_1 * sum_1 + bow_2 * sum_2), bow_1 * sum_1_per_f_b + bow_2 * sum_2_per_f_b


@compiled
def back_substitute_chain(
    model: Model, s: Motion, c: Contacts, w: Work, next_: int, near: int, f_b: float
) -> None:
    """Find the forces of fingers eliminated by `eliminate_chain`, from the last to the first."""
    tau_1 = w.tau_fingers[0] + w.tau_per_newton[0] * f_b
    tau_2 = w.tau_fingers[1] + w.tau_per_newton[1] * f_b
    f_p, f_q = 0.0, 0.0
    for back in range(near):
        a = near - 1 - back
        p, q = STRINGS * c.candidates[a], STRINGS * c.candidates[a] + 1
        travel_p = w.Delta_u_chain[a, 0, 0] * tau_1 + w.Delta_u_chain[a, 0, 1] * tau_2
        travel_q = w.Delta_u_chain[a, 1, 0] * tau_1 + w.Delta_u_chain[a, 1, 1] * tau_2
        if back > 0 and c.meets_previous[a + 1]:
            travel_p -= c.previous_coupling[a + 1, 0] * f_p
            travel_q -= c.previous_coupling[a + 1, 1] * f_q
        f_p = w.f_f[p] + w.W[a, 0] * travel_p + w.W[a, 1] * travel_q
        f_q = w.f_f[q] + w.W[a, 1] * travel_p + w.W[a, 2] * travel_q
        advance_contact(model, s, w, next_, p, f_p)
        advance_contact(model, s, w, next_, q, f_q)


# ---------------------------------------------------------------- contacts that share nodes


@compiled
def assemble_contacts(model: Model, s: Motion, c: Contacts, w: Work, near: int) -> None:
    """Write the system of all contacts that press: A_f, the right-hand side d, and G.

    The last column of G is the compliance between each contact and the bow.
    """
    count = 0
    for a in range(near):
        for i in range(STRINGS):
            p = STRINGS * c.candidates[a] + i
            if w.g[p] > 0.0:
                w.touching[count] = p
                w.A_f[count] = contact_stiffness(model, s, w, p)
                w.d[count] = w.A_f[count] * w.travel[p] + w.g[p] * s.Psi[p]
                count += 1
    w.touching_count = count
    for row in range(count):
        p = w.touching[row]
        p_response = response(c, w, p)
        for column in range(row + 1):
            q = w.touching[column]
            G = compliance(model, c, w, q, p, p_response)
            if p // STRINGS == q // STRINGS:
                G += model.C_f
            w.G[column, row] = G
        w.G[row, count] = w.bow_compliance[p]


@compiled
def eliminate_jointly(
    model: Model, s: Motion, c: Contacts, w: Work, near: int
) -> tuple[float, float]:
    """Eliminate contacts one after the other; returns as `eliminate_fingers` does.

    1 + A G, with A diagonal and G positive definite, needs no pivoting.
    """
    assemble_contacts(model, s, c, w, near)
    count = w.touching_count
    displacement, compliance_reduction = 0.0, 0.0
    for row in range(count):
        per_pivot = 1.0 / (1.0 + w.A_f[row] * w.G[row, row])
        d, A_f = w.d[row] * per_pivot, w.A_f[row] * per_pivot
        w.d[row], w.A_f[row] = d, A_f
        for other in range(row + 1, count):
            G = w.G[row, other]
            w.d[other] -= w.A_f[other] * G * d
            for column in range(other, count + 1):
                w.G[other, column] -= A_f * G * w.G[row, column]
        G = w.G[row, count]
        displacement += G * d
        compliance_reduction += G * G * A_f
    return displacement, compliance_reduction


@compiled
def back_substitute_jointly(
    model: Model, s: Motion, c: Contacts, w: Work, next_: int, f_b: float
) -> None:
    """Find the forces of contacts eliminated by `eliminate_jointly`, from the last to the first."""
    count = w.touching_count
    for row in range(count - 1, -1, -1):
        p = w.touching[row]
        displacement = w.G[row, count] * f_b
        for other in range(row + 1, count):
            displacement += w.G[row, other] * w.f_f[w.touching[other]]
        f_f = w.d[row] - w.A_f[row] * displacement
        advance_contact(model, s, w, next_, p, f_f)
        p_response = response(c, w, p)
        for i in range(STRINGS):
            w.tau[i] += p_response[i] * f_f
            w.f_c[i] += p_response[STRINGS + i] * f_f
