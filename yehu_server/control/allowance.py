"""How often, or how much of, something may be done."""

from __future__ import annotations

import math


class Allowance:
    """A token bucket: `at_once` may be spent at any moment, and `per_s` is gained each second.

    It begins full. Moments are seconds of ``time.monotonic()``.
    """

    def __init__(self, per_s: float, at_once: float) -> None:
        self._per_s = per_s
        self._at_once = self._left = at_once
        self._looked = -math.inf

    def left(self, now: float) -> float:
        """What may be spent at a moment."""
        gained = self._per_s * (now - self._looked)
        self._left = min(self._left + gained, self._at_once)
        self._looked = now
        return self._left

    def spend(self, count: float) -> None:
        """Take some; more than is left has to be gained again before there is any."""
        self._left -= count

    def takes(self, now: float) -> bool:
        """Whether there is one left at a moment; then it is taken."""
        if self.left(now) < 1.0:
            return False
        self.spend(1.0)
        return True
