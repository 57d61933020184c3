"""Strokes by chance that no other study has, at two rates: whether shares are within the bar."""

from typing import Any

import numpy as np

from validation import convergence
from yehu_lab.regimes.columns import REGIMES
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of

STROKES, SEED = 200, 2026
RATES = (44100.0, 352800.0)
HIGHEST = (76.5, 89.0)  # MIDI notes of both strings
LOWEST = (66.0, 73.0)
SPEEDS, BETAS, FORCES = (0.05, 0.4), (0.05, 0.3), (0.06, 3.0)


def measure() -> dict[str, Any]:
    """Regimes and pitches of the strokes at each rate."""
    chance = np.random.default_rng(SEED)
    rows = []
    for _ in range(STROKES):
        string = int(chance.integers(1, 3))
        pitch = float(chance.uniform(LOWEST[string - 1], HIGHEST[string - 1]))
        speed, beta, force = (
            float(np.exp(chance.uniform(*np.log(ends)))) for ends in (SPEEDS, BETAS, FORCES)
        )
        rows.append([one(string, pitch, rate, speed, beta, force) for rate in RATES])
    regimes = np.array([[found["regime"] for found in row] for row in rows])
    return {"rates": RATES, "regimes": [[REGIMES[each] for each in row] for row in regimes]}


def one(
    string: int, pitch: float, rate: float, speed: float, beta: float, force: float
) -> dict[str, Any]:
    """What a stroke ends in."""
    gesture, bridge_x, length = convergence.stroke(string, pitch, rate, speed=speed)
    force *= 1.0 if string == 1 else -1.0
    vary = {"bow_position": [bridge_x - beta * length], "bow_force": [force]}
    found = sweep(study_of({"gesture": gesture, "vary": vary}), workers=1)
    return {"regime": int(found.columns["regime"][0])}
