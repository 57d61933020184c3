"""Friction by a curve: the textbook's law, without bristles, to compare the elasto-plastic with.

The coefficient of a slipping string falls along a hyperbola,

    mu(v_r) = mu_C + (mu_S - mu_C) v_s / (v_s + |v_r|),

and a string that sticks (v_r = 0) bears up to mu_S F_N. Where the curve meets the line
v_r = free - mobility f_b more than once, history decides: a string goes on as it moves for as long
as it can (Friedlander's ambiguity, and the hysteresis that resolves it).

Differs: [Yehu] has bristles. Source: [Friedlander]; [McIntyre]. Derivation: docs/derivation.md,
section 10.
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.records import Model
from yehu_server.errors import ParameterError


def prepare_friction(refined: Any, quantities: Quantities) -> None:
    """Write another law of friction than the plain kernel's into `refined`.

    Raises ParameterError where hair of some width would have several solutions at each of its
    points.
    """
    bow = quantities.bow
    refined["is_hyperbolic"], refined["epsilon_2"] = bow.friction == "hyperbolic", bow.epsilon_2
    if bow.friction == "hyperbolic" and bow.width > 0.0:
        raise ParameterError("bow.friction: hyperbolic is for hair of no width")


@compiled
def curve_force(m: Model, F_N: float, f_b: float, v_r: float) -> float:
    """The friction force (N) of the curve: `f_b` within its bound at v_r = 0, where it sticks."""
    if v_r == 0.0:
        return max(-m.mu_S * F_N, min(f_b, m.mu_S * F_N))
    mu = m.mu_C + (m.mu_S - m.mu_C) * m.v_s / (m.v_s + abs(v_r))
    return math.copysign(mu * F_N, v_r)


@compiled
def solve_curve(
    free: float, mobility: float, F_N: float, v_before: float, m: Model
) -> tuple[float, float]:
    """Find the friction force of one step.

    The slip is the larger root of a quadratic equation: nothing is iterated.

    Parameters
    ----------
    free, mobility : float, m/s, m/s/N
        Relative velocity without friction, and by how much a newton of friction lowers it.
    F_N : float, N
        Normal force, positive.
    v_before : float, m/s
        Relative velocity of the last step; 0 where the string stuck.

    Returns
    -------
    f_b, v_r : float, N, m/s

    Real time: safe.
    """
    may_stick = abs(free) <= mobility * m.mu_S * F_N
    if may_stick and v_before == 0.0:
        return free / mobility, 0.0
    # x^2 - total x + product = 0 for x = |v_r|.
    total = abs(free) - mobility * m.mu_C * F_N - m.v_s
    product = m.v_s * (mobility * m.mu_S * F_N - abs(free))
    discriminant = total * total - 4.0 * product
    slip = 0.5 * (total + math.sqrt(max(0.0, discriminant)))
    if may_stick and (discriminant < 0.0 or slip <= 0.0 or v_before * free < 0.0):
        return free / mobility, 0.0
    v_r = math.copysign(slip, free)
    return (free - v_r) / mobility, v_r
