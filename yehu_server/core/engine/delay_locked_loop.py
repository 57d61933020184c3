"""A delay-locked loop: times of regular events without their jitter. Compiled.

The events are the starts of blocks of frames. The loop is of second order: it follows time and
rate, so that a constant rate leaves no error. Its damping ratio is 1 / sqrt(2).
Source: [Adriaensen], the loop's equations.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled

BANDWIDTH_HZ = 0.3

LOOP = np.dtype(
    [
        ("due_ns", np.int64),  # time of the last event, filtered
        ("error_ns", np.int64),  # its time less the predicted one
        ("ns_per_frame", np.float64),
    ],
    align=True,
)


@compiled
def start(loop: Any, now_ns: int, rate: float) -> None:
    """Start at an event at `now_ns`, with the nominal rate (Hz). Real time: safe."""
    loop.due_ns, loop.error_ns, loop.ns_per_frame = now_ns, 0, 1e9 / rate


@compiled
def predicted_ns(loop: Any, frames: int) -> int:
    """Predict the time of an event `frames` after the last one. Real time: safe."""
    return int(loop.due_ns + int(frames * loop.ns_per_frame))


@compiled
def follow(loop: Any, due_ns: int, error_ns: int, frames: int, rate: float) -> None:
    """Update the loop with an event `error_ns` after it was due. Real time: safe.

    `frames` since the event before, `rate` (Hz) the nominal one.
    """
    turn = 2.0 * math.pi * BANDWIDTH_HZ * frames / rate
    loop.due_ns, loop.error_ns = due_ns + int(math.sqrt(2.0) * turn * error_ns), error_ns
    loop.ns_per_frame += turn * turn * error_ns / max(frames, 1)
