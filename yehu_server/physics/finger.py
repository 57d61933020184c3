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
def advance_finger(model: Any, s: Any, j: int, press: float, now: int, prev: int) -> float:
    """Return U* of eq. (58), the finger's height free of contacts (m).

    A press (N) above zero drives the finger down; without one the hand lifts it with
    a critically damped spring, an outside force whose work counts as power in.
    """
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
    """Let the fingers move, free of contacts, and list those that may touch a string.

    Returns how many: ``s.near`` has them. What concerns them and is known at n is written here.
    """
    near, s.are_near = 0, 0
    x_f, reading_1, reading_2 = -1.0, 0.0, 0.0
    for k in range(model.fingers):
        j = s.order[k]
        press = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j + 1]
        U = s.U[now, j]
        if s.still[j] and press <= 0.0:
            p, q = STRINGS * j, STRINGS * j + 1
            if s.x[p] != x_f:  # those that are up wait at one place
                x_f = s.x[p]
                reading_1 = read(s.u[now, 0], s.first[p], s.weights[p])
                reading_2 = read(s.u[now, 1], s.first[q], s.weights[q])
            if reading_1 <= U and reading_2 <= U:
                s.U[next_, j] = U
                continue
        s.U[next_, j] = advance_finger(model, s, j, press, now, prev)
        is_near = False
        for i in range(STRINGS):
            p = STRINGS * j + i
            first, weights = s.first[p], s.weights[p]
            eta = read(s.u[now, i], first, weights) - U
            reset_contact(s, p, eta)
            ghat = 0.0
            if eta > 0.0:
                is_near = True
                ghat = gradient(model, eta)
                # The same I_f at all three times, so that the energy closes as x_f moves.
                eta_prev = read(s.u[prev, i], first, weights) - s.U[prev, j]
                s.bend_at[p], s.eta_prev[p] = read(s.bend[i], first, weights), eta_prev
            s.g[p], s.ghat[p], s.f_f[p] = ghat, ghat, 0.0
        s.still[j] = 0
        if is_near:
            s.near[near] = j
            s.are_near |= 1 << j
            near += 1
        elif press <= 0.0 and s.U[next_, j] == U and s.U[prev, j] == U:
            s.still[j] = 1
    return near


@compiled
def may_leave(s: Any, p: int, f_b: float, doubt: float) -> bool:
    """Whether theta of eq. (34) may be below 1: with a friction force `f_b`, or `doubt` beside it.

    Both in N.
    """
    at_bow = s.at_bow[p]
    travel = s.travel[p] - at_bow * f_b - abs(at_bow) * doubt
    return bool(4.0 * s.Psi[p] + s.ghat[p] * travel < 0.0)


@compiled
def limit_fingers(s: Any, near: int, f_b: float) -> None:
    """Find theta of every contact for a friction force (N), so that ``s.g`` is that of eq. (34)."""
    for c in range(near):
        for i in range(STRINGS):
            p = STRINGS * s.near[c] + i
            s.g[p] = limited(s.ghat[p], s.Psi[p], s.travel[p] - s.at_bow[p] * f_b)


@compiled
def stiffness(model: Any, s: Any, p: int) -> float:
    """Return A_f of eq. (35): what a contact's force grows by with its travel (N/m)."""
    g = s.g[p]
    return float(0.25 * g * g + 0.5 * model.rate * model.beta * g * s.Psi[p])


@compiled
def settle(model: Any, s: Any, next_: int, p: int, f_f: float) -> None:
    """Let a contact's force, known by now, move its finger; advance Psi.

    By eq. (35) the force is A_f times the contact's travel, plus g Psi: so that is the travel of
    eq. (33).
    """
    s.f_f[p] = f_f
    s.U[next_, p // STRINGS] += model.C_f * f_f
    g, Psi = s.g[p], s.Psi[p]
    if g > 0.0:
        s.Psi[p] += 0.5 * (f_f - g * Psi) / (0.25 * g + 0.5 * model.rate * model.beta * Psi)
