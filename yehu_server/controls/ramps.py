"""Ramps of the engine's parameters. Compiled."""

from __future__ import annotations

import math
from typing import Any

from yehu_server.controls.slots import HIGHEST, LOWEST, SILENCE, SLOTS
from yehu_server.jit import compiled


@compiled
def take(c: Any, index: int, target: float, ramp: int) -> None:
    """Begin a parameter's ramp to a target, clamped to its range.

    A target that is not a number is ignored. Real time: safe.

    Parameters
    ----------
    index : int
        Slot of the parameter, or SILENCE.
    ramp : int
        Length of the ramp (frames).
    """
    if index == SILENCE:
        if c.silence_in == 0:
            c.silence_in = c.fade
        return
    if index < 0 or index >= SLOTS or math.isnan(target):
        return
    target = min(max(target, LOWEST[index]), HIGHEST[index])
    c.target[index] = target
    c.moving -= 1 if c.remaining[index] > 0 else 0
    if ramp <= 0:
        c.value[index] = target
        c.remaining[index] = 0
    else:
        c.slope[index] = (target - c.value[index]) / ramp
        c.remaining[index] = ramp
        c.moving += 1


@compiled
def move(c: Any) -> None:
    """Advance all ramps by one sample; each ends exactly on its target. Real time: safe."""
    if c.moving == 0:
        return
    for index in range(SLOTS):
        if c.remaining[index] > 0:
            c.remaining[index] -= 1
            if c.remaining[index] == 0:
                c.value[index] = c.target[index]
                c.moving -= 1
            else:
                c.value[index] += c.slope[index]
