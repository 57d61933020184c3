"""The limiter of the mix: peaks are bent, so that nothing exceeds full scale. Compiled."""

from __future__ import annotations

import math

from yehu_server.compile.jit import compiled

# A sample beyond these is an error: rounding takes the limiter's hardly beyond 1.
LARGEST, LARGEST_LIMITED = 1e14, 2.0


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


@compiled
def is_valid(sample: float, limited: float) -> bool:
    """Whether a sample, and what the limiter made of it, are numbers of any use; NaN is not."""
    return abs(sample) <= LARGEST and abs(limited) <= LARGEST_LIMITED
