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
from yehu_server.physics.contacts import answer, push
from yehu_server.physics.layout import CONTROLS_PER_FINGER, FINGER_CONTROLS, STRINGS
from yehu_server.physics.power import power, prepare_power
from yehu_server.physics.quantities import Quantities
from yehu_server.physics.stencil import read

Array = Any


def prepare_fingers(model: np.void, quantities: Quantities) -> None:
    """Write the fingers' coefficients into `model`."""
    finger = quantities.finger
    for name in ("M_f", "K_f", "beta", "rest_height"):
        model[name] = getattr(finger, name)
    model["C_f"] = model["k"] ** 2 / finger.M_f
    ghat_1 = math.sqrt(0.5 * finger.K_f * (finger.alpha + 1.0))
    prepare_power(model, ghat_1, 0.5 * (finger.alpha - 1.0))
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
        s.f_ext[j] = model.K_lift * (model.rest_height - U)
        s.f_ext[j] -= model.R_lift * model.rate * (U - U_prev)
    return float(2.0 * U - U_prev + model.C_f * s.f_ext[j])


@compiled
def reset_contact(s: Any, p: int, eta: float) -> None:
    """Drop a quadratised potential that no penetration backs, and book its energy."""
    if s.Psi[p] != 0.0 and (eta <= 0.0 or s.Psi[p] < 0.0):
        s.dropped_Psi += 0.5 * s.Psi[p] * s.Psi[p]
        s.Psi[p] = 0.0


@compiled
def gradient(model: Any, eta: float) -> float:
    """Return ghat of eq. (33) at a penetration (m) above zero."""
    return power(model, eta)


@compiled
def limited(ghat: float, Psi: float, travel: float) -> float:
    """Return g = theta ghat of eqs. (33) and (34).

    Parameters
    ----------
    Psi : float, sqrt(J)
        Not negative, and zero where nothing is penetrated.
    travel : float, m
        eta* - eta^{n-1}, the change of penetration over two steps without contacts.
    """
    if 4.0 * Psi + ghat * travel < 0.0:
        return -4.0 * Psi / travel
    return ghat


@compiled
def meet_fingers(model: Any, s: Any, control: Array, next_: int, now: int, prev: int) -> int:
    """Let the fingers move, free of contacts, and list those contacts that may touch.

    Returns how many: ``s.near`` has them. What concerns them and is known at n is written here.
    """
    near = 0
    for j in range(model.fingers):
        s.U[next_, j] = advance_finger(model, s, j, control, now, prev)
        for i in range(STRINGS):
            p = STRINGS * j + i
            eta = read(s.u[now, i], s.first[p], s.weights[p]) - s.U[now, j]
            reset_contact(s, p, eta)
            s.g[p], s.f_f[p] = 0.0, 0.0
            if eta > 0.0:
                s.near[near] = p
                near += 1
                s.ghat[p] = gradient(model, eta)
                # The same I_f at all three times, so that the energy closes as x_f moves.
                s.eta_prev[p] = read(s.u[prev, i], s.first[p], s.weights[p]) - s.U[prev, j]
    return near


@compiled
def press_fingers(
    model: Any, s: Any, next_: int, near: int, f_b: float, doubt: float
) -> tuple[int, bool]:
    """Linearise every contact for this step, eq. (35); list those that touch.

    Without other forces a contact's is then d, and A_f less for every metre that they push it.

    Parameters
    ----------
    f_b, doubt : float, N
        The friction force that theta of eq. (34) is found with, and how far off it may be.

    Returns
    -------
    touching : int
        How many: ``s.touching`` has them.
    friction_decides : bool
        Whether theta may be below 1, or a contact leave, for some friction force in doubt.
    """
    touching = 0
    friction_decides = False
    for c in range(near):
        p = s.near[c]
        Psi, ghat, at_bow = s.Psi[p], s.ghat[p], s.at_bow[p]
        free = s.free[p] - s.U[next_, p // STRINGS] - s.eta_prev[p]
        travel = free - at_bow * f_b
        if 4.0 * Psi + ghat * (travel - abs(at_bow) * doubt) < 0.0 and at_bow != 0.0:
            friction_decides = True
        g = limited(ghat, Psi, travel)
        s.g[p] = g
        if g > 0.0:
            s.touching[touching] = p
            s.A_f[touching] = 0.25 * g * g + 0.5 * model.rate * model.beta * g * Psi
            s.d[touching] = s.A_f[touching] * free + g * Psi
            touching += 1
    return touching, friction_decides


@compiled
def close_contacts(model: Any, s: Any, touching: int) -> tuple[float, float]:
    """Let one contact after the other press, until only the bow's force is open: eqs. (37)-(40).

    Each takes its part of every G[p, q] that is still to come. Returns by how much the bow's
    reading moves with all contacts closed (m), and how much less it gives way (m/N).
    """
    bow = touching
    for row in range(touching):
        p = s.touching[row]
        for column in range(row + 1):
            q = s.touching[column]
            G = answer(model, s, p, q)
            if p // STRINGS == q // STRINGS:
                G += model.C_f
            s.G[column, row] = G
        s.G[row, bow] = s.at_bow[p]
    taken, taken_per_newton = 0.0, 0.0
    for row in range(touching):
        per_stiffness = 1.0 / (1.0 + s.A_f[row] * s.G[row, row])
        d, A_f = s.d[row] * per_stiffness, s.A_f[row] * per_stiffness
        s.d[row], s.A_f[row] = d, A_f
        for other in range(row + 1, touching):
            G = s.G[row, other]
            s.d[other] -= s.A_f[other] * G * d
            for column in range(other, bow + 1):
                s.G[other, column] -= A_f * G * s.G[row, column]
        G = s.G[row, bow]
        taken += G * d
        taken_per_newton += G * G * A_f
    return taken, taken_per_newton


@compiled
def push_fingers(model: Any, s: Any, next_: int, touching: int, f_b: float) -> None:
    """Find the contacts' forces, the bow's known; push strings and fingers, and advance Psi.

    By eq. (35) a contact's force is A_f times its travel, plus g Psi: so that is the travel of
    eq. (33).
    """
    for row in range(touching - 1, -1, -1):
        p = s.touching[row]
        pushed = s.G[row, touching] * f_b
        for other in range(row + 1, touching):
            pushed += s.G[row, other] * s.f_f[s.touching[other]]
        f_f = s.d[row] - s.A_f[row] * pushed
        s.f_f[p] = f_f
        push(s, p, f_f)
        s.U[next_, p // STRINGS] += model.C_f * f_f
        g, Psi = s.g[p], s.Psi[p]
        s.Psi[p] += 0.5 * (f_f - g * Psi) / (0.25 * g + 0.5 * model.rate * model.beta * Psi)
