"""The pitch tracker: SwiftF0, a small network whose weights come with its package.

docs/follow.md compares it with others. Source: [SwiftF0].
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from yehu_server.following.recording import RATE
from yehu_server.util.extras import need

Array = Any

PERIOD_S = 0.016  # between two estimates


@dataclass(frozen=True)
class Estimates:
    """Pitches (Hz) and how sure they are (0 to 1), one each PERIOD_S: ndarrays [shape=(times,)]."""

    pitch_hz: Array
    certainty: Array


class Tracker(Protocol):
    """Estimates the pitch of a sound that comes in blocks; the first estimate is of its start."""

    def push(self, samples: Array) -> Estimates:
        """Take samples at RATE; return the estimates that are final now."""
        ...

    def finish(self) -> Estimates:
        """Return the estimates that were held back."""
        ...


class SwiftTracker:
    """Estimates pitches from 47 to 2093 Hz by SwiftF0; raises ParameterError without that."""

    def __init__(self) -> None:
        need_follow()
        from swift_f0 import SwiftF0

        # One thread: more give the same, and a pool that spins takes the cores of the rendering.
        self._stream = SwiftF0(threads=1, spin=False).stream()

    def push(self, samples: Array) -> Estimates:
        """Take samples at RATE; return the estimates that are final now."""
        found = self._stream.push(samples, RATE)
        return Estimates(found.pitch_hz, found.confidence)

    def finish(self) -> Estimates:
        """Return the estimates that were held back."""
        found = self._stream.flush()
        return Estimates(found.pitch_hz, found.confidence)


def need_follow(what: str = "to follow a recording") -> None:
    """Check that the libraries of the extra are there; raises ParameterError."""
    need("swift_f0", what, "follow")
    need("soxr", what, "follow")


def at_times(estimates: Estimates, times_s: Array) -> tuple[Array, Array]:
    """Pitch (Hz) and certainty [shape=(times,)] at times, interpolated within one note."""
    place = np.asarray(times_s) / PERIOD_S
    last = len(estimates.pitch_hz) - 1
    below = np.clip(np.floor(place).astype(np.int64), 0, last)
    above = np.minimum(below + 1, last)
    part = np.clip(place - below, 0.0, 1.0)
    low, high = np.log2(estimates.pitch_hz[below]), np.log2(estimates.pitch_hz[above])
    is_one = np.abs(high - low) < 1.0 / 12.0
    nearest = np.where(part < 0.5, low, high)
    pitch = np.where(is_one, low + part * (high - low), nearest)
    certainty = estimates.certainty[below]
    certainty = certainty + part * (estimates.certainty[above] - certainty)
    return 2.0**pitch, certainty
