"""How often something may be done."""

from __future__ import annotations

import math


class Allowance:
    """So many at once, and so many more with each second that passes (a token bucket)."""

    def __init__(self, per_s: float, at_once: float) -> None:
        self._per_s = per_s
        self._at_once = self._left = at_once
        self._looked = -math.inf

    def takes(self, now: float) -> bool:
        """Whether there is one left at a moment (monotonic s); then it is taken."""
        gained = self._per_s * (now - self._looked)
        self._left = min(self._left + gained, self._at_once)
        self._looked = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True
