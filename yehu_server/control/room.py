"""A limit on memory that several owners share."""

from __future__ import annotations

from typing import Any

OVERHEAD_BYTES = 256  # memory for a stored packet beside its own bytes


class Room:
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
