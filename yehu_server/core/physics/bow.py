"""The bow: which string it is on, its hair, and the velocity the friction law sees.

[Yehu] eqs. (47)-(50) and (60). Differs: C_h carries 4 k^2; s and the factor of f_b
are taken after tension, bridge and fingers are eliminated, so that they also hold
where the bow shares nodes with the bridge or a finger.
"""

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.grid import interpolate
from yehu_server.core.physics.layout import BOW, STRINGS
from yehu_server.core.physics.records import Array, Contacts, Model, Motion, Work
from yehu_server.core.physics.torsion import largest_yielding

FRICTION_MARGIN = 4.0  # times mu_S F_N
STEEPEST = 1.34  # times epsilon_0 k/2: how much friction falls at most as v_r grows


def prepare_bow(model: np.void, quantities: Quantities) -> None:
    """Write friction and hair coefficients into `model`. Source: [Yehu] eq. (60)."""
    k, bow = model["k"], quantities.bow
    for name in ("epsilon_0", "epsilon_1", "v_s", "mu_C", "mu_S", "xi", "lift_force"):
        model[name] = getattr(bow, name)
    stiffness = bow.epsilon_0 + 2.0 * bow.epsilon_1 / k
    model["bristle_stiffness"], model["per_v_s"] = stiffness, 1.0 / bow.v_s
    presliding_range = bow.mu_C * (1.0 - np.array(bow.xi))  # from z_ba to kinetic friction
    model["chi_slope"] = np.pi / presliding_range
    model["hair"], model["per_grain"] = bow.hair, 1.0 / bow.grain
    M_h, K_h, R_h = bow.M_h, bow.K_h, bow.R_h
    model["M_h"], model["K_h"], model["R_h"] = M_h, K_h, R_h
    Lambda = 4.0 * M_h + k * k * K_h + 2.0 * k * R_h
    model["A_h"] = (8.0 * M_h - 2.0 * k * k * K_h) / Lambda
    model["B_h"] = (-4.0 * M_h - k * k * K_h + 2.0 * k * R_h) / Lambda
    model["C_h"] = 4.0 * k * k / Lambda


def friction_bound(
    model: np.void, refined: np.void | None = None, compliance: float | None = None
) -> float:
    """Return a number that is below 1 where the friction equation has one solution only.

    It is sufficient, for the bow on a node, as long as bristles are stretched no farther than the
    bow force sustains (docs/physics.md). With torsion (`refined`) the string yields more;
    `compliance` (m/N) is that of a modal string, in the place of a node's.
    """
    k = model["k"]
    yielding = 0.0 if refined is None else largest_yielding(refined)
    own = model["spread"].max() if compliance is None else compliance
    mobility = (own + model["C_h"] + yielding) / (2.0 * k)
    return float(STEEPEST * mobility * model["epsilon_0"] * k / 2.0)


@compiled
def friction_limit(model: Model, F_N: float) -> float:
    """Return a friction force (N) beyond what a bow force sustains.

    Bristles that a larger bow force has bent may exceed it for some steps.
    """
    return float(FRICTION_MARGIN * model.mu_S * abs(F_N))


@compiled
def choose_string(model: Model, s: Motion, c: Contacts, w: Work, F_N: float) -> tuple[int, bool]:
    """Return the string under the bow, by the sign of the force, and whether it is bowed.

    Bristles off the string lose their deflection; its energy is recorded as a loss.
    """
    bowed = abs(F_N) >= model.lift_force
    string = c.string[BOW]
    if bowed:
        string = 0 if F_N > 0.0 else 1
    for i in range(STRINGS):
        if s.z[i] != 0.0 and not (bowed and i == string):
            w.dropped_z += 0.5 * model.epsilon_0 * s.z[i] * s.z[i]
            s.z[i] = 0.0
    return string, bowed


@compiled
def advance_hair(model: Model, zeta_next: Array, zeta: Array, zeta_prev: Array) -> None:
    """Advance the hair of both strings, free of friction: eq. (60)."""
    for i in range(STRINGS):
        zeta_next[i] = model.A_h * zeta[i] + model.B_h * zeta_prev[i]


@compiled
def contact_velocity(
    model: Model, c: Contacts, u_b: float, u_prev: Array, zeta_next: Array, zeta_prev: Array
) -> float:
    """Return I_b delta_t. u + delta_t. zeta (m/s), where `u_b` (m) is I_b u^{n+1}.

    Less the bow's velocity it is v_r, the velocity of the string relative to the hair.
    """
    i = c.string[BOW]
    travel = u_b - interpolate(u_prev[i], c.first[BOW], c.weights[BOW])
    return float(0.5 * model.rate * (travel + zeta_next[i] - zeta_prev[i]))
