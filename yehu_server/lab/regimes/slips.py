"""When the hair slips, and since when it slips once a period. Compiled."""

from __future__ import annotations

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.ear import SLIPPING, STICKING

Array = Any

LASTING = 10  # slips, one a period, after which Helmholtz motion is said to have begun
REGULAR = 0.08  # of a period, by which their distances may be off; [Guettler]
LEAST_SLIP = 0.3  # of the bow's speed; in Helmholtz motion a slip is 1 / beta of it
LEAST_SPEED = 0.02  # m/s; as the bow sets off the bristles bend, which is no slip
FADING = 8.0  # periods after which a large slip no longer hides smaller ones


@compiled_exactly
def rectify(relative_velocity: Array, bow_velocity: Array, frames: int, to: Array) -> None:
    """Write how fast the string slips back under the hair, against the bow's direction; else 0."""
    for i in range(frames):
        back = -relative_velocity[i] if bow_velocity[i] >= 0.0 else relative_velocity[i]
        to[i] = max(0.0, back)


@compiled_exactly
def times_of_slips(
    slipping: Array, bow_velocity: Array, frames: int, period: float
) -> tuple[int, int]:
    """The frames of the first slip, and of the slip from which LASTING follow one a period.

    A slip begins and ends as the player's ear has it, relative to the largest of late. `slipping`
    is as of `rectify`, the period (samples) that of the note. Returns frames, -1 for never.
    """
    fade = math.exp(-1.0 / (FADING * period))
    largest, is_slipping = 0.0, False
    first, last, begun, regular = -1, -1, -1, 0
    for i in range(frames):
        size = slipping[i]
        largest = max(size, largest * fade)
        least = max(SLIPPING * largest, LEAST_SLIP * abs(bow_velocity[i]), LEAST_SPEED)
        if is_slipping:
            is_slipping = size > STICKING / SLIPPING * least
        elif size > least and bow_velocity[i] != 0.0:
            is_slipping = True
            if first < 0:
                first = i
            if last >= 0 and abs((i - last) / period - 1.0) < REGULAR:
                regular += 1
                if regular == LASTING:
                    return first, begun
            else:
                regular, begun = 0, i
            last = i
    return first, -1
