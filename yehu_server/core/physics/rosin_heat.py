"""Rosin whose friction falls as the contact of bow and string gets hot.

Another law than [Yehu]'s, by choice of the instrument file. There friction falls with the speed of
slipping, eq. (17). Here it falls with the temperature, which the power dissipated in the contact
raises and conduction lowers:

    dw/dt = (P / F_N - w) / cooling_time.

w (m/s) is the temperature as the power per newton that sustains it. Steady slipping at v_r
sustains w = mu v_r, with mu of the Stribeck curve; so the static coefficient at w is chosen such
that steady slipping has the friction of eq. (17), and only what changes differs.
"""

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.elementary import elementwise, exp
from yehu_server.core.physics.layout import HEAT_COUNT, STRINGS
from yehu_server.core.physics.records import Model, Motion, Work

MAX_SLIP_SPEED = 3.5  # v_s; by there the Stribeck curve has fallen to mu_C


def prepare_heat(model: np.void, quantities: Quantities) -> None:
    """Write the table of softening, and the share of w that is lost in a sample, into `model`."""
    bow = quantities.bow
    model["is_thermal"] = bow.friction == "thermal"
    if not model["is_thermal"]:
        return
    v_r = np.linspace(0.0, MAX_SLIP_SPEED * bow.v_s, 8 * HEAT_COUNT)
    mu = bow.mu_C + (bow.mu_S - bow.mu_C) * elementwise(exp, -((v_r / bow.v_s) ** 2))
    w = np.maximum.accumulate(mu * v_r)  # where it would fall, the contact runs through
    heats = np.linspace(0.0, w[-1], HEAT_COUNT)
    model["softened"] = np.interp(heats, w, mu)
    model["per_heat"] = (HEAT_COUNT - 1) / w[-1]
    model["cooled"] = 1.0 - exp(-model["k"] / bow.cooling_time)
    model["per_v_s"] = 0.0  # friction does not depend on the speed itself


@compiled
def static_coefficient(m: Model, w: float) -> float:
    """The static friction coefficient of a contact at a temperature w (m/s)."""
    if m.is_thermal == 0:
        return float(m.mu_S)
    at = min(w * m.per_heat, HEAT_COUNT - 1.000001)
    cell = int(at)
    low, high = m.softened[cell], m.softened[cell + 1]
    return float(low + (at - cell) * (high - low))


@compiled
def warm(m: Model, s: Motion, work: Work, string: int, bowed: bool, F_N: float) -> None:
    """Advance the temperature of both contacts by the power that friction dissipated."""
    if m.is_thermal == 0:
        return
    for i in range(STRINGS):
        heating = 0.0
        if bowed and i == string:
            heating = max(0.0, (s.f_b * s.v_r - m.epsilon_0 * work.z_bar * work.r) / F_N)
        s.w[i] += m.cooled * (heating - s.w[i])
