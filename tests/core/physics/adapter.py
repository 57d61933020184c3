"""Conversions between the kernel's records (layout.py) and the reference's (reference.py)."""

import math
from typing import Any

import numpy as np
import reference as ref

from yehu_server.core.physics import kernel, layout, time_loop
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.string import set_Delta_u


def felt(quantities: Quantities, L: float, N: int) -> ref.Array:
    """1/s at the inner nodes: most halfway from bridge to end, none at both nor where either acts.

    The bridge acts on four nodes, two of them beyond it.
    """
    x, x_c = L / N * np.arange(1, N), quantities.bridge_x
    hump = 0.5 - 0.5 * np.cos(2.0 * np.pi * (x - x_c) / (L - x_c))
    felt: ref.Array = quantities.felt_loss * np.where(x - x_c > 2.0 * L / N, hump, 0.0)
    return felt


def reference_params(quantities: Quantities, rate: float) -> ref.RefParams:
    """The instrument as the reference's parameters; the reference chooses the grids."""
    strings = []
    for string in quantities.strings:
        A, EI = math.pi * string.r**2, string.E * math.pi * string.r**4 / 4.0
        highest_T = string.T * quantities.tension_headroom
        N = ref.largest_N(
            string.rho, A, highest_T, EI, string.sigma_0, string.sigma_1, string.L, 1.0 / rate
        )
        strings.append(
            ref.RefString(
                rho=string.rho,
                A=A,
                T=string.T,
                EI=EI,
                sigma_0=string.sigma_0,
                sigma_1=string.sigma_1,
                L=string.L,
                N=N,
                EA=quantities.tension_modulation * string.E * A,
                felt=felt(quantities, string.L, N),
            )
        )
    bow, finger, body = quantities.bow, quantities.finger, quantities.body
    return ref.RefParams(
        strings=strings,
        x_c=quantities.bridge_x,
        M=np.array(body.mass),
        R=np.array(body.damping),
        omega=2.0 * np.pi * np.array(body.frequency_hz),
        eps0=bow.epsilon_0,
        eps1bar=bow.epsilon_1,
        v_s=bow.v_s,
        mu_C=bow.mu_C,
        mu_S=bow.mu_S,
        xi=np.array(bow.xi),
        M_h=bow.M_h,
        K_h=bow.K_h,
        R_h=bow.R_h,
        lift_threshold=bow.lift_force,
        M_f=finger.M_f,
        K_f=finger.K_f,
        alpha=finger.alpha,
        beta=finger.beta,
        omega_lift=finger.omega_lift,
        U_rest=finger.rest_height,
        rate=rate,
    )


def kernel_state(model: Any, state: ref.RefState) -> Any:
    """The kernel's record of a reference state."""
    record = kernel.at_rest(model)
    s = record[0]["motion"]
    level = 1  # any of the three would do
    prev = (level + 2) % layout.LEVELS
    s["level"] = level
    for i in range(layout.STRINGS):
        N = len(state.u[i]) - 1
        for at, u in ((level, state.u[i]), (prev, state.u_prev[i])):
            points = s["u"][at, i]
            points[layout.GHOST : layout.GHOST + N + 1] = u
            points[0], points[N + 2] = -points[2], -points[N]
    set_Delta_u(model[0], s)
    modes, fingers = len(state.q), len(state.U)
    s["q"][level, :modes], s["q"][prev, :modes] = state.q, state.q_prev
    s["zeta"][level], s["zeta"][prev] = state.zeta, state.zeta_prev
    s["z"] = state.z
    s["U"][level, :fingers], s["U"][prev, :fingers] = state.U, state.U_prev
    s["Psi"][: 2 * fingers] = state.Psi.ravel()
    return record


def control_row(controls: ref.RefControls) -> Any:
    """One row of the kernel's controls [shape=(1, columns)]."""
    fingers = np.stack([controls.x_f, controls.press], axis=1).ravel()
    even_hair = (0.0, 0.0)  # its place, and the depth of its texture
    bow = [controls.F_N, controls.v_b, controls.x_b, *even_hair, controls.f_hammer]
    return np.array([[*bow, controls.f_pluck, controls.x_pluck, *fingers]])


def step_kernel(model: Any, record: Any, controls: ref.RefControls, ledger: Any) -> dict[str, Any]:
    """Advance the kernel by one sample; return the next state and the forces by name.

    `ledger` [shape=(1, columns)] gets the sample's energy row.
    """
    fingers = len(controls.x_f)
    probe = np.zeros((1, layout.probe_columns(fingers)))
    time_loop.run(model, record, None, control_row(controls), probe, ledger)
    s = record[0]["motion"]
    now = int(s["level"])
    N = model["N"][0]
    first = layout.GHOST
    return {
        "u_1": s["u"][now, 0, first : first + N[0] + 1].copy(),
        "u_2": s["u"][now, 1, first : first + N[1] + 1].copy(),
        "q": s["q"][now, : int(model["modes"][0])].copy(),
        "zeta": s["zeta"][now].copy(),
        "z": s["z"].copy(),
        "U": s["U"][now, :fingers].copy(),
        "Psi": s["Psi"][: 2 * fingers].copy(),
        "f_c": probe[0, [layout.BRIDGE_FORCE_1, layout.BRIDGE_FORCE_2]],
        "f_b": probe[0, layout.FRICTION_FORCE],
        "v_r": probe[0, layout.RELATIVE_VELOCITY],
        "f_f": np.array(
            [
                probe[0, layout.FINGER_PROBES + layout.PROBES_PER_FINGER * j + 1 + i]
                for j in range(fingers)
                for i in range(layout.STRINGS)
            ]
        ),
    }


def step_reference(
    params: ref.RefParams, state: ref.RefState, controls: ref.RefControls
) -> tuple[ref.RefState, dict[str, Any], ref.RefOutputs]:
    """Advance the reference by one sample; return its state, the same names, and its outputs."""
    after, outputs = ref.step(params, state, controls)
    named = {
        "u_1": after.u[0],
        "u_2": after.u[1],
        "q": after.q,
        "zeta": after.zeta,
        "z": after.z,
        "U": after.U,
        "Psi": after.Psi.ravel(),
        "f_c": outputs.f_c,
        "f_b": outputs.f_b,
        "v_r": outputs.v_r,
        "f_f": outputs.f_f.ravel(),
    }
    return after, named, outputs
