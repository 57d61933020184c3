"""Lobes: how a body sounds in two directions beside that which was measured. Compiled.

From some 1 kHz up the pattern in which a fiddle radiates changes from one semitone to the next
[Weinreich], so a body that turns a little lets some partials rise and others fall, and a vibrato
swings them apart. What two neighbouring directions have more than the measured one is the same
sound, through a high-pass filter and one all-pass filter, or both, whose phase goes round once in
some 100 to 300 Hz: modes are about as far apart in a small shell. `Unverified:` no yehu was
measured in several directions.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.elementary import tan
from yehu_server.core.physics.grid import MAX_RATE

DIRECTIONS = 2
DELAYS_S = (4.07e-3, 6.29e-3)  # of the all-pass filters; no small whole numbers fit both
REFLECTED = 0.5
# From lower on, fundamentals would turn their phase as the player sways, and be out of tune.
FROM_HZ, PASSES = 1400.0, 2
MAX_DELAY = math.ceil(MAX_RATE * max(DELAYS_S))

LOBES = np.dtype(
    [
        ("pass_b", np.float64),  # the high-pass filters
        ("pass_a", np.float64),
        ("passed", np.float64, PASSES),
        ("before", np.float64, PASSES),
        ("delay", np.int64, DIRECTIONS),  # frames
        ("at", np.int64, DIRECTIONS),
        ("line", np.float64, (DIRECTIONS, MAX_DELAY)),
    ],
    align=True,
)


def prepare_lobes(lobes: Any, rate: float) -> None:
    """Prepare a record of dtype LOBES [shape=(1,)] for a rate (Hz), in place."""
    warped = tan(math.pi * FROM_HZ / rate)
    lobes["pass_b"] = 1.0 / (1.0 + warped)
    lobes["pass_a"] = (1.0 - warped) / (1.0 + warped)
    lobes["delay"] = [round(delay * rate) for delay in DELAYS_S]
    lobes["at"] = 0
    for name in ("passed", "before", "line"):
        lobes[name] = 0.0


@compiled
def radiate_aside(s: Any, x: float) -> tuple[float, float]:
    """What two directions have more of a sample than the measured one. Real time: safe."""
    for k in range(PASSES):
        passed = s.pass_b * (x - s.before[k]) + s.pass_a * s.passed[k]
        s.before[k], s.passed[k] = x, passed
        x = passed
    first = delayed(s, 0, x)
    return first, delayed(s, 1, first)


@compiled
def delayed(s: Any, k: int, x: float) -> float:
    """The next output of an all-pass filter."""
    n = s.at[k]
    late = s.line[k, n]
    kept = x - REFLECTED * late
    s.line[k, n] = kept
    s.at[k] = n + 1 if n + 1 < s.delay[k] else 0
    return float(REFLECTED * kept + late)


@compiled
def clear_lobes(s: Any) -> None:
    """Clear the filters while sound runs. Real time: safe."""
    for k in range(PASSES):
        s.passed[k], s.before[k] = 0.0, 0.0
    for k in range(DIRECTIONS):
        for n in range(s.delay[k]):
            s.line[k, n] = 0.0
