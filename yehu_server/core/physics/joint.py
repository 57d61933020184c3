"""One linear system for all forces of a step on strings that move in two directions.

A row is a force x: the tension of a string, the bridge's on a string in one direction, that of a
contact, or friction at a point of the hair. Each moves strings, bridge, fingers and bow by
spreading; G[r, q] is how far a newton of q moves what r reads, against r's own direction, and

    D_r x_r + sum of G[r, q] x_q = b_r,

b being what r reads without any of these forces, and D the own compliance of its law: none at the
bridge. G is symmetric, and D + G positive definite, so rows are eliminated one after the other
without pivoting. Friction comes last: what is left for its rows is what the bow feels.
Derivation: docs/derivation.md, section 11.
"""

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.grid import interpolate, overlap, spread
from yehu_server.core.physics.layout import BOW, STENCIL, STRINGS
from yehu_server.core.physics.planes import BOWING, BRIDGE_ROW, NORMAL
from yehu_server.core.physics.records import Array, Modal, Model, Motion, Planes, Work

NO_FORCE = -1.0  # in place of D


@compiled
def bridge_row(plane: int, i: int) -> int:
    """The row of the bridge's force on a string in a plane."""
    return BRIDGE_ROW + STRINGS * plane + i


@compiled
def bridge_reads(d: Planes, row: int) -> tuple[float, float]:
    """Return how far the bridge moves, in a row's direction, by its modes q and by p."""
    i = d.string[row]
    return (1.0, 0.0) if d.plane[row] == BOWING else (d.rocking[i], d.bounce)


@compiled
def write_strings(
    m: Model, d: Planes, s: Motion, n: Motion, w: Work, wn: Work, next_: int,
    q_sum: float, p_sum: float,
) -> None:  # fmt: skip
    """Begin the system with the rows of tension and bridge, of which q and p have some sums (m)."""
    for i in range(STRINGS):
        squared = w.Delta_u_squared[i] + wn.Delta_u_squared[i]
        d.G[i, i] = m.spread[i] * squared
        d.D[i] = m.spread[i] / m.tension_gain[i] if m.tension_gain[i] > 0.0 else NO_FORCE
        d.b[i] = w.Delta_u_travel[i] + wn.Delta_u_travel[i]
        d.G[0, 1] = d.G[1, 0] = 0.0
    d.rows = BRIDGE_ROW
    for plane in range(2):
        motion = s if plane == BOWING else n
        for i in range(STRINGS):
            row = d.rows
            add_row(m, d, s, n, plane, i, BOW, m.bridge_first[i], m.bridge_weights[i], 1.0)
            of_q, of_p = bridge_reads(d, row)
            read = interpolate(motion.u[next_, i], m.bridge_first[i], m.bridge_weights[i])
            d.b[row] = read - of_q * q_sum - of_p * p_sum
            d.D[row] = 0.0
            for other in range(BRIDGE_ROW, row + 1):
                q, p = bridge_reads(d, other)
                G = d.G[row, other] + m.C_q_sum * (of_q * q + of_p * p)
                d.G[row, other] = d.G[other, row] = G


@compiled
def add_row(
    m: Model, d: Planes, s: Motion, n: Motion, plane: int, i: int, contact: int,
    first: int, weights: Array, side: float,
) -> None:  # fmt: skip
    """Add a force on string `i` in a plane: how far the rows before it move it, and its own.

    `side` is -1 where it pushes the string the other way.
    """
    row = d.rows
    d.rows += 1
    d.plane[row], d.string[row], d.contact[row], d.first[row] = plane, i, contact, first
    for l in range(STENCIL):
        d.weights[row, l] = side * weights[l]
    Delta_u = s.Delta_u[i] if plane == BOWING else n.Delta_u[i]
    for tension in range(STRINGS):
        reads = m.spread[i] * interpolate(Delta_u, first, d.weights[row]) if tension == i else 0.0
        d.G[row, tension] = d.G[tension, row] = reads
    for other in range(BRIDGE_ROW, row + 1):
        G = 0.0
        if d.plane[other] == plane and d.string[other] == i:
            G = m.spread[i] * overlap(
                d.first[other], d.weights[other], d.first[row], d.weights[row]
            )
        d.G[row, other] = d.G[other, row] = G


@compiled
def eliminate(d: Planes | Modal, begin: int, end: int) -> None:
    """Eliminate the forces of some rows, those before them being eliminated.

    From there on only entries of G above the diagonal hold.
    """
    for row in range(begin, end):
        d.W[row] = 0.0 if d.D[row] == NO_FORCE else 1.0 / (d.D[row] + d.G[row, row])
        for other in range(row + 1, d.rows):
            factor = d.W[row] * d.G[row, other]
            if factor != 0.0:
                d.b[other] -= factor * d.b[row]
                for column in range(other, d.rows):
                    d.G[other, column] -= factor * d.G[row, column]


@compiled
def back_substitute(d: Planes | Modal, end: int) -> None:
    """Find the forces of the rows before `end` from those after it, from the last to the first."""
    for row in range(end - 1, -1, -1):
        x = d.b[row]
        for other in range(row + 1, d.rows):
            x -= d.G[row, other] * d.x[other]
        d.x[row] = d.W[row] * x


@compiled
def push_strings(m: Model, d: Planes, s: Motion, n: Motion, next_: int) -> None:
    """Move both strings by all forces but tension's."""
    for row in range(BRIDGE_ROW, d.rows):
        i = d.string[row]
        motion = s if d.plane[row] == BOWING else n
        spread(motion.u[next_, i], d.first[row], d.weights[row], -m.spread[i] * d.x[row])


@compiled
def push_bridge(d: Planes, w: Work, wn: Work) -> None:
    """Write the forces of the bridge along its modes q, and along p, by string (N)."""
    for i in range(STRINGS):
        along, normal = d.x[bridge_row(BOWING, i)], d.x[bridge_row(NORMAL, i)]
        w.f_c[i] = -along - d.rocking[i] * normal
        wn.f_c[i] = -d.bounce * normal
