"""The kernel alone, in a steady state: what `run.py` times beside the yardstick."""

import time
from typing import Any

import numpy as np

from yehu_server.core.physics import kernel, layout, refined, time_loop
from yehu_server.core.physics.default_quantities import Quantities

SETTLED_S = 0.5
VIBRATO_HZ, VIBRATO_M = 6.0, 1e-3
SPEED, BOW_X, FINGER_X, PRESS = 0.2, 0.26, 0.1, 1.5  # m/s, m, m, N


class Kernel:
    """The kernel after half a second of playing.

    `fingers`, `down`: number of fingers, and of those that are down; others are up, near the loop.
    `force`: of the bow (N).
    `vibrato`: whether the fingers move.
    """

    def __init__(
        self,
        fingers: int,
        down: int,
        force: float,
        *,
        vibrato: bool = False,
        rate: float = 44100.0,
        is_idle: bool = False,
    ) -> None:
        self.rate, self.playing = rate, (fingers, down, force, vibrato, is_idle)
        self.model = kernel.prepare(Quantities(), rate, fingers)
        self.refined = refined.prepare(Quantities(), rate)
        self.state = kernel.at_rest(self.model)
        self.advance(*self.rows(round(SETTLED_S * rate)))

    def rows(self, frames: int) -> tuple[Any, Any]:
        """Controls, one row a sample, and room for probes."""
        fingers, down, force, vibrato, is_idle = self.playing
        rows = np.zeros((frames, layout.control_columns(fingers)))
        rows[:, [layout.F_N, layout.V_B, layout.X_B]] = force, SPEED * (force > 0.0), BOW_X
        # Keeps the strings that are not bowed in motion, clear of denormals.
        noise = 0.0 if is_idle else 1e-3
        rows[:, layout.F_HAMMER] = noise * np.random.default_rng(1).normal(size=frames)
        swing = np.sin(np.arange(frames) / self.rate * 2.0 * np.pi * VIBRATO_HZ)
        for j in range(fingers):
            at = layout.FINGER_CONTROLS + layout.CONTROLS_PER_FINGER * j
            if j < down:
                rows[:, at] = FINGER_X if down == 1 else 0.03 + 0.03 * j
                rows[:, at] += VIBRATO_M * swing * vibrato
                rows[:, at + 1] = PRESS
            else:
                rows[:, at] = 0.012
        return rows, np.zeros((frames, layout.probe_columns(fingers)))

    def advance(self, rows: Any, probes: Any) -> float:
        """Advance over rows of controls; return the seconds it took."""
        start = time.perf_counter()
        time_loop.run(self.model, self.state, self.refined, rows, probes)
        return time.perf_counter() - start
