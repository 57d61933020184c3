"""Drift and tremor of the hands, from one sample to the next. Compiled.

The player sets their slopes (`yehu_server.core.player.drift`).
"""

from __future__ import annotations

import math
from typing import Any

from yehu_server.compile.jit import compiled

# Factors less 1 on the bow's speed, its force and its distance from the bridge; cents by which
# the fingers are too high; a factor less 1 on their force.
SPEED, FORCE, PLACE, CENTS, PRESS = range(5)
DRIFTS = 5
# A contact that moves costs more than one that stands, so places follow every so many samples, by
# steps of some thousandths of a cent.
EVERY = 16
PER_CENT = math.log(2.0) / 1200.0


@compiled
def advance(c: Any) -> None:
    """Advance what drifts by one sample. Real time: safe."""
    if c.drifting == 0:
        return
    for i in range(DRIFTS):
        c.drift[i] += c.drift_slope[i]
    if c.frame % EVERY == 0:
        raised = c.drift[CENTS] * PER_CENT
        c.sounding_drift = 1.0 - raised + 0.5 * raised * raised
        c.place_drift = 1.0 + c.drift[PLACE]
