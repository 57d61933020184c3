"""The limiter at the end of the mix. Compiled."""

from __future__ import annotations

import math

from yehu_server.jit import compiled


@compiled
def limit(x: float, soft: float) -> float:
    """Soft clipping: above `soft` (0 to 1) peaks are bent, so that none exceeds full scale.

    Odd, memoryless, and smooth where `soft` is below 1. Real time: safe.
    """
    size = abs(x)
    if size <= soft:
        return x
    room = 1.0 - soft
    bent = 1.0 if room <= 0.0 else soft + room * math.tanh((size - soft) / room)
    return bent if x > 0.0 else -bent
