"""How much power is missing from the energy ledger, over random playing of ten seconds."""

from itertools import product
from typing import Any

import numpy as np

from yehu_server.core.physics import kernel, layout, time_loop
from yehu_server.core.physics.default_quantities import Quantities

SECONDS = 10.0
SEEDS, AT_OTHER_RATES = 24, 3
RATES = (44100.0, 96000.0, 192000.0)
KINDS = {
    "one finger, ordinary playing": (1, False),
    "four fingers that tap": (4, False),
    "four fingers and bow that jump": (4, True),
}


def measure() -> list[dict[str, Any]]:
    """The worst of some random runs, for each kind of playing and each rate."""
    rows = []
    for rate, (kind, (fingers, jumps)) in product(RATES, KINDS.items()):
        seeds = SEEDS if rate == RATES[0] else AT_OTHER_RATES
        runs = [one(rate, fingers, jumps=jumps, seed=seed) for seed in range(seeds)]
        errors, powers, lost = (np.array(each) for each in zip(*runs, strict=True))
        rows.append(
            {
                "rate": rate,
                "kind": kind,
                "runs": seeds,
                "median_w": float(np.median(errors)),
                "worst_w": float(errors.max()),
                "power_w": float(powers.max()),
                "lost": int(lost.sum()),
            }
        )
    return rows


def one(rate: float, fingers: int, *, jumps: bool, seed: int) -> tuple[float, float, int]:
    """Largest missing power (W), largest power given (W), and lost states of a run."""
    chance = np.random.default_rng(seed)
    frames = round(SECONDS * rate)
    rows = np.zeros((frames, layout.control_columns(fingers)))
    rows[:, layout.F_N] = _wander(chance, frames, rate, -1.5, 1.5, jumps=jumps)
    rows[:, layout.V_B] = _wander(chance, frames, rate, -0.5, 0.5, jumps=jumps)
    rows[:, layout.X_B] = _wander(chance, frames, rate, 0.2, 0.295, jumps=False)
    rows[:, layout.Y_B] = np.cumsum(rows[:, layout.V_B]) / rate
    for finger in range(fingers):
        at = layout.FINGER_CONTROLS + layout.CONTROLS_PER_FINGER * finger
        rows[:, at] = _wander(chance, frames, rate, 0.02, 0.2, jumps=jumps)
        press = _wander(chance, frames, rate, -2.0, 5.0, jumps=jumps or fingers > 1)
        rows[:, at + 1] = press.clip(min=0.0)
    model = kernel.prepare(Quantities(), rate, fingers)
    state = kernel.at_rest(model)
    probes = np.zeros((frames, layout.probe_columns(fingers)))
    ledger = np.zeros((frames, len(layout.LEDGER)))
    time_loop.run(model, state, None, rows, probes, ledger)
    error = ledger[:, layout.LEDGER.index("energy_error")]
    power = ledger[:, layout.LEDGER.index("power_in")]
    return float(np.abs(error).max()), float(np.abs(power).max()), int(state["lost"][0])


def _wander(chance: Any, frames: int, rate: float, lo: float, hi: float, *, jumps: bool) -> Any:
    """Values by chance, held for 0.1 to 0.6 s each, with ramps of 30 ms or jumps between."""
    count = round(SECONDS / 0.1) + 1
    starts = np.cumsum(chance.uniform(0.1, 0.6, count)) - 0.1
    values = chance.uniform(lo, hi, count)
    ramp = 0.0 if jumps else 0.03
    times = np.stack([starts, starts + ramp], axis=1).reshape(-1)
    levels = np.stack([np.roll(values, 1), values], axis=1).reshape(-1)
    return np.interp(np.arange(frames) / rate, times, levels)
