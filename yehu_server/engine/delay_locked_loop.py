"""A delay-locked loop: when an event of a regular series is due, without its jitter. Compiled.

The events are the beginnings of blocks of frames. A loop of second order follows their time and
their rate, so that it has no error left where the rate is constant. Its damping is 1 / sqrt(2).
Source: [Adriaensen], the loop's equations.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.jit import compiled

BANDWIDTH_HZ = 0.3

LOOP = np.dtype(
    [
        ("due_ns", np.int64),  # of the last event, as the loop has it
        ("error_ns", np.int64),  # how much later it came than was predicted
        ("ns_per_frame", np.float64),
    ],
    align=True,
)


@compiled
def start(loop: Any, now_ns: int, rate: float) -> None:
    """Begin with an event at `now_ns`, and a nominal rate (Hz). Real time: safe."""
    loop.due_ns, loop.error_ns, loop.ns_per_frame = now_ns, 0, 1e9 / rate


@compiled
def predicted_ns(loop: Any, frames: int) -> int:
    """When an event is due that comes `frames` after the last one. Real time: safe."""
    return int(loop.due_ns + int(frames * loop.ns_per_frame))


@compiled
def follow(loop: Any, due_ns: int, error_ns: int, frames: int, rate: float) -> None:
    """Take in an event that was predicted for `due_ns` and came `error_ns` later.

    Parameters
    ----------
    frames : int
        Since the event before.
    rate : float, Hz
        The nominal one.

    Real time: safe.
    """
    turn = 2.0 * math.pi * BANDWIDTH_HZ * frames / rate
    loop.due_ns, loop.error_ns = due_ns + int(math.sqrt(2.0) * turn * error_ns), error_ns
    loop.ns_per_frame += turn * turn * error_ns / max(frames, 1)
