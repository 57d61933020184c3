"""Fingers that stop the strings: [Yehu] eqs. (33)-(36), by energy quadratisation.

Differs, each measured (docs/physics.md): the press is a positive force, negated here
once; Psi is set to zero where there is no penetration or where it would be negative,
and the energy so given up is booked (it makes case 2 of eq. (34) unreachable); a finger
without press returns to its rest height.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.physics.contacts import answer, eliminate, feel, push
from yehu_server.physics.layout import BOW, CONTROLS_PER_FINGER, FINGER_CONTROLS, STRINGS
from yehu_server.physics.quantities import Quantities
from yehu_server.physics.stencil import read
from yehu_server.physics.tension import reading, tension_varies

Array = Any

FRICTION_REACH = 4.0  # times mu_S F_N: more than bristles and their damping can hold


def prepare_fingers(model: np.void, quantities: Quantities) -> None:
    """Write the fingers' coefficients into `model`."""
    finger = quantities.finger
    for name in ("M_f", "K_f", "alpha", "beta", "rest_height"):
        model[name] = getattr(finger, name)
    model["K_lift"] = finger.M_f * finger.omega_lift**2
    model["R_lift"] = 2.0 * finger.M_f * finger.omega_lift  # critical damping


@compiled
def advance_finger(model: Any, s: Any, j: int, control: Array, now: int, prev: int) -> float:
    """Return U* of eq. (58), the finger's height free of contacts (m).

    A press (N) above zero drives the finger down; without one the hand lifts it with
    a critically damped spring, an outside force whose work counts as power in.
    """
    press = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j + 1]
    U, U_prev = s.U[now, j], s.U[prev, j]
    if press > 0.0:
        s.f_ext[j] = -press
    else:
        s.f_ext[j] = -model.K_lift * (U - model.rest_height) - model.R_lift * (U - U_prev) / model.k
    return float(2.0 * U - U_prev + model.k * model.k * s.f_ext[j] / model.M_f)


@compiled
def reset_contact(s: Any, p: int, eta: float) -> None:
    """Drop a quadratised potential that no penetration backs, and book its energy."""
    if s.Psi[p] != 0.0 and (eta <= 0.0 or s.Psi[p] < 0.0):
        s.dropped_Psi += 0.5 * s.Psi[p] * s.Psi[p]
        s.Psi[p] = 0.0


@compiled
def contact_gradient(model: Any, Psi: float, eta: float, travel: float) -> float:
    """Return g = theta ghat of eqs. (33) and (34).

    Parameters
    ----------
    Psi : float, sqrt(J)
        Not negative, and zero where `eta` is not positive.
    eta, travel : float, m
        Penetration now; eta* - eta^{n-1}, its change over two steps without contacts.
    """
    if eta <= 0.0:
        return 0.0
    g = math.sqrt(0.5 * model.K_f * (model.alpha + 1.0)) * eta ** (0.5 * (model.alpha - 1.0))
    if 4.0 * Psi + g * travel < 0.0:
        g = -4.0 * Psi / travel
    return float(g)


@compiled
def meet_fingers(
    model: Any, s: Any, u_next: Array, u: Array, u_prev: Array, next_: int, now: int, prev: int
) -> int:
    """Linearise every contact for this step, eq. (35); return how many touch.

    `u_next` holds the strings with bow and bridge but without fingers, ``s.U[next_]``
    the free fingers. A contact's force is then
    f_f = d - A_f (what all contacts together push it back).
    """
    touching = 0
    k = model.k
    for j in range(model.fingers):
        for i in range(STRINGS):
            p = STRINGS * j + i
            eta = read(u[i], s.first[p], s.weights[p]) - s.U[now, j]
            reset_contact(s, p, eta)
            s.g[p], s.A_f[p], s.d[p], s.f_f[p] = 0.0, 0.0, 0.0, 0.0
            if eta > 0.0:
                # The same I_f at all three times, so that the energy closes as x_f moves.
                s.eta_prev[p] = read(u_prev[i], s.first[p], s.weights[p]) - s.U[prev, j]
                feel(s, p)
                bend = s.bend_at[p]
                eta_star = reading(s, u_next, i, s.first[p], s.weights[p], bend) - s.U[next_, j]
                travel = eta_star - s.eta_prev[p]
                g = contact_gradient(model, s.Psi[p], eta, travel)
                if g > 0.0:
                    touching += 1
                    s.g[p] = g
                    s.A_f[p] = 0.25 * g * g + 0.5 * model.beta * g * s.Psi[p] / k
                    s.d[p] = s.A_f[p] * travel + g * s.Psi[p]
    return touching


@compiled
def friction_decides(model: Any, s: Any, F_N: float) -> bool:
    """Whether theta of eq. (34) may be below 1 for some friction force within a bow's reach.

    It depends on the free motion, which has the friction force in it; while no contact is near
    that, the force need not be known yet.
    """
    reach = FRICTION_REACH * model.mu_S * F_N
    for p in range(STRINGS * model.fingers):
        if s.g[p] != 0.0:
            travel = (s.d[p] - s.g[p] * s.Psi[p]) / s.A_f[p]
            travel -= abs(answer(model, s, p, BOW)) * reach
            if 4.0 * s.Psi[p] + s.g[p] * travel < 0.0:
                return True
    return False


@compiled
def touch_apart(model: Any, s: Any, bowed: bool) -> bool:
    """Whether no contact that touches feels another, so that each can be solved for itself."""
    if tension_varies(s):
        return False
    contacts = STRINGS * model.fingers
    for p in range(contacts):
        if s.g[p] == 0.0:
            continue
        if bowed and answer(model, s, p, BOW) != 0.0:
            return False
        for q in range(p):
            if s.g[q] != 0.0 and answer(model, s, p, q) != 0.0:
                return False
    return True


@compiled
def solve_apart(model: Any, s: Any) -> None:
    """Contact forces where stencils do not overlap: eqs. (37)-(40), finger by finger."""
    compliance = model.k * model.k / model.M_f
    for j in range(model.fingers):
        total, weight = 0.0, 1.0
        for i in range(STRINGS):
            p = STRINGS * j + i
            if s.g[p] != 0.0:
                stiffness = 1.0 + s.A_f[p] * answer(model, s, p, p)
                total += s.d[p] / stiffness
                weight += compliance * s.A_f[p] / stiffness
        total /= weight  # f_f,1 + f_f,2
        for i in range(STRINGS):
            p = STRINGS * j + i
            if s.g[p] != 0.0:
                pushed = s.d[p] - s.A_f[p] * compliance * total
                s.f_f[p] = pushed / (1.0 + s.A_f[p] * answer(model, s, p, p))


@compiled
def solve_jointly(model: Any, s: Any) -> tuple[float, float]:
    """Contact forces as they would be at the given friction, and per newton more of it.

    Leaves both in ``s.sides``, over the touching contacts in order, and returns what
    they take from the bow's reading (m, and m/N): G_b f_f.
    """
    compliance = model.k * model.k / model.M_f
    contacts = STRINGS * model.fingers
    row = 0
    for p in range(contacts):
        if s.g[p] == 0.0:
            continue
        column = 0
        for q in range(contacts):
            if s.g[q] == 0.0:
                continue
            G = answer(model, s, p, q)
            if p // STRINGS == q // STRINGS:
                G += compliance
            s.matrix[row, column] = s.A_f[p] * G + (1.0 if p == q else 0.0)
            column += 1
        s.sides[0, row] = s.d[p]
        s.sides[1, row] = -s.A_f[p] * answer(model, s, p, BOW)
        row += 1
    eliminate(s.matrix, s.sides, row)
    taken, taken_per_newton = 0.0, 0.0
    row = 0
    for p in range(contacts):
        if s.g[p] != 0.0:
            G = answer(model, s, BOW, p)
            taken += G * s.sides[0, row]
            taken_per_newton += G * s.sides[1, row]
            row += 1
    return taken, taken_per_newton


@compiled
def take_forces(model: Any, s: Any, more_friction: float) -> None:
    """Write ``s.f_f`` from the two sides of `solve_jointly`."""
    row = 0
    for p in range(STRINGS * model.fingers):
        if s.g[p] != 0.0:
            s.f_f[p] = s.sides[0, row] + s.sides[1, row] * more_friction
            row += 1


@compiled
def push_fingers(model: Any, s: Any, u_next: Array, next_: int) -> None:
    """Push the strings and the fingers by ``s.f_f``."""
    compliance = model.k * model.k / model.M_f
    for j in range(model.fingers):
        for i in range(STRINGS):
            p = STRINGS * j + i
            if s.g[p] != 0.0:
                push(model, s, u_next, p, s.f_f[p])
                s.U[next_, j] += compliance * s.f_f[p]


@compiled
def store_contacts(model: Any, s: Any, u_next: Array, next_: int) -> None:
    """Advance Psi by eq. (33), once the strings are where they will be."""
    for j in range(model.fingers):
        for i in range(STRINGS):
            p = STRINGS * j + i
            if s.g[p] != 0.0:
                eta_next = read(u_next[i], s.first[p], s.weights[p]) - s.U[next_, j]
                s.Psi[p] += 0.5 * s.g[p] * (eta_next - s.eta_prev[p])
