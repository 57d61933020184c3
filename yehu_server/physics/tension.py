"""Tension modulation: a string that is stretched is tighter, T + EA/(2 L) int u_x^2 dx.

Pressing a silk string, which no fingerboard stops, raises its pitch this way. The potential
is quadratised as the contacts' are, and the whole change of the string is its second
difference Delta u^n times one scalar:

    T' = EA/(4 L) (<delta_x+ u^{n+1}, delta_x+ u^n> + <delta_x+ u^n, delta_x+ u^{n-1}>),

implicit, with one solution. A force on the string changes T', and T' moves the whole string,
so every reading of u^{n+1} before the step's end adds ``slack`` times the reading of Delta u^n.
Source: [Bilbao] section 8.1; docs/physics.md.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.physics.layout import GHOST, STRINGS
from yehu_server.physics.quantities import Quantities
from yehu_server.physics.stencil import read

Array = Any


def prepare_tension(model: np.void, quantities: Quantities) -> None:
    """Write EA/(4 L h) of both strings into `model`; their grids must be there."""
    for i, string in enumerate(quantities.strings):
        EA = quantities.tension_modulation * string.EA
        model["stretch"][i] = EA / (4.0 * string.L * model["h"][i])


@compiled
def tighten(model: Any, s: Any, u_next: Array, u: Array, u_prev: Array) -> None:
    """Let both strings stretch over a step free of other forces; keep how they will give.

    Writes ``s.bend``, Delta u^n; ``s.slack``, what of it u^{n+1} still lacks; and ``s.give``,
    how much more slack a newton leaves for each metre of Delta u^n under it.
    """
    for i in range(STRINGS):
        stretch = model.stretch[i]
        if stretch == 0.0:
            continue
        inner = model.N[i] - 1
        bend = s.bend[i, GHOST + 1 : GHOST + 1 + inner]
        left, here, right = u[i, 1 : 1 + inner], u[i, 2 : 2 + inner], u[i, 3 : 3 + inner]
        after = u_next[i, GHOST + 1 : GHOST + 1 + inner]
        before = u_prev[i, GHOST + 1 : GHOST + 1 + inner]
        square, along = 0.0, 0.0
        for l in range(inner):
            delta = left[l] - 2.0 * here[l] + right[l]
            bend[l] = delta
            square += delta * delta
            along += delta * (after[l] + before[l])
        per_newton = model.spread[i] / model.h[i]  # of T', times Delta u: metres
        weight = 1.0 / (1.0 + stretch * per_newton * square)
        s.slack[i] = -per_newton * stretch * along * weight
        s.give[i] = per_newton * stretch * model.spread[i] * weight


@compiled
def tension_varies(s: Any) -> bool:
    """Whether any string is tightened in this step."""
    return bool(s.give[0] != 0.0 or s.give[1] != 0.0)


@compiled
def reading(s: Any, u_next: Array, i: int, first: int, weights: Array, bend: float) -> float:
    """I u^{n+1} of string `i` within a step; `bend` is I Delta u^n there."""
    return float(read(u_next[i], first, weights) + s.slack[i] * bend)


@compiled
def take_up_slack(model: Any, s: Any, u_next: Array) -> None:
    """Move the strings by what their change of tension is by now, and note it (N)."""
    for i in range(STRINGS):
        if model.stretch[i] == 0.0:
            continue
        inner = model.N[i] - 1
        bend = s.bend[i, GHOST + 1 : GHOST + 1 + inner]
        after = u_next[i, GHOST + 1 : GHOST + 1 + inner]
        slack = s.slack[i]
        for l in range(inner):
            after[l] += slack * bend[l]
        s.T_more[i] = slack * model.h[i] / model.spread[i]
        s.slack[i] = 0.0
