"""The bridge: a bank of measured modes to which both strings are tied.

[Yehu] eqs. (10)-(12) and (41)-(45), (59). Differs: C_q carries 4 k^2, and the modes'
stiffness is pre-warped so that each rings at its measured frequency (decisions/0002).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.errors import ParameterError
from yehu_server.jit import compiled
from yehu_server.physics.layout import MAX_MODES, STRINGS, whole_vectors
from yehu_server.physics.quantities import Quantities
from yehu_server.physics.stencil import place_cubic, read

Array = Any


def prepare_bridge(model: np.void, quantities: Quantities) -> None:
    """Write the bridge's coefficients into `model`; the strings' must be there.

    Errors: ParameterError where the body has too many modes, or one above Nyquist.
    """
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
    # mu_tt bends frequencies down: sin^2(wk/2) M 4/k^2 = K cos^2(wk/2) at resonance.
    K_m = M_m * (2.0 / k * np.tan(omega * k / 2.0)) ** 2
    Lambda = 4.0 * M_m + k**2 * K_m + 2.0 * k * R_m
    model["modes"] = modes
    model["M_m"][:modes], model["K_m"][:modes], model["R_m"][:modes] = M_m, K_m, R_m
    model["A_q"][:modes] = (8.0 * M_m - 2.0 * k**2 * K_m) / Lambda
    model["B_q"][:modes] = (-4.0 * M_m - k**2 * K_m + 2.0 * k * R_m) / Lambda
    model["C_q"][:modes] = 4.0 * k**2 / Lambda
    C_q_sum = model["C_q"].sum()
    model["C_q_sum"] = C_q_sum
    model["bridge_x"] = quantities.bridge_x
    for i in range(STRINGS):
        position = quantities.bridge_x / model["h"][i]
        if not 2.0 <= position <= model["N"][i] - 1.0:
            raise ParameterError(
                f"bridge_x {quantities.bridge_x} m is too near a string's end for this grid"
            )
        weights = model["bridge_weights"][i]
        model["bridge_first"][i] = place_cubic(position, int(model["N"][i]), weights)
    weigh_bridge(model)


@compiled
def weigh_bridge(model: Any) -> None:
    """Write S_c of eq. (43): how modes and strings give way. Real time: safe."""
    model.S_c[:] = model.C_q_sum
    for i in range(STRINGS):
        weights = model.bridge_weights[i]
        for l in range(weights.shape[0]):
            model.S_c[i, i] += model.spread[i] * weights[l] * weights[l]


@compiled
def advance_bridge(model: Any, q_next: Array, q: Array, q_prev: Array, f_hammer: float) -> float:
    """Advance the modes, free of string forces; return their sum Q* (m). Eq. (42)."""
    total = 0.0
    for m in range(whole_vectors(model.modes)):
        q_next[m] = model.A_q[m] * q[m] + model.B_q[m] * q_prev[m] + model.C_q[m] * f_hammer
        total += q_next[m]
    return total


@compiled
def tie(model: Any, s: Any) -> None:
    """Invert S_c of eq. (43), whose own entries give way as the strings' tension does."""
    for i in range(STRINGS):
        s.bend_at_bridge[i] = read(s.bend[i], model.bridge_first[i], model.bridge_weights[i])
    give_1 = s.give[0] * s.bend_at_bridge[0] ** 2
    give_2 = s.give[1] * s.bend_at_bridge[1] ** 2
    a, b = model.S_c[0, 0] - give_1, model.S_c[0, 1]
    c, d = model.S_c[1, 0], model.S_c[1, 1] - give_2
    determinant = a * d - b * c
    s.S_c_inverse[0, 0], s.S_c_inverse[0, 1] = d / determinant, -b / determinant
    s.S_c_inverse[1, 0], s.S_c_inverse[1, 1] = -c / determinant, a / determinant


@compiled
def close_bridge(model: Any, s: Any, u_next: Array, Q: float) -> None:
    """Tie both strings to the bridge at n+1; write the coupling forces f_c (N).

    Everything after this meets strings that already follow the bridge.
    Source: [Yehu] eqs. (43)-(45).
    """
    tie(model, s)
    c_1 = Q - read(u_next[0], model.bridge_first[0], model.bridge_weights[0])
    c_2 = Q - read(u_next[1], model.bridge_first[1], model.bridge_weights[1])
    c_1 -= s.slack[0] * s.bend_at_bridge[0]
    c_2 -= s.slack[1] * s.bend_at_bridge[1]
    S = s.S_c_inverse
    s.f_c[0], s.f_c[1] = S[0, 0] * c_1 + S[0, 1] * c_2, S[1, 0] * c_1 + S[1, 1] * c_2


@compiled
def finish_bridge(model: Any, q_next: Array, q_prev: Array, f_c: Array) -> float:
    """Let the strings' forces move the modes, the last term of eq. (59).

    Returns how far the bridge came in two samples (m).
    """
    total = f_c[0] + f_c[1]
    travel = 0.0
    for m in range(whole_vectors(model.modes)):
        q_next[m] -= model.C_q[m] * total
        travel += q_next[m] - q_prev[m]
    return travel
