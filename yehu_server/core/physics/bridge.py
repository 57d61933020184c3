"""The bridge: a bank of measured modes to which both strings are tied.

[Yehu] eqs. (10)-(12) and (41)-(45), (59). Differs: interpolation at the bridge is
cubic; C_q carries 4 k^2; the modes' stiffness is pre-warped so that each rings at its measured
frequency (decisions/0002).
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.elementary import elementwise, tan
from yehu_server.core.physics.grid import cubic_weights, interpolate
from yehu_server.core.physics.layout import MAX_MODES, STRINGS, padded_length
from yehu_server.core.physics.records import Array, Model, Motion, Work
from yehu_server.core.physics.tension import eliminate_tension
from yehu_server.errors import ParameterError


def prepare_bridge(model: Any, quantities: Quantities) -> None:
    """Write the bridge's coefficients, after the strings'; ParameterError for too many modes."""
    k = model["k"]
    body = quantities.body
    modes = len(body.mass)
    omega = np.array(body.omega)
    if modes > MAX_MODES:
        raise ParameterError(f"a body has at most {MAX_MODES} bridge modes, not {modes}")
    if omega.max() * k >= 0.9 * np.pi:
        raise ParameterError(
            f"the bridge mode at {max(body.frequency_hz):.0f} Hz is too high for this sample rate"
        )
    M_m, R_m = np.array(body.mass), np.array(body.damping)
    # mu_tt lowers frequencies: sin^2(wk/2) M 4/k^2 = K cos^2(wk/2) at resonance.
    K_m = M_m * (2.0 / k * elementwise(tan, omega * k / 2.0)) ** 2
    Lambda = 4.0 * M_m + k * k * K_m + 2.0 * k * R_m
    model["modes"] = modes
    model["M_m"][:modes], model["K_m"][:modes], model["R_m"][:modes] = M_m, K_m, R_m
    model["A_q"][:modes] = (8.0 * M_m - 2.0 * k * k * K_m) / Lambda
    model["B_q"][:modes] = (-4.0 * M_m - k * k * K_m + 2.0 * k * R_m) / Lambda
    model["C_q"][:modes] = 4.0 * k * k / Lambda
    C_q_sum = model["C_q"].sum()
    model["C_q_sum"] = C_q_sum
    model["bridge_x"] = quantities.bridge_x
    for i in range(STRINGS):
        position = quantities.bridge_x / model["h"][i]
        if not 2.0 <= position <= model["N"][i] - 1.0:
            raise ParameterError(
                f"bridge_x {quantities.bridge_x} m is too near a string's end for this grid"
            )


@compiled
def place_bridge(model: Model) -> None:
    """Write which nodes of the strings the bridge touches."""
    for i in range(STRINGS):
        position = model.bridge_x / model.h[i]
        model.bridge_first[i] = cubic_weights(position, model.N[i], model.bridge_weights[i])


@compiled
def set_bridge_compliance(model: Model) -> None:
    """Write S_c of eq. (45), the compliance between modes and strings (m/N). Real time: safe."""
    model.S_c[:] = model.C_q_sum
    for i in range(STRINGS):
        weights = model.bridge_weights[i]
        for l in range(weights.shape[0]):
            model.S_c[i, i] += model.spread[i] * weights[l] * weights[l]


@compiled
def advance_bridge(model: Model, q_next: Array, q: Array, q_prev: Array, f_hammer: float) -> float:
    """Advance the modes, free of string forces; return their sum (m). Eq. (42)."""
    total = 0.0
    for m in range(padded_length(model.modes)):
        q_next[m] = model.A_q[m] * q[m] + model.B_q[m] * q_prev[m] + model.C_q[m] * f_hammer
        total += q_next[m]
    return total


@compiled
def eliminate_tension_and_bridge(
    model: Model, s: Motion, w: Work, u_next: Array, q_sum: float
) -> None:
    """Eliminate tau and f_c of both strings: solve them as if no contact touched the strings.

    Writes ``w.tau`` and ``w.f_c`` (N) so solved, and the inverse of their joint system, by which
    they respond to contacts (see `contacts.response`): K_tt to the sum of forces times Delta u^n
    under them, K_cc to a gap at the bridge, K_tc from one to the other.
    Source: [Yehu] eqs. (43)-(45); tension.py.
    """
    first, weights = model.bridge_first, model.bridge_weights
    tau_1, tau_per_sum_1, pivot_1 = eliminate_tension(model, w, 0)
    tau_2, tau_per_sum_2, pivot_2 = eliminate_tension(model, w, 1)
    Delta_1 = interpolate(s.Delta_u[0], first[0], weights[0])
    Delta_2 = interpolate(s.Delta_u[1], first[1], weights[1])
    gap_1 = q_sum - interpolate(u_next[0], first[0], weights[0]) - tau_1 * Delta_1
    gap_2 = q_sum - interpolate(u_next[1], first[1], weights[1]) - tau_2 * Delta_2

    # S_c, its diagonal lowered by tension, each row multiplied by its pivot (S_12 below by both),
    # so that the divisions are independent and can overlap.
    S_11 = model.S_c[0, 0] * pivot_1 - model.tension_gain[0] * model.spread[0] * Delta_1 * Delta_1
    S_22 = model.S_c[1, 1] * pivot_2 - model.tension_gain[1] * model.spread[1] * Delta_2 * Delta_2
    S_12 = model.S_c[0, 1]
    pivots = pivot_1 * pivot_2
    inverse_determinant = 1.0 / (S_11 * S_22 - S_12 * S_12 * pivots)
    K_11, K_22 = S_22 * pivot_1 * inverse_determinant, S_11 * pivot_2 * inverse_determinant
    K_12 = -S_12 * pivots * inverse_determinant
    w.K_cc[0, 0], w.K_cc[0, 1] = K_11, K_12
    w.K_cc[1, 0], w.K_cc[1, 1] = K_12, K_22
    f_1, f_2 = K_11 * gap_1 + K_12 * gap_2, K_12 * gap_1 + K_22 * gap_2
    w.f_c[0], w.f_c[1] = f_1, f_2

    lambda_1, lambda_2 = tau_per_sum_1 * Delta_1, tau_per_sum_2 * Delta_2  # -d tau / d f_c
    w.tau[0], w.tau[1] = tau_1 - lambda_1 * f_1, tau_2 - lambda_2 * f_2
    w.K_tc[0, 0], w.K_tc[0, 1] = -lambda_1 * K_11, -lambda_1 * K_12
    w.K_tc[1, 0], w.K_tc[1, 1] = -lambda_2 * K_12, -lambda_2 * K_22
    w.K_tt[0, 0] = tau_per_sum_1 + lambda_1 * lambda_1 * K_11
    w.K_tt[1, 1] = tau_per_sum_2 + lambda_2 * lambda_2 * K_22
    w.K_tt[0, 1] = w.K_tt[1, 0] = lambda_1 * K_12 * lambda_2


@compiled
def move_modes(model: Model, q_next: Array, q_prev: Array, f_c: Array) -> float:
    """Move the modes by the strings' forces, the last term of eq. (59).

    Returns how far the bridge moved in two samples (m).
    """
    total = f_c[0] + f_c[1]
    displacement_change = 0.0
    for m in range(padded_length(model.modes)):
        q_next[m] -= model.C_q[m] * total
        displacement_change += q_next[m] - q_prev[m]
    return displacement_change
