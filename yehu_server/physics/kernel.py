"""The model's time loop: one step of the scheme after another.

[Yehu] section 3.7, in the order that lets contacts share nodes: strings and modes move
freely, tension and bridge close over them, the fingers press, the bow draws, all that moved is
moved. The strings come first, since nothing they need waits for the contacts; what fingers resist
is worked out while they move.
"""

from __future__ import annotations

from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.jit import compiled
from yehu_server.physics.bow import (
    advance_hair,
    choose_string,
    hair_velocity,
    most_friction,
    prepare_bow,
)
from yehu_server.physics.bridge import (
    advance_bridge,
    close_bridge,
    finish_bridge,
    prepare_bridge,
    weigh_bridge,
)
from yehu_server.physics.closing import (
    close_fingers,
    feel_fingers,
    note_neighbours,
    push_fingers,
    weigh_fingers,
)
from yehu_server.physics.contacts import answer, feel, move, place_contacts, reply
from yehu_server.physics.energy import book
from yehu_server.physics.finger import (
    limit_fingers,
    meet_fingers,
    prepare_fingers,
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
    MODEL,
    PRESSURE,
    PROBES_PER_FINGER,
    RELATIVE_VELOCITY,
    STATE,
    STRINGS,
    V_B,
    new_record,
)
from yehu_server.physics.pluck import pull_aside
from yehu_server.physics.quantities import Quantities
from yehu_server.physics.radiation import prepare_radiation, radiate
from yehu_server.physics.stencil import read
from yehu_server.physics.string import (
    advance_strings,
    most_loss,
    prepare_strings,
    support,
    weigh_string,
)
from yehu_server.physics.tension import prepare_tension, weigh_tension

Array = Any

LOST_SIZE = 1e6  # N, m/s, m: nothing of a sound state comes near


def prepare(quantities: Quantities, rate: float, fingers: int = 1) -> Any:
    """Derive every coefficient of the model for one sample rate.

    Returns: ndarray [shape=(1,), dtype=layout.MODEL].
    Errors: ParameterError where the quantities make no stable model at this rate.
    """
    if not 1 <= fingers <= MAX_FINGERS:
        raise ParameterError(f"fingers: 1 to {MAX_FINGERS}, not {fingers}")
    model = new_record(MODEL)
    record = model[0]
    record["k"], record["rate"] = 1.0 / rate, rate
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
    state = new_record(STATE)
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
    weigh_tension(m, i)
    weigh_bridge(m)
    s.placed = 0  # contacts keep how much a string gives way


@compiled
def come_to_rest(model: Any, s: Any) -> None:
    """Put a state back to rest in place, keeping its counters. Real time: safe."""
    s.u[:], s.q[:], s.zeta[:], s.z[:] = 0.0, 0.0, 0.0, 0.0
    s.U[:], s.Psi[:] = model.rest_height, 0.0
    s.v_r, s.f_b, s.stored = 0.0, 0.0, 0.0
    s.s_1[:], s.s_2[:], s.history[:] = 0.0, 0.0, 0.0
    s.slack[:], s.give[:], s.bend[:], s.tangent[:] = 0.0, 0.0, 0.0, 0.0
    s.bend_at[:], s.eta_prev[:] = 0.0, 0.0
    s.placed = 0
    s.x[:], s.still[:] = 0.0, 0


@compiled
def advance(
    model: Array, state: Array, controls: Array, probes: Array, ledger: Array | None
) -> None:
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
    ledger : ndarray [shape=(frames, len(LEDGER))] or None
        Written where it has rows. Without it, what keeps it is not compiled.

    A state that is lost (not finite) comes back at rest at the next sample, and is
    counted in ``state.lost``; the sample that lost it reads -1 iterations, and zeros.

    Real time: safe; no allocation, no exception.
    Source: [Yehu] section 3.7.
    """
    m, s = model[0], state[0]
    now, next_, prev = int(s.level), (s.level + 1) % LEVELS, (s.level + 2) % LEVELS
    for n in range(controls.shape[0]):
        step(m, s, controls[n], next_, now, prev)
        s.level = next_
        if ledger is not None and n < ledger.shape[0]:
            book(m, s, controls[n], ledger[n])
        measure(m, s, probes[n])
        next_, now, prev = prev, next_, now


@compiled
def step(m: Any, s: Any, control: Array, next_: int, now: int, prev: int) -> None:
    """Advance strings, bridge, bow and fingers by one sample. See `advance`."""
    u_next, u, u_prev = s.u[next_], s.u[now], s.u[prev]
    half_rate = 0.5 * m.rate  # of delta_t.
    s.dropped_z, s.dropped_Psi = 0.0, 0.0

    # Strings and modes free of contacts, eq. (58), then tied together, eqs. (43)-(45).
    advance_strings(m, s, u_next, u, u_prev)
    pull_aside(m, s, control, u_next)
    q_sum = advance_bridge(m, s.q[next_], s.q[now], s.q[prev], control[F_HAMMER])
    close_bridge(m, s, u_next, q_sum)

    string, bowed = choose_string(m, s, control[F_N])
    moved, were_near = place_contacts(m, s, control, string), s.are_near
    near = meet_fingers(m, s, control, next_, now, prev)
    if moved or s.are_near != were_near:
        note_neighbours(m, s, near)
    Q = weigh_fingers(m, s, near)

    # The bow, eqs. (46)-(53), and the fingers, eqs. (33)-(40), from where they would be.
    s.bend_at[BOW] = read(s.bend[string], s.first[BOW], s.weights[BOW])
    of_bow = reply(s, BOW)
    advance_hair(m, s.zeta[next_], s.zeta[now], s.zeta[prev])
    at_bow = feel(s, u_next, BOW)
    free = hair_velocity(m, s, at_bow, u_prev, s.zeta[next_], s.zeta[prev]) - control[V_B]
    compliance = half_rate * (answer(m, s, BOW, BOW, of_bow) + m.C_h)
    F_N_abs = abs(control[F_N])
    f_b, z_bar, v_r, iterations, converged = 0.0, 0.0, free, 0, True
    tangent = s.tangent[0], s.tangent[1], s.tangent[2]
    for i in range(STRINGS):
        s.slack_per_newton[i], s.f_c_per_newton[i] = of_bow[i], of_bow[STRINGS + i]
    if near > 0:
        # theta depends on the friction force, and that on the contacts. Mostly theta is 1 for
        # any friction; else it is found with that of a string which no finger touches.
        f_b, doubt = (s.f_b, abs(s.f_b) + most_friction(m, control[F_N])) if bowed else (0.0, 0.0)
        if feel_fingers(m, s, u_next, next_, near, of_bow, f_b, doubt):
            if bowed:
                f_b, _, _, tangent, iterations, _ = solve_friction(
                    free, compliance, s.z[string], F_N_abs, tangent, m, string
                )
            limit_fingers(s, near, f_b)
            Q = weigh_fingers(m, s, near)
        taken, taken_per_newton = close_fingers(m, s, near, Q, of_bow)
        free -= half_rate * taken
        compliance -= half_rate * taken_per_newton
        f_b, v_r = 0.0, free
    if bowed:
        f_b, z_bar, v_r, tangent, again, converged = solve_friction(
            free, compliance, s.z[string], F_N_abs, tangent, m, string
        )
        iterations += again
    for i in range(STRINGS):
        s.slack[i] += s.slack_per_newton[i] * f_b
        s.f_c[i] += s.f_c_per_newton[i] * f_b
    push_fingers(m, s, next_, near, f_b)

    # What the forces leave behind: eqs. (30), (59), (60), and z at n + 1/2.
    s.zeta[next_, string] -= m.C_h * f_b
    s.z_bar, s.r = 0.0, 0.0
    if bowed:
        s.z_bar, s.r = z_bar, m.rate * 2.0 * (z_bar - s.z[string])
        s.z[string] = 2.0 * z_bar - s.z[string]
        s.unconverged += 0 if converged else 1
    s.f_b, s.v_r, s.iterations = f_b, v_r, iterations
    s.tangent[0], s.tangent[1], s.tangent[2] = tangent
    move(m, s, u_next, near, bowed)
    s.bridge_travel = finish_bridge(m, s.q[next_], s.q[prev], s.f_c)
    for i in range(STRINGS):
        support(u_next[i], m.N[i])


@compiled
def measure(m: Any, s: Any, probe: Array) -> None:
    """Write the probes of one sample, and catch a lost state."""
    next_, now = s.level, (s.level + 2) % LEVELS
    bridge_force = s.f_c[0] + s.f_c[1]
    probe[BRIDGE_FORCE] = bridge_force
    probe[BRIDGE_FORCE_1], probe[BRIDGE_FORCE_2] = s.f_c[0], s.f_c[1]
    probe[BRIDGE_VELOCITY] = 0.5 * m.rate * s.bridge_travel
    probe[PRESSURE] = radiate(m, s, bridge_force)
    probe[FRICTION_FORCE] = s.f_b
    probe[RELATIVE_VELOCITY] = s.v_r
    probe[ITERATIONS] = s.iterations
    size = abs(s.bridge_travel)  # of whatever one bad number would reach first
    for column in range(FINGER_PROBES):
        size += abs(probe[column])
    for i in range(STRINGS):
        size += abs(s.z[i]) + abs(s.zeta[next_, i])
    for j in range(m.fingers):
        at = FINGER_PROBES + PROBES_PER_FINGER * j
        probe[at] = s.U[now, j]
        size += abs(s.U[now, j])
        for i in range(STRINGS):
            p = STRINGS * j + i
            probe[at + 1 + i] = s.f_f[p]
            size += abs(s.f_f[p]) + abs(s.Psi[p])
    if not size < LOST_SIZE:  # also true of NaN
        come_to_rest(m, s)
        s.lost += 1
        probe[:] = 0.0
        probe[ITERATIONS] = -1.0
