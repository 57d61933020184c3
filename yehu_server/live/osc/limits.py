"""Limits: on memory that several owners share, and on how often something is done."""

from __future__ import annotations

import math
from typing import Any

OVERHEAD_BYTES = 256  # memory for a stored packet beside its own bytes


class MemoryQuota:
    """A number of bytes for all owners: each may hold at most as much as is still free.

    A single owner gets half of it, two get a third each; there is always some for another one.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most_bytes = most_bytes
        self._owned: dict[Any, int] = {}
        self.taken_bytes = 0

    def of(self, owner: Any) -> int:
        """Bytes that an owner holds; any thread may call."""
        return self._owned.get(owner, 0)

    def take(self, owner: Any, size: int, *, is_due: bool = False) -> bool:
        """Take bytes for an owner; return whether there were enough (with `is_due` always)."""
        owned = self._owned.get(owner, 0) + size
        if not is_due and owned > self._most_bytes - self.taken_bytes:
            return False
        self._owned[owner] = owned
        self.taken_bytes += size
        return True

    def give_back(self, owner: Any, size: int) -> None:
        """Give back bytes of an owner."""
        self.taken_bytes -= size
        left = self._owned[owner] - size
        if left:
            self._owned[owner] = left
        else:
            del self._owned[owner]

    def clear(self) -> None:
        """Give back all bytes."""
        self._owned.clear()
        self.taken_bytes = 0


class TokenBucket:
    """A token bucket, full at first. Times are those of ``time.monotonic()``.

    Parameters
    ----------
    per_s : float
        Tokens added a second.
    at_once : float
        Tokens that the bucket holds.
    """

    def __init__(self, per_s: float, at_once: float) -> None:
        self._per_s = per_s
        self._at_once = self._left = at_once
        self._looked = -math.inf

    def left(self, now: float) -> float:
        """The number of tokens at a time."""
        gained = self._per_s * (now - self._looked)
        self._left = min(self._left + gained, self._at_once)
        self._looked = now
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
