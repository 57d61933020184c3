"""The model's time loop: one step of the scheme after another.

[Yehu] section 3.7, in the order that lets contacts share nodes: strings and modes move
freely, the bridge closes over them, the bow draws, the fingers press.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.errors import ParameterError
from yehu_server.jit import compiled
from yehu_server.physics.bow import advance_hair, choose_string, hair_velocity, prepare_bow
from yehu_server.physics.bridge import (
    advance_bridge,
    close_bridge,
    finish_bridge,
    prepare_bridge,
    weigh_bridge,
)
from yehu_server.physics.contacts import answer, feel, place_contacts, push
from yehu_server.physics.energy import book
from yehu_server.physics.finger import (
    advance_finger,
    friction_decides,
    meet_fingers,
    prepare_fingers,
    push_fingers,
    solve_apart,
    solve_jointly,
    store_contacts,
    take_forces,
    touch_apart,
)
from yehu_server.physics.friction import solve_friction
from yehu_server.physics.layout import (
    BOW,
    BRIDGE_FORCE,
    BRIDGE_FORCE_1,
    BRIDGE_FORCE_2,
    BRIDGE_VELOCITY,
    F_HAMMER,
    F_N,
    FINGER_PROBES,
    FRICTION_FORCE,
    ITERATIONS,
    LEVELS,
    MAX_FINGERS,
    MAX_MODES,
    MODEL,
    PRESSURE,
    PROBES_PER_FINGER,
    RELATIVE_VELOCITY,
    STATE,
    STRINGS,
    V_B,
)
from yehu_server.physics.pluck import pull_aside
from yehu_server.physics.quantities import Quantities
from yehu_server.physics.radiation import prepare_radiation, radiate
from yehu_server.physics.string import (
    advance_strings,
    most_loss,
    prepare_strings,
    support,
    weigh_string,
)
from yehu_server.physics.tension import (
    prepare_tension,
    take_up_slack,
    tension_varies,
    tighten,
)

Array = Any

LOST_SIZE = 1e6  # N, m/s, m: nothing of a sound state comes near


def prepare(quantities: Quantities, rate: float, fingers: int = 1) -> Any:
    """Derive every coefficient of the model for one sample rate.

    Returns: ndarray [shape=(1,), dtype=layout.MODEL].
    Errors: ParameterError where the quantities make no stable model at this rate.
    """
    if not 1 <= fingers <= MAX_FINGERS:
        raise ParameterError(f"fingers: 1 to {MAX_FINGERS}, not {fingers}")
    model = np.zeros(1, MODEL)
    record = model[0]
    record["k"] = 1.0 / rate
    record["fingers"] = fingers
    prepare_strings(record, quantities)
    prepare_tension(record, quantities)
    prepare_bridge(record, quantities)
    prepare_bow(record, quantities)
    prepare_fingers(record, quantities)
    prepare_radiation(record, quantities.body)
    return model


def at_rest(model: Any) -> Any:
    """An instrument at rest, its fingers at their rest height.

    Returns: ndarray [shape=(1,), dtype=layout.STATE].
    """
    state = np.zeros(1, STATE)
    state["U"][:] = model["rest_height"][0]
    return state


@compiled
def retune(model: Array, state: Array, i: int, T: float, sigma_0: float, sigma_1: float) -> None:
    """Give a sounding string another tension (N) and other losses; nothing else changes.

    The grid was made for the tension of `prepare` and its headroom: up to there it is stable,
    with as much of sigma_1 as it then bears.
    Real time: safe.
    """
    m, s = model[0], state[0]
    weigh_string(m, i, T, sigma_0, min(sigma_1, most_loss(m, i, T)))
    weigh_bridge(m)
    s.placed = 0  # contacts keep how much a string gives way


@compiled
def come_to_rest(model: Any, s: Any) -> None:
    """Put a state back to rest in place, keeping its counters. Real time: safe."""
    s.level = 0
    s.u[:], s.q[:], s.zeta[:], s.z[:] = 0.0, 0.0, 0.0, 0.0
    s.U[:], s.Psi[:] = model.rest_height, 0.0
    s.v_r, s.f_b, s.stored = 0.0, 0.0, 0.0
    s.s_1[:], s.s_2[:], s.history[:] = 0.0, 0.0, 0.0
    s.slack[:], s.give[:], s.bend[:], s.T_more[:] = 0.0, 0.0, 0.0, 0.0
    s.placed = 0
    s.x[:] = 0.0


@compiled
def advance(model: Array, state: Array, controls: Array, probes: Array, ledger: Array) -> None:
    """Run the model over one row of controls a sample.

    Parameters
    ----------
    model, state : ndarray [shape=(1,)]
        From `prepare` and `at_rest`; `state` is changed.
    controls : ndarray [shape=(frames, control_columns)]
        F_N (N, signed), v_b (m/s), x_b (m), hammer force (N), plucking force (N, its sign
        chooses the string as F_N does) and place (m), then x_f (m) and press (N, positive)
        of each finger. Finite: a caller checks what comes from outside.
    probes : ndarray [shape=(frames, probe_columns)]
        Written: columns as named in ``layout``.
    ledger : ndarray [shape=(frames, len(LEDGER))] or [shape=(0, 0)]
        Written where it has rows.

    A state that is lost (not finite) comes back at rest at the next sample, and is
    counted in ``state.lost``; the sample that lost it reads -1 iterations, and zeros.

    Real time: safe; no allocation, no exception.
    Source: [Yehu] section 3.7.
    """
    m, s = model[0], state[0]
    for n in range(controls.shape[0]):
        step(m, s, controls[n])
        if n < ledger.shape[0]:
            book(m, s, controls[n], ledger[n])
        measure(m, s, probes[n])


@compiled
def step(m: Any, s: Any, control: Array) -> None:
    """Advance strings, bridge, bow and fingers by one sample. See `advance`."""
    now = s.level
    next_, prev = (now + 1) % LEVELS, (now + 2) % LEVELS
    u_next, u, u_prev = s.u[next_], s.u[now], s.u[prev]
    k, v_b = m.k, control[V_B]
    s.dropped_z, s.dropped_Psi = 0.0, 0.0

    string, bowed = choose_string(m, s, control[F_N])
    place_contacts(m, s, control, string)

    # Strings and modes free of contacts, eq. (58), then tied together, eqs. (43)-(45).
    advance_strings(m, u_next, u, u_prev)
    pull_aside(m, s, control, u_next)
    tighten(m, s, u_next, u, u_prev)
    Q = advance_bridge(m, s.q[next_], s.q[now], s.q[prev], control[F_HAMMER])
    close_bridge(m, s, u_next, Q)

    # The bow, eqs. (46)-(53).
    feel(s, BOW)
    advance_hair(m, s.zeta[next_], s.zeta[now], s.zeta[prev])
    free = hair_velocity(m, s, u_next, u_prev, s.zeta[next_], s.zeta[prev]) - v_b
    compliance = (answer(m, s, BOW, BOW) + m.C_h) / (2.0 * k)
    f_b, z_bar, v_r, iterations, converged = 0.0, 0.0, free, 0, True
    # Where contacts feel each other anyhow friction is solved once, with them: until then it
    # is what it was.
    waits = bowed and tension_varies(s)
    if waits:
        f_b = s.f_b
    elif bowed:
        f_b, z_bar, v_r, iterations, converged = solve_friction(
            free, compliance, s.z[string], abs(control[F_N]), s.f_b, m, string
        )
    if bowed:
        push(m, s, u_next, BOW, f_b)

    # The fingers, eqs. (33)-(40).
    for j in range(m.fingers):
        s.U[next_, j] = advance_finger(m, s, j, control, now, prev)
    touching = meet_fingers(m, s, u_next, u, u_prev, next_, now, prev)
    if waits and (touching == 0 or friction_decides(m, s, abs(control[F_N]) + abs(f_b))):
        f_b, z_bar, v_r, iterations, converged = solve_friction(
            free, compliance, s.z[string], abs(control[F_N]), s.f_b, m, string
        )
        push(m, s, u_next, BOW, f_b - s.f_b)
        waits = False
        if touching > 0:
            touching = meet_fingers(m, s, u_next, u, u_prev, next_, now, prev)
    if touching > 0:
        if touch_apart(m, s, bowed):
            solve_apart(m, s)
        else:
            taken, taken_per_newton = solve_jointly(m, s)
            more = 0.0
            if waits or (bowed and (taken != 0.0 or taken_per_newton != 0.0)):
                first = f_b
                free -= (taken - taken_per_newton * first) / (2.0 * k)
                compliance += taken_per_newton / (2.0 * k)
                f_b, z_bar, v_r, again, converged = solve_friction(
                    free, compliance, s.z[string], abs(control[F_N]), first, m, string
                )
                iterations += again
                more = f_b - first
                push(m, s, u_next, BOW, more)
            take_forces(m, s, more)
        push_fingers(m, s, u_next, next_)
    take_up_slack(m, s, u_next)
    store_contacts(m, s, u_next, next_)

    # What the forces leave behind: eqs. (59), (60), and z at n + 1/2.
    finish_bridge(m, s.q[next_], s.f_c)
    s.zeta[next_, string] -= m.C_h * f_b
    s.z_bar, s.r = 0.0, 0.0
    if bowed:
        s.z_bar, s.r = z_bar, 2.0 * (z_bar - s.z[string]) / k
        s.z[string] = 2.0 * z_bar - s.z[string]
        s.unconverged += 0 if converged else 1
    else:
        v_r = hair_velocity(m, s, u_next, u_prev, s.zeta[next_], s.zeta[prev]) - v_b
    s.f_b, s.v_r, s.iterations = f_b, v_r, iterations
    for i in range(STRINGS):
        support(u_next[i], m.N[i])
    s.level = next_


@compiled
def measure(m: Any, s: Any, probe: Array) -> None:
    """Radiate, write the probes of one sample, and catch a lost state."""
    next_, now, prev = s.level, (s.level + 2) % LEVELS, (s.level + 1) % LEVELS
    bridge_force = s.f_c[0] + s.f_c[1]
    bridge_travel = 0.0
    for mode in range(MAX_MODES):
        bridge_travel += s.q[next_, mode] - s.q[prev, mode]
    probe[BRIDGE_FORCE] = bridge_force
    probe[BRIDGE_FORCE_1], probe[BRIDGE_FORCE_2] = s.f_c[0], s.f_c[1]
    probe[BRIDGE_VELOCITY] = bridge_travel / (2.0 * m.k)
    probe[PRESSURE] = radiate(m, s, bridge_force)
    probe[FRICTION_FORCE] = s.f_b
    probe[RELATIVE_VELOCITY] = s.v_r
    probe[ITERATIONS] = s.iterations
    for j in range(m.fingers):
        at = FINGER_PROBES + PROBES_PER_FINGER * j
        probe[at] = s.U[now, j]
        for i in range(STRINGS):
            probe[at + 1 + i] = s.f_f[STRINGS * j + i]

    size = abs(bridge_travel)  # of whatever one bad number would reach first
    for column in range(probe.shape[0]):
        size += abs(probe[column])
    for i in range(STRINGS):
        size += abs(s.z[i]) + abs(s.zeta[next_, i])
    for p in range(STRINGS * m.fingers):
        size += abs(s.Psi[p])
    if not size < LOST_SIZE:  # also true of NaN
        come_to_rest(m, s)
        s.lost += 1
        probe[:] = 0.0
        probe[ITERATIONS] = -1.0
