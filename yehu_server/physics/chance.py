"""Numbers by chance, the same for the same argument. Compiled."""

from __future__ import annotations

import numpy as np

from yehu_server.jit import compiled


@compiled
def chance(number: int) -> float:
    """A pseudorandom number in -1..1, the same for the same `number`.

    Source: [SplitMix], its output function.
    """
    x = np.uint64(number) * np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    x = x ^ (x >> np.uint64(31))
    return float(x >> np.uint64(11)) * 2.0**-52 - 1.0
