"""Ramps of the engine's parameters, and the gains and tunings that follow them. Compiled."""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.controls.slots import LOSS, LOWER_BOUNDS, SILENCE, SLOT_COUNT, SLOTS, TUNING
from yehu_server.core.physics.elementary import exp, exp10
from yehu_server.core.physics.layout import STRINGS


def pole_of_time(seconds: float, rate: float) -> float:
    """Pole of the filter with a time constant (s), at a sample rate (Hz)."""
    return exp(-1.0 / (seconds * rate))


def pole_of_cutoff(frequency: float, rate: float) -> float:
    """Pole of the filter with a cutoff frequency (Hz) far below the sample rate (Hz)."""
    return exp(-2.0 * math.pi * frequency / rate)


@compiled
def one_pole(y: float, x: float, a: float) -> float:
    """The next output, of the last, the input, and 1 less the pole (0: held). Real time: safe."""
    return y + a * (x - y)


@compiled
def start_ramp(c: Any, slot: int, target: float, ramp: int) -> None:
    """Begin the ramp (frames) of a slot, or SILENCE, to a target, clamped to its range.

    A target that is not a number is ignored. Real time: safe.
    """
    if slot == SILENCE:
        if c.silence_in == 0:
            c.silence_in = c.fade
        return
    if slot < 0 or slot >= SLOT_COUNT or math.isnan(target):
        return
    target = min(max(target, LOWER_BOUNDS[slot]), c.upper_bounds[slot])
    c.target[slot] = target
    if ramp <= 0:
        c.value[slot] = target
        c.remaining[slot] = 0
        return
    c.slope[slot] = (target - c.value[slot]) / ramp
    c.remaining[slot] = ramp
    if c.is_moving[slot] == 0:
        c.is_moving[slot] = 1
        c.moving[np.uint64(c.moving_count)] = slot
        c.moving_count += 1


@compiled
def advance_ramps(c: Any) -> None:
    """Advance all ramps by one sample; each ends exactly on its target. Real time: safe."""
    at = np.uint64(0)
    while at < np.uint64(c.moving_count):
        slot = np.uint64(c.moving[at])
        left = c.remaining[slot] - 1
        if left > 0:
            c.remaining[slot] = left
            c.value[slot] += c.slope[slot]
            at += np.uint64(1)
            continue
        if left == 0:  # else a jump ended the ramp
            c.value[slot] = c.target[slot]
        c.remaining[slot], c.is_moving[slot] = 0, 0
        c.moving_count -= 1
        c.moving[at] = c.moving[np.uint64(c.moving_count)]


FULL_SCALE_PRESSURE = 1.0  # Pa at full scale with no gain. By ear.
TO_OUTPUT, TO_BODY, TO_LIMITER = range(3)  # gains that are set in decibels
GAIN_COUNT = 3


@compiled
def amplitude(c: Any, of: int, decibels: float) -> float:
    """Convert decibels to an amplitude factor, computed only when they change."""
    if decibels != c.decibels[of]:
        c.decibels[of], c.factor[of] = decibels, exp10(decibels / 20.0)
    return float(c.factor[of])


@compiled
def level(c: Any) -> float:
    """Gain from pascals to full scale at this sample."""
    factor = amplitude(c, TO_OUTPUT, c.value[SLOTS.output_gain] + c.value[SLOTS.output_balance])
    return float(c.value[SLOTS.output_level] * factor / FULL_SCALE_PRESSURE * (1.0 + c.swell))


@compiled
def has_new_strings(c: Any) -> bool:
    """Whether the tuning or loss of a string differs from what the model has."""
    for i in range(STRINGS):
        if c.value[TUNING[i]] != c.tuning[i] or c.value[LOSS[i]] != c.loss[i]:
            return True
    return False
