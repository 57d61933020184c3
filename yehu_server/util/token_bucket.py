"""Limit how often something may be done: a token bucket."""

import math


class TokenBucket:
    """A token bucket, full at first. Times are those of ``time.monotonic()``.

    `per_s`: tokens added a second.
    `at_once`: tokens that the bucket holds.
    """

    def __init__(self, per_s: float, at_once: float) -> None:
        self._per_s = per_s
        self._at_once = self._left = at_once
        self._updated = math.inf  # never yet

    def resize(self, at_once: float) -> None:
        """Hold other many tokens."""
        self._at_once = at_once

    def left(self, now: float) -> float:
        """The number of tokens at a time."""
        gained = self._per_s * max(now - self._updated, 0.0)
        self._left = min(self._left + gained, self._at_once)
        self._updated = now
        return self._left

    def spend(self, count: float) -> None:
        """Take tokens, also more than there are: the debt is paid first."""
        self._left -= count

    def takes(self, now: float) -> bool:
        """Take one token if there is one; return whether there was."""
        if self.left(now) < 1.0:
            return False
        self.spend(1.0)
        return True
