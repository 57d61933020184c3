"""Tension modulation: a stretched string is tighter, by EA/(2 L) int u_x^2 dx.

This is how pressing a silk string, which no fingerboard stops, raises its pitch. The potential
is quadratised as the contacts' are. The change of tension

    T' = EA/(4 L) (<delta_x+ u^{n+1}, delta_x+ u^n> + <delta_x+ u^n, delta_x+ u^{n-1}>)

is implicit, and has one solution. It moves the whole string by one multiple, tau, of the second
difference Delta u^n:

    tau = spread/h T' = -gain Delta u^n . (u^{n+1} + u^{n-1}),    . being the plain sum over nodes,

so that every force on the string changes tau, and tau every displacement that is read before
the step's end (contacts.py).
Source: [Bilbao] section 8.1; docs/physics.md. Derivation: docs/derivation.md, section 2.
"""

from typing import Any

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.layout import GHOST, padded_length
from yehu_server.core.physics.records import Array, Model, Motion, Work


def prepare_tension(model: Any, quantities: Quantities) -> None:
    """Write EA/(4 L h) of both strings into `model`; their grids must be there."""
    for i, string in enumerate(quantities.strings):
        EA = quantities.tension_modulation * string.EA
        model["stretch_stiffness"][i] = EA / (4.0 * string.L * model["h"][i])


@compiled
def set_tension_gain(model: Model, i: int) -> None:
    """Write gain, -tau per Delta u^n . u (1/m^2). Real time: safe."""
    model.tension_gain[i] = model.stretch_stiffness[i] * model.spread[i] / model.h[i]


@compiled
def eliminate_tension(model: Model, w: Work, i: int) -> tuple[float, float, float]:
    """Eliminate a string's tau.

    Returns it without other forces, how it responds to the sum of the forces times Delta u^n under
    them (1/(N m)), and 1 + gain Delta u^n . Delta u^n, by which both have been divided.
    """
    pivot = 1.0 + model.tension_gain[i] * w.Delta_u_squared[i]
    weight = model.tension_gain[i] / pivot
    return -w.Delta_u_travel[i] * weight, model.spread[i] * weight, pivot


@compiled
def move_by_tension(model: Model, s: Motion, w: Work, u_next: Array) -> None:
    """Add tau Delta u^n to both strings."""
    tau_1, tau_2 = w.tau[0], w.tau[1]
    if tau_1 == 0.0 and tau_2 == 0.0:
        return
    for l in range(padded_length(max(model.N[0], model.N[1]) - 1)):
        at = GHOST + 1 + l
        u_next[0, at] += tau_1 * s.Delta_u[0, at] * model.inside[0, at]
        u_next[1, at] += tau_2 * s.Delta_u[1, at] * model.inside[1, at]
