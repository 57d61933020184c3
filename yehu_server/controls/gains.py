"""Gains of the output at each sample. Compiled."""

from __future__ import annotations

from typing import Any

from yehu_server.controls.slots import BALANCE, GAIN, LEVEL
from yehu_server.jit import compiled

FULL_SCALE_PRESSURE = 1.0  # Pa at full scale with no gain. By ear.
TO_OUTPUT, TO_BODY, TO_LIMITER = range(3)  # gains that are set in decibels
DECIBELS = 3


@compiled
def amplitude(c: Any, of: int, decibels: float) -> float:
    """Convert decibels to an amplitude factor, computed only when they change."""
    if decibels != c.decibels[of]:
        c.decibels[of], c.factor[of] = decibels, 10.0 ** (decibels / 20.0)
    return float(c.factor[of])


@compiled
def level(c: Any) -> float:
    """Gain from pascals to full scale at this sample."""
    factor = amplitude(c, TO_OUTPUT, c.value[GAIN] + c.value[BALANCE])
    return float(c.value[LEVEL] * factor / FULL_SCALE_PRESSURE)
