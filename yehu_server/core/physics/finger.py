"""Fingers that stop the strings: [Yehu] eqs. (33)-(36), by energy quadratisation.

Differences from the paper, each measured (docs/physics.md): the press is a positive force, negated
here once; Psi is set to zero where there is no penetration or where it would be negative, and the
energy so given up is recorded in the ledger (it makes case 2 of eq. (34) unreachable); a finger
without press returns to its rest height.
"""

import math

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.fixed_power import power, prepare_power
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import CONTROLS_PER_FINGER, FINGER_CONTROLS, STRINGS
from yehu_server.core.physics.records import Array, Contacts, Model, Motion, Work


def prepare_fingers(model: np.void, quantities: Quantities) -> None:
    """Write the fingers' coefficients into `model`."""
    finger = quantities.finger
    for name in ("M_f", "K_f", "beta", "rest_height"):
        model[name] = getattr(finger, name)
    model["C_f"] = model["k"] * model["k"] / finger.M_f
    ghat_1 = math.sqrt(0.5 * finger.K_f * (finger.alpha + 1.0))
    prepare_power(model["ghat"], ghat_1, 0.5 * (finger.alpha - 1.0))
    model["K_lift"] = finger.M_f * finger.omega_lift * finger.omega_lift
    model["R_lift"] = 2.0 * finger.M_f * finger.omega_lift  # critical damping


@compiled
def advance_finger(
    model: Model, s: Motion, w: Work, j: int, press: float, now: int, prev: int
) -> float:
    """Return U* of eq. (58), the finger's height free of contacts (m).

    A press (N) above zero drives the finger down; without one the hand lifts it with
    a critically damped spring, an outside force whose work counts as power in.
    """
    U, U_prev = s.U[now, j], s.U[prev, j]
    if press > 0.0:
        w.f_ext[j] = -press
    else:
        w.f_ext[j] = model.K_lift * (model.rest_height - U)
        w.f_ext[j] -= model.R_lift * model.rate * (U - U_prev)
    return float(2.0 * U - U_prev + model.C_f * w.f_ext[j])


@compiled
def reset_contact(s: Motion, w: Work, p: int, eta: float) -> None:
    """Drop a quadratised potential without penetration, and add its energy to the ledger."""
    if s.Psi[p] != 0.0 and (eta <= 0.0 or s.Psi[p] < 0.0):
        w.dropped_Psi += 0.5 * s.Psi[p] * s.Psi[p]
        s.Psi[p] = 0.0


@compiled
def gradient(model: Model, eta: float) -> float:
    """Return ghat of eq. (33) at a penetration (m) above zero."""
    return power(model.ghat, eta)


@compiled
def limited_gradient(ghat: float, Psi: float, travel: float) -> float:
    """Return g = theta ghat of eqs. (33) and (34).

    Psi (sqrt(J)) is not negative, and zero where nothing is penetrated; `travel` (m) is eta* -
    eta^{n-1}, the change of penetration over two steps without the fingers' forces.
    """
    if 4.0 * Psi + ghat * travel < 0.0:
        return -4.0 * Psi / travel
    return ghat


@compiled
def advance_fingers(
    model: Model, s: Motion, c: Contacts, w: Work, control: Array, next_: int, now: int, prev: int
) -> int:
    """Advance the fingers free of contacts; list those that may touch a string in ``c.candidates``.

    Returns their number. Writes what is known at n of their contacts: ghat, eta^{n-1}, Delta u^n.
    """
    candidate_count, c.candidate_bits = 0, 0
    x_f, u_1, u_2 = -1.0, 0.0, 0.0
    for place in range(model.fingers):
        j = c.order[place]
        press = control[FINGER_CONTROLS + CONTROLS_PER_FINGER * j + 1]
        U = s.U[now, j]
        if s.resting[j] and press <= 0.0:
            p, q = STRINGS * j, STRINGS * j + 1
            if c.x[p] != x_f:  # fingers at rest mostly share one position
                x_f = c.x[p]
                u_1 = interpolate(s.u[now, 0], c.first[p], c.weights[p])
                u_2 = interpolate(s.u[now, 1], c.first[q], c.weights[q])
            if u_1 <= U and u_2 <= U:
                s.U[next_, j] = U
                continue
        s.U[next_, j] = advance_finger(model, s, w, j, press, now, prev)
        is_near = False
        for i in range(STRINGS):
            p = STRINGS * j + i
            first, weights = c.first[p], c.weights[p]
            eta = interpolate(s.u[now, i], first, weights) - U
            reset_contact(s, w, p, eta)
            ghat = 0.0
            if eta > 0.0:
                is_near = True
                ghat = gradient(model, eta)
                # The same I_f at all three times, so that the energy closes as x_f moves.
                w.eta_prev[p] = interpolate(s.u[prev, i], first, weights) - s.U[prev, j]
                w.Delta_u_at[p] = interpolate(s.Delta_u[i], first, weights)
            w.g[p], w.ghat[p], w.f_f[p] = ghat, ghat, 0.0
        s.resting[j] = 0
        if is_near:
            c.candidates[candidate_count] = j
            c.candidate_bits |= 1 << j
            candidate_count += 1
        elif press <= 0.0 and s.U[next_, j] == U and s.U[prev, j] == U:
            s.resting[j] = 1
    return candidate_count


@compiled
def may_detach(s: Motion, w: Work, p: int, f_b: float, margin: float) -> bool:
    """Whether theta of eq. (34) may be below 1 for friction within `margin` of `f_b` (N)."""
    G = w.bow_compliance[p]
    travel = w.travel[p] - G * f_b - abs(G) * margin
    return bool(4.0 * s.Psi[p] + w.ghat[p] * travel < 0.0)


@compiled
def limit_gradients(s: Motion, c: Contacts, w: Work, candidate_count: int, f_b: float) -> None:
    """Write g = theta ghat of eq. (34) of every contact, for a friction force (N)."""
    for a in range(candidate_count):
        for i in range(STRINGS):
            p = STRINGS * c.candidates[a] + i
            w.g[p] = limited_gradient(w.ghat[p], s.Psi[p], w.travel[p] - w.bow_compliance[p] * f_b)


@compiled
def contact_stiffness(model: Model, s: Motion, w: Work, p: int) -> float:
    """Return A_f of eq. (35): how a contact's force grows with its travel (N/m)."""
    g = w.g[p]
    return float(0.25 * g * g + 0.5 * model.rate * model.beta * g * s.Psi[p])


@compiled
def advance_contact(model: Model, s: Motion, w: Work, next_: int, p: int, f_f: float) -> None:
    """Move a finger by a contact's force, known by now (N), and advance Psi: eqs. (33), (36).

    By eq. (35) the force is A_f times the contact's travel, plus g Psi; eq. (33) takes the travel.
    """
    w.f_f[p] = f_f
    s.U[next_, p // STRINGS] += model.C_f * f_f
    g, Psi = w.g[p], s.Psi[p]
    if g > 0.0:
        s.Psi[p] += 0.5 * (f_f - g * Psi) / (0.25 * g + 0.5 * model.rate * model.beta * Psi)
