"""Tension modulation: a string that is stretched is tighter, T + EA/(2 L) int u_x^2 dx.

Pressing a silk string, which no fingerboard stops, raises its pitch this way. The potential
is quadratised as the contacts' are, and the whole change of the string is its second
difference Delta u^n times one scalar:

    T' = EA/(4 L) (<delta_x+ u^{n+1}, delta_x+ u^n> + <delta_x+ u^n, delta_x+ u^{n-1}>),

implicit, with one solution. A force on the string changes T', and T' moves the whole string,
which every reading of u^{n+1} before the step's end takes in (contacts.py).
Source: [Bilbao] section 8.1; docs/physics.md.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.physics.layout import GHOST, whole_vectors
from yehu_server.physics.quantities import Quantities

Array = Any


def prepare_tension(model: np.void, quantities: Quantities) -> None:
    """Write EA/(4 L h) of both strings into `model`; their grids must be there."""
    for i, string in enumerate(quantities.strings):
        EA = quantities.tension_modulation * string.EA
        model["stretch"][i] = EA / (4.0 * string.L * model["h"][i])
        weigh_tension(model, i)


@compiled
def weigh_tension(model: Any, i: int) -> None:
    """Write what a string moves by its change of tension. Real time: safe."""
    model.taut[i] = model.stretch[i] * model.spread[i] / model.h[i]


@compiled
def tighten(model: Any, s: Any, i: int) -> tuple[float, float, float]:
    """Let a string stretch over a step free of other forces.

    Returns
    -------
    slack : float
        What of Delta u^n u^{n+1} still lacks.
    give : float, 1/(N m)
        How much more slack a newton leaves for each metre of Delta u^n under it.
    stretched : float
        1 + taut <Delta u, Delta u>, which both have been divided by.
    """
    stretched = 1.0 + model.taut[i] * s.square[i]
    weight = model.taut[i] / stretched
    return -s.along[i] * weight, model.spread[i] * weight, stretched


@compiled
def take_up_slack(model: Any, s: Any, u_next: Array) -> None:
    """Move the strings by what their change of tension, slack h / spread (N), is by now."""
    slack_1, slack_2 = s.slack[0], s.slack[1]
    if slack_1 == 0.0 and slack_2 == 0.0:
        return
    for l in range(whole_vectors(max(model.N[0], model.N[1]) - 1)):
        at = GHOST + 1 + l
        u_next[0, at] += slack_1 * s.bend[0, at]
        u_next[1, at] += slack_2 * s.bend[1, at]
