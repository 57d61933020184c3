"""Room in memory that many share."""

from __future__ import annotations

from typing import Any

OVERHEAD_BYTES = 256  # of a small thing that is kept, beside its own bytes


class Room:
    """So many bytes for all. One owner gets no more than is left for the others after it.

    So one alone has half of it, two have a third each, and there is always some for the next.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most_bytes = most_bytes
        self._owned: dict[Any, int] = {}
        self.taken_bytes = 0

    def of(self, owner: Any) -> int:
        """What one owner has taken, in bytes; any thread may ask."""
        return self._owned.get(owner, 0)

    def take(self, owner: Any, size: int, *, is_due: bool = False) -> bool:
        """Take some; return whether there was enough. There is for what is due to an owner."""
        owned = self._owned.get(owner, 0) + size
        if not is_due and owned > self._most_bytes - self.taken_bytes:
            return False
        self._owned[owner] = owned
        self.taken_bytes += size
        return True

    def give_back(self, owner: Any, size: int) -> None:
        """Give back what was taken."""
        self.taken_bytes -= size
        left = self._owned[owner] - size
        if left:
            self._owned[owner] = left
        else:
            del self._owned[owner]

    def clear(self) -> None:
        """All is given back."""
        self._owned.clear()
        self.taken_bytes = 0
