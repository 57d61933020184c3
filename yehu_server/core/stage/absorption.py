"""What walls and air take from sound: filters whose loss grows with the frequency. Compiled.

A room decays by 60 dB within its decay time at low frequencies, and faster at high ones, as air
and soft walls have it: the loss per second is a + (b - a) f^2 / (f^2 + CROSSOVER_HZ^2), from a
at low frequencies to b at high ones. Each filter is a first-order shelf whose decibels are in
proportion to the time that sound was on its way [Jot].
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import exp10, tan

CROSSOVER_HZ = 2500.0  # Hz
MAX_DAMPING = 0.8
DECAYED_DB = 60.0


@compiled_exactly
def loss_low(decay: float) -> float:
    """Loss at low frequencies (dB/s), for a decay time (s)."""
    return DECAYED_DB / decay


@compiled_exactly
def loss_high(decay: float, damping: float) -> float:
    """Loss at high frequencies (dB/s); a damping of 1 has them decay in a fifth of the time."""
    return DECAYED_DB / (decay * (1.0 - MAX_DAMPING * damping))


@compiled_exactly
def set_shelf(shelf: Any, line: int, time: float, decay: float, damping: float) -> None:
    """Write filter `line` of a shelf record, of sound that was on its way for a time (s)."""
    low = exp10(-loss_low(decay) * time / 20.0)
    more_db = (loss_high(decay, damping) - loss_low(decay)) * time
    step = exp10(-more_db / 40.0)  # square root of the shelf's height
    warped = tan(math.pi * min(CROSSOVER_HZ / shelf.rate, 0.45))
    scale = 1.0 / (1.0 / step + warped)
    shelf.b_0[line] = low * (step + warped) * scale
    shelf.b_1[line] = low * (warped - step) * scale
    shelf.a_1[line] = (warped - 1.0 / step) * scale
