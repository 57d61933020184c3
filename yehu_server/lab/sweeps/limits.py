"""Schelleng's limits of the bow force for the strokes of a study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.core.physics.layout import F_N, FINGER_CONTROLS, V_B, X_B
from yehu_server.core.physics.schelleng import bridge_resistance, lower_limit, upper_limit
from yehu_server.lab.sweeps.study import Study

Array = Any


@dataclass(frozen=True)
class Limits:
    """Of one stroke: Schelleng's limits (N), the bow position beta, and the note (Hz)."""

    lower: float
    upper: float
    beta: float
    frequency_hz: float


def limits_of(study: Study, at: Mapping[str, int]) -> Limits:
    """Schelleng's limits at a point of a study, for the bow's speed at the end.

    `at` is the place on each axis, by name; 0 where it has none.
    """
    index = np.array([[at.get(axis.name, 0) for axis in study.axes]])
    models, _, strokes, hands = study.bow.strokes(study.axes, index)
    model, stroke = models[0], strokes[0]

    def end(column: int) -> float:
        move = stroke["moves"][column]
        curve = slice(hands.first[column], hands.first[column + 1])
        time = (stroke["frames"] / model["rate"] - move["start"]) * move["pace"]
        times, values = hands.times[curve], hands.values[curve]
        return float(move["scale"] * np.interp(time, times, values)) if len(times) else 0.0

    string = 0 if end(F_N) >= 0.0 else 1
    bridge = float(model["bridge_x"])
    stop = end(FINGER_CONTROLS) if end(FINGER_CONTROLS + 1) > 0.0 else 0.0
    beta = (bridge - end(X_B)) / (bridge - stop)
    Z = float(np.sqrt(model["T"][string] * model["rho_A"][string]))  # noqa: N806 - as in physics
    grip = float(model["mu_S"] - model["mu_C"])
    frequency = float(stroke["frequency_hz"])
    resistance = bridge_resistance(model, frequency)
    speed = abs(end(V_B))
    return Limits(
        lower_limit(Z, grip, resistance, speed, beta),
        upper_limit(Z, grip, speed, beta),
        beta,
        frequency,
    )
