"""The energy ledger: what is stored, what comes in, what is lost, and what is missing.

[Yehu] eqs. (54)-(56), corrected as docs/physics.md says. The balance proves that forces
and displacements belong together; it is blind to the friction law and to convergence, which the
residual of friction shows, and to g and theta, which other tests hold.
"""

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.bow import contact_velocity
from yehu_server.core.physics.friction import power_off_law
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import (
    BOW,
    CONSTRAINT_RESIDUAL,
    ENERGY,
    ENERGY_ERROR,
    F_HAMMER,
    F_N,
    FRICTION_RESIDUAL,
    GHOST,
    LEVELS,
    LOSS_BOW_LIFT,
    LOSS_BRIDGE,
    LOSS_CONTACT_RESET,
    LOSS_FINGER,
    LOSS_FRICTION,
    LOSS_HAIR,
    LOSS_STRINGS,
    POWER_IN,
    STRINGS,
    V_B,
    V_R_RESIDUAL,
    padded_length,
)
from yehu_server.core.physics.pluck import pluck_power
from yehu_server.core.physics.records import Array, Contacts, Model, Motion, Work


@compiled_exactly
def string_energy(model: Model, i: int, u_next: Array, u: Array) -> float:
    """h_s of eq. (55a) for string `i` (J): kinetic, tension and its modulation, stiffness."""
    k, h, N = model.k, model.h[i], model.N[i]
    kinetic, slope, bend, loss = 0.0, 0.0, 0.0, 0.0
    for l in range(1, N + 1):
        at = GHOST + l
        v = (u_next[at] - u[at]) / k
        v_left = (u_next[at - 1] - u[at - 1]) / k
        kinetic += v * v
        slope += (u_next[at] - u_next[at - 1]) * (u[at] - u[at - 1])
        loss += (v - v_left) ** 2
        if l < N:
            bend += (u_next[at - 1] - 2.0 * u_next[at] + u_next[at + 1]) * (
                u[at - 1] - 2.0 * u[at] + u[at + 1]
            )
    return float(
        0.5 * model.rho_A[i] * h * kinetic
        + 0.5 * model.T[i] * slope / h
        + 0.5 * model.stretch_stiffness[i] * slope**2 / h
        + 0.5 * model.EI[i] * bend / h**3
        - 0.5 * model.sigma_1[i] * k * model.rho_A[i] * loss / h
    )


@compiled_exactly
def string_loss(model: Model, i: int, u_next: Array, u_prev: Array) -> float:
    """q_s of eq. (56b) for string `i` (W), with what felt takes."""
    h, N = model.h[i], model.N[i]
    straight, sloped, felt = 0.0, 0.0, 0.0
    for l in range(1, N + 1):
        at = GHOST + l
        v = (u_next[at] - u_prev[at]) / (2.0 * model.k)
        v_left = (u_next[at - 1] - u_prev[at - 1]) / (2.0 * model.k)
        straight += v * v
        if l < N:
            felt += v * v * model.held[i, at] / model.inside[i, at]
        sloped += (v - v_left) ** 2
    return float(
        2.0
        * model.rho_A[i]
        * (
            model.sigma_0[i] * h * straight
            + (model.rate + model.sigma_0[i]) * h * felt
            + model.sigma_1[i] * sloped / h
        )
    )


@compiled_exactly
def strings_loss(model: Model, s: Motion, next_: int, prev: int) -> float:
    """q_s of both strings (W)."""
    total = 0.0
    for i in range(STRINGS):
        total += string_loss(model, i, s.u[next_, i], s.u[prev, i])
    return total


@compiled_exactly
def stored_energy(
    model: Model, s: Motion, in_strings: tuple[float, float], next_: int, now: int
) -> float:
    """Total of eqs. (55a)-(55e) at n + 1/2, of which each string has some (J)."""
    k = model.k
    total = 0.0
    for i in range(STRINGS):
        total += in_strings[i]
        zeta_velocity = (s.zeta[next_, i] - s.zeta[now, i]) / k
        zeta_mean = 0.5 * (s.zeta[next_, i] + s.zeta[now, i])
        total += 0.5 * model.M_h * zeta_velocity**2 + 0.5 * model.K_h * zeta_mean**2
        total += 0.5 * model.epsilon_0 * s.z[i] ** 2
    for m in range(padded_length(model.modes)):
        velocity = (s.q[next_, m] - s.q[now, m]) / k
        mean = 0.5 * (s.q[next_, m] + s.q[now, m])
        total += 0.5 * model.M_m[m] * velocity**2 + 0.5 * model.K_m[m] * mean**2
    for j in range(model.fingers):
        velocity = (s.U[next_, j] - s.U[now, j]) / k
        total += 0.5 * model.M_f * velocity**2
        for i in range(STRINGS):
            total += 0.5 * s.Psi[STRINGS * j + i] ** 2
    return float(total)


@compiled_exactly
def record_energy(
    model: Model, s: Motion, c: Contacts, w: Work, control: Array, before: float,
    in_strings: tuple[float, float], strings: float, row: Array,
) -> float:  # fmt: skip
    """Write one row of the ledger (columns: ``layout.LEDGER``) after a step is complete.

    `before` is what was stored half a step before it (J); returns what is stored half a step after.
    Each string has `in_strings` (J) of that, and both lose `strings` (W).
    """
    k = model.k
    next_, now, prev = s.level, (s.level + 2) % LEVELS, (s.level + 1) % LEVELS
    # Read back from the grid, not taken from the solver.
    u_b = interpolate(s.u[next_, c.string[BOW]], c.first[BOW], c.weights[BOW])
    v_r = contact_velocity(model, c, u_b, s.u[prev], s.zeta[next_], s.zeta[prev]) - control[V_B]

    hair, bridge, finger = 0.0, 0.0, 0.0
    for i in range(STRINGS):
        hair += model.R_h * ((s.zeta[next_, i] - s.zeta[prev, i]) / (2.0 * k)) ** 2
    bridge_velocity, Q = 0.0, 0.0
    for m in range(padded_length(model.modes)):
        velocity = (s.q[next_, m] - s.q[prev, m]) / (2.0 * k)
        bridge += model.R_m[m] * velocity**2
        bridge_velocity += velocity
        Q += s.q[next_, m]
    power = control[F_HAMMER] * bridge_velocity - s.f_b * control[V_B]
    power += pluck_power(model, c, control, s.u[next_], s.u[prev])
    for j in range(model.fingers):
        power += w.f_ext[j] * (s.U[next_, j] - s.U[prev, j]) / (2.0 * k)
        for i in range(STRINGS):
            p = STRINGS * j + i
            if w.g[p] != 0.0:
                travel = interpolate(s.u[next_, i], c.first[p], c.weights[p]) - s.U[next_, j]
                travel -= w.eta_prev[p]
                # Psi stands at n + 1/2 by now; the law uses it at n - 1/2.
                Psi = s.Psi[p] - 0.5 * w.g[p] * travel
                finger += model.beta * w.g[p] * Psi * (travel / (2.0 * k)) ** 2
    friction = s.f_b * v_r - model.epsilon_0 * w.z_bar * w.r
    lifted, reset = w.dropped_z / k, w.dropped_Psi / k

    stored = stored_energy(model, s, in_strings, next_, now)
    losses = strings + bridge + finger + hair + friction + lifted + reset
    residual = 0.0
    for i in range(STRINGS):
        at_bridge = interpolate(s.u[next_, i], model.bridge_first[i], model.bridge_weights[i])
        residual = max(residual, abs(at_bridge - Q))
    row[ENERGY], row[POWER_IN] = stored, power
    row[LOSS_STRINGS], row[LOSS_BRIDGE], row[LOSS_FINGER] = strings, bridge, finger
    row[LOSS_HAIR], row[LOSS_FRICTION] = hair, friction
    row[LOSS_BOW_LIFT], row[LOSS_CONTACT_RESET] = lifted, reset
    row[ENERGY_ERROR] = (stored - before) / k - power + losses
    row[V_R_RESIDUAL], row[FRICTION_RESIDUAL] = 0.0, 0.0
    if abs(control[F_N]) >= model.lift_force:
        row[V_R_RESIDUAL] = abs(v_r - s.v_r)
        row[FRICTION_RESIDUAL] = power_off_law(
            model, c.string[BOW], w.F_N, w.mu_S, s.f_b, v_r, w.z_bar, w.r
        )
    row[CONSTRAINT_RESIDUAL] = residual
    return stored
