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
from yehu_server.physics.tension import tighten

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
def close_bridge(model: Any, s: Any, u_next: Array, Q: float) -> None:
    """Let tension and bridge hold both strings at n+1, as if nothing else touched them.

    Everything after this meets strings that already follow the bridge. Written are the coupling
    forces ``s.f_c`` (N), the slack of each string, and how these answer to more forces. A newton
    on string j where Delta u^n is b metres leaves ``give[i, j] b`` of slack on string i, and adds
    ``tug[j, i] b`` to its f_c; one at the bridge ``tug[i, j]`` and ``S_c_inverse[i, j]``.
    Source: [Yehu] eqs. (43)-(45); tension.py.
    """
    slack_0, give_0, stretched_0 = tighten(model, s, 0)
    slack_1, give_1, stretched_1 = tighten(model, s, 1)
    bend_0 = read(s.bend[0], model.bridge_first[0], model.bridge_weights[0])
    bend_1 = read(s.bend[1], model.bridge_first[1], model.bridge_weights[1])
    gap_0 = Q - read(u_next[0], model.bridge_first[0], model.bridge_weights[0]) - slack_0 * bend_0
    gap_1 = Q - read(u_next[1], model.bridge_first[1], model.bridge_weights[1]) - slack_1 * bend_1

    # S_c, whose own entries give way as tension does. Its rows are taken times `stretched`, so
    # that no division waits for another.
    b = model.S_c[0, 1]
    a = model.S_c[0, 0] * stretched_0 - model.taut[0] * model.spread[0] * bend_0 * bend_0
    d = model.S_c[1, 1] * stretched_1 - model.taut[1] * model.spread[1] * bend_1 * bend_1
    both = stretched_0 * stretched_1
    per_determinant = 1.0 / (a * d - b * b * both)
    S_00, S_11 = d * stretched_0 * per_determinant, a * stretched_1 * per_determinant
    S_01 = -b * both * per_determinant
    s.S_c_inverse[0, 0], s.S_c_inverse[0, 1] = S_00, S_01
    s.S_c_inverse[1, 0], s.S_c_inverse[1, 1] = S_01, S_11
    f_0, f_1 = S_00 * gap_0 + S_01 * gap_1, S_01 * gap_0 + S_11 * gap_1
    s.f_c[0], s.f_c[1] = f_0, f_1

    lead_0, lead_1 = give_0 * bend_0, give_1 * bend_1
    s.slack[0], s.slack[1] = slack_0 - lead_0 * f_0, slack_1 - lead_1 * f_1
    s.tug[0, 0], s.tug[0, 1] = -lead_0 * S_00, -lead_0 * S_01
    s.tug[1, 0], s.tug[1, 1] = -lead_1 * S_01, -lead_1 * S_11
    s.give[0, 0], s.give[1, 1] = give_0 + lead_0 * lead_0 * S_00, give_1 + lead_1 * lead_1 * S_11
    s.give[0, 1] = s.give[1, 0] = lead_0 * S_01 * lead_1


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
