"""Numbers by chance, and the noise of the hair's grip. Compiled."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.controls.one_pole import one_pole
from yehu_server.controls.slots import NOISE
from yehu_server.jit import compiled


@compiled
def chance(frame: int) -> float:
    """A pseudorandom number in -1..1, the same for the same frame.

    Source: [SplitMix], its output function.
    """
    x = np.uint64(frame) * np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    x = x ^ (x >> np.uint64(31))
    return float(x >> np.uint64(11)) * 2.0**-52 - 1.0


@compiled
def grip(c: Any) -> float:
    """Factor of the bow force at this sample, about 1: noise of the hair."""
    noise = c.value[NOISE]
    if noise == 0.0:
        return 1.0
    c.grain = one_pole(c.grain, c.grain_size * chance(c.frame), c.grain_follow)
    return float(max(0.0, 1.0 + noise * c.grain))
