"""A quota of memory that several peers share."""

from __future__ import annotations

from typing import Any, Protocol

OVERHEAD_BYTES = 256  # memory for a stored packet beside its own bytes
LITTLE_BYTES = 4 << 10  # for which a peer finds room beside greedy ones
# What a host, and a peer and its host together, may hold for each byte that stays free.
HOST_TO_FREE_FOR_LITTLE, BOTH_TO_FREE = 4, 2


class Owner(Protocol):
    """A peer that memory is kept for."""

    @property
    def host(self) -> str:
        """IP address of its host."""


class MemoryQuota:
    """A number of bytes for all peers: how much each may hold depends on how much is free.

    A peer alone gets half of it, and the peers of one host together two thirds. A peer that holds
    little finds room beside many of its own host that hold all they can: they get four fifths
    then. There is always some for another host.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most_bytes = most_bytes
        self._by_peer: dict[Owner, int] = {}
        self._by_host: dict[str, int] = {}
        self.taken_bytes = 0

    def of(self, peer: Owner) -> int:
        """Bytes that a peer holds; any thread may call."""
        return self._by_peer.get(peer, 0)

    def take(self, peer: Owner, size: int, *, always: bool = False) -> bool:
        """Take bytes for a peer; return whether there were enough (with `always` there are)."""
        of_peer, of_host = self.of(peer) + size, self._by_host.get(peer.host, 0) + size
        free = self._most_bytes - self.taken_bytes - size
        if of_peer <= LITTLE_BYTES:
            fits = of_host <= HOST_TO_FREE_FOR_LITTLE * free
        else:
            fits = of_peer + of_host <= BOTH_TO_FREE * free
        if fits or always:
            self._add(peer, size)
        return fits or always

    def give_back(self, peer: Owner, size: int) -> None:
        """Give back bytes of a peer."""
        self._add(peer, -size)

    def _add(self, peer: Owner, size: int) -> None:
        self.taken_bytes += size
        _count(self._by_peer, peer, size)
        _count(self._by_host, peer.host, size)


def _count(held: dict[Any, int], owner: object, size: int) -> None:
    """Add to what an owner holds; one that holds nothing is not kept."""
    held[owner] = held.get(owner, 0) + size
    if not held[owner]:
        del held[owner]
