"""The model's time loop: one step of the scheme after another.

[Yehu] section 3.7, in an order that lets contacts share nodes. Strings and modes advance without
contact forces; tension and bridge are eliminated, then the fingers; friction is solved for the bow;
the fingers' forces follow, and all forces move what they act on. docs/derivation.md derives each
part.
"""

from typing import Annotated, Any

import numpy as np

from yehu_server.compile.jit import compiled, native
from yehu_server.core.physics import bow, bridge, contacts, elimination
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.finger import advance_fingers, limit_gradients, prepare_fingers
from yehu_server.core.physics.friction import Tangent, solve_friction
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import (
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
from yehu_server.core.physics.pluck import pluck
from yehu_server.core.physics.radiation import prepare_radiation, radiate
from yehu_server.core.physics.records import Array, Model, Records, State
from yehu_server.core.physics.rosin_heat import prepare_heat, static_coefficient, warm
from yehu_server.core.physics.rosin_texture import grip
from yehu_server.core.physics.string import (
    advance_strings,
    max_stable_sigma_1,
    prepare_strings,
    set_string_weights,
    support,
)
from yehu_server.core.physics.tension import prepare_tension, set_tension_gain
from yehu_server.errors import ParameterError

LOST_SIZE = 1e6  # N, m/s, m: far above any value of a sound state


def prepare(quantities: Quantities, rate: float, fingers: int = 1) -> Any:
    """Derive every coefficient for one sample rate: ndarray [shape=(1,), dtype=layout.MODEL].

    Raises ParameterError where the quantities make no stable model at this rate.
    """
    if not 1 <= fingers <= MAX_FINGERS:
        raise ParameterError(f"fingers: 1 to {MAX_FINGERS}, not {fingers}")
    model = new_record(MODEL)
    record = model[0]
    record["k"], record["rate"] = 1.0 / rate, rate
    record["fingers"] = fingers
    prepare_strings(record, quantities)
    prepare_tension(record, quantities)
    bridge.prepare_bridge(record, quantities)
    bow.prepare_bow(record, quantities)
    prepare_heat(record, quantities)
    prepare_fingers(record, quantities)
    prepare_radiation(record, quantities.body)
    derive.call(model.ctypes.data)
    return model


@native
def derive(m: Annotated[Model, MODEL]) -> None:
    """Write what follows from quantities and grids into a MODEL: also when a string is retuned."""
    bridge.place_bridge(m)
    for i in range(STRINGS):
        set_string_weights(m, i, m.T[i], m.sigma_0[i], m.sigma_1[i])
        set_tension_gain(m, i)
    bridge.set_bridge_compliance(m)


def at_rest(model: Any) -> Any:
    """An instrument at rest, its fingers up: ndarray [shape=(1,), dtype=layout.STATE]."""
    state = new_record(STATE)
    state["motion"]["U"][:] = model["rest_height"][0]
    return state


@compiled
def retune(
    model: Records, state: Records, i: int, T: float, sigma_0: float, sigma_1: float
) -> None:
    """Give a sounding string another tension (N) and other losses; nothing else changes.

    The grid was made for the tension of `prepare` and its headroom: up to there it is stable,
    with as much of sigma_1 as it then bears.
    Real time: safe.
    """
    m = model[0]
    set_string_weights(m, i, T, sigma_0, min(sigma_1, max_stable_sigma_1(m, i, T)))
    set_tension_gain(m, i)
    bridge.set_bridge_compliance(m)
    state[0].contacts.placed = 0  # their compliances depend on the tension


@compiled
def come_to_rest(model: Model, state: State) -> None:
    """Put a state back to rest in place, keeping its counters. Real time: safe."""
    s, c, w = state.motion, state.contacts, state.work
    s.u[:], s.q[:], s.zeta[:], s.z[:], s.w[:] = 0.0, 0.0, 0.0, 0.0, 0.0
    s.grain, s.rough[:] = 0, 0.0
    s.U[:], s.Psi[:] = model.rest_height, 0.0
    s.v_r, s.f_b = 0.0, 0.0
    s.s_1[:], s.s_2[:], s.history[:] = 0.0, 0.0, 0.0
    s.Delta_u[:], s.tangent[:], s.resting[:] = 0.0, 0.0, 0
    c.placed, c.x[:] = 0, 0.0
    # Read where a contact has no stiffness: zero times a number that is not finite is none.
    w.tau[:], w.K_tt[:], w.Delta_u_at[:], w.eta_prev[:] = 0.0, 0.0, 0.0, 0.0


@compiled
def advance(model: Records, state: Records, controls: Array, probes: Array) -> None:
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

    A state that is lost (not finite) comes back at rest at the next sample, and is
    counted in ``state.lost``; the sample that lost it reads -1 iterations, and zeros.

    Real time: safe; no allocation, no exception.
    Source: [Yehu] section 3.7.
    """
    m, s = model[0], state[0]
    now = int(np.int64(s.motion.level))  # else `step` would be compiled for 8 bits, too
    next_, prev = (now + 1) % LEVELS, (now + 2) % LEVELS
    for n in range(controls.shape[0]):
        step(m, s, controls[n], next_, now, prev)
        s.motion.level = next_
        measure(m, s, probes[n])
        next_, now, prev = prev, next_, now


@compiled
def step(m: Model, state: State, control: Array, next_: int, now: int, prev: int) -> None:
    """Advance strings, bridge, bow and fingers by one sample. See `advance`."""
    s, c, w = state.motion, state.contacts, state.work
    u_next, u, u_prev = s.u[next_], s.u[now], s.u[prev]
    w.dropped_z, w.dropped_Psi = 0.0, 0.0

    # Strings and modes without forces, eqs. (58) and (42), then tied together, eqs. (43)-(45).
    advance_strings(m, s, w, u_next, u, u_prev)
    pluck(m, s, c, w, control, u_next)
    q_sum = bridge.advance_bridge(m, s.q[next_], s.q[now], s.q[prev], control[F_HAMMER])
    bridge.eliminate_tension_and_bridge(m, s, w, u_next, q_sum)

    # Places of the contacts; fingers without forces, eq. (58). Independent of the strings' update.
    string, bowed = bow.choose_string(m, s, c, w, control[F_N])
    moved, were_near = contacts.place_contacts(m, c, control, string), c.candidate_bits
    near = advance_fingers(m, s, c, w, control, next_, now, prev)
    if moved or c.candidate_bits != were_near:
        elimination.find_shared_nodes(m, c, near)
    Q = elimination.factor_fingers(m, s, c, w, near)

    # The bow, eqs. (46)-(49), and the fingers, eqs. (33)-(36).
    w.Delta_u_at[BOW] = interpolate(s.Delta_u[string], c.first[BOW], c.weights[BOW])
    bow_response = contacts.response(c, w, BOW)
    bow.advance_hair(m, s.zeta[next_], s.zeta[now], s.zeta[prev])
    u_b = contacts.free_displacement(c, w, u_next, BOW)
    free = bow.contact_velocity(m, c, u_b, u_prev, s.zeta[next_], s.zeta[prev]) - control[V_B]
    mobility = 0.5 * m.rate * (contacts.compliance(m, c, w, BOW, BOW, bow_response) + m.C_h)
    for i in range(STRINGS):
        w.tau_per_newton[i], w.f_c_per_newton[i] = bow_response[i], bow_response[STRINGS + i]
    F_N_now = abs(control[F_N]) * grip(m, s, c, control, now)
    solve_contacts(m, state, u_next, next_, near, Q, bow_response, bowed, F_N_now, free, mobility)
    warm(m, s, w, string, bowed, F_N_now)

    # All that the forces move: eqs. (30), (59), (60).
    s.zeta[next_, string] -= m.C_h * s.f_b
    contacts.move_strings(m, s, c, w, u_next, near, bowed)
    w.bridge_travel = bridge.move_modes(m, s.q[next_], s.q[prev], w.f_c)
    for i in range(STRINGS):
        support(u_next[i], m.N[i])


@compiled
def solve_contacts(
    m: Model,
    state: State,
    u_next: Array,
    next_: int,
    near: int,
    Q: elimination.Symmetric,
    bow_response: contacts.Response,
    bowed: bool,
    F_N: float,
    free: float,
    mobility: float,
) -> None:
    """Solve the forces of fingers and bow; advance the fingers and the bristles.

    Parameters
    ----------
    near : int
        Number of fingers that may touch a string.
    Q, bow_response
        Of `factor_fingers`, and of `response` to the bow.
    F_N : float, N
        Bow force, with the hair's texture.
    free : float, m/s
        Velocity of string on hair without friction and without fingers.
    mobility : float, m/s/N
        How much a newton of friction slows it, without fingers.
    """
    s, c, w = state.motion, state.contacts, state.work
    string = c.string[BOW]
    mu_S = static_coefficient(m, s.w[string])
    tangent: Tangent = (s.tangent[0], s.tangent[1], s.tangent[2])
    f_b, z_bar, v_r, iterations, converged = 0.0, 0.0, free, 0, True
    if near > 0:
        # theta depends on the friction force, and that on the contacts. Mostly theta is 1 for
        # any friction; else it is found with the friction on a string that no finger touches.
        f_b, margin = (s.f_b, abs(s.f_b) + bow.friction_limit(m, F_N)) if bowed else (0.0, 0.0)
        if elimination.find_travel(m, s, c, w, u_next, next_, near, bow_response, f_b, margin):
            if bowed:
                f_b, _, _, tangent, iterations, _ = solve_friction(
                    free, mobility, s.z[string], F_N, mu_S, tangent, m, string
                )
            limit_gradients(s, c, w, near, f_b)
            Q = elimination.factor_fingers(m, s, c, w, near)
        displacement, compliance_reduction = elimination.eliminate_fingers(
            m, s, c, w, near, Q, bow_response
        )
        free -= 0.5 * m.rate * displacement
        mobility -= 0.5 * m.rate * compliance_reduction
        f_b, v_r = 0.0, free
    if bowed:
        f_b, z_bar, v_r, tangent, again, converged = solve_friction(
            free, mobility, s.z[string], F_N, mu_S, tangent, m, string
        )
        iterations += again
    for i in range(STRINGS):
        w.tau[i] += w.tau_per_newton[i] * f_b
        w.f_c[i] += w.f_c_per_newton[i] * f_b
    elimination.back_substitute_fingers(m, s, c, w, next_, near, f_b)

    w.z_bar, w.r, w.F_N, w.mu_S = 0.0, 0.0, F_N, mu_S
    if bowed:  # z is then at n + 1/2
        w.z_bar, w.r = z_bar, m.rate * 2.0 * (z_bar - s.z[string])
        s.z[string] = 2.0 * z_bar - s.z[string]
        state.unconverged += 0 if converged else 1
    s.f_b, s.v_r, w.iterations = f_b, v_r, iterations
    s.tangent[0], s.tangent[1], s.tangent[2] = tangent


@compiled
def measure(m: Model, state: State, probe: Array) -> None:
    """Write the probes of one sample, and catch a lost state."""
    s, w = state.motion, state.work
    next_, now = s.level, (s.level + 2) % LEVELS
    bridge_force = w.f_c[0] + w.f_c[1]
    probe[BRIDGE_FORCE] = bridge_force
    probe[BRIDGE_FORCE_1], probe[BRIDGE_FORCE_2] = w.f_c[0], w.f_c[1]
    probe[BRIDGE_VELOCITY] = 0.5 * m.rate * w.bridge_travel
    probe[PRESSURE] = radiate(m, s, bridge_force)
    probe[FRICTION_FORCE] = s.f_b
    probe[RELATIVE_VELOCITY] = s.v_r
    probe[ITERATIONS] = w.iterations
    size = abs(w.bridge_travel)  # of all that one number which is not finite reaches first
    for column in range(FINGER_PROBES):
        size += abs(probe[column])
    for i in range(STRINGS):
        size += abs(s.z[i]) + abs(s.zeta[next_, i])
    for j in range(m.fingers):
        at = FINGER_PROBES + PROBES_PER_FINGER * j
        probe[at] = s.U[now, j]
        size += abs(s.U[now, j])
        for i in range(STRINGS):
            probe[at + 1 + i] = w.f_f[STRINGS * j + i]
            size += abs(w.f_f[STRINGS * j + i])
    if not size < LOST_SIZE:  # also true of NaN
        come_to_rest(m, state)
        state.lost += 1
        probe[:] = 0.0
        probe[ITERATIONS] = -1.0
