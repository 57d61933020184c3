"""A queue of received packets that shares processing time fairly between their senders.

Each peer has a queue of its own, which is served for a slice of time when it is the peer's turn.
Peers stand in three lines: those with little waiting, those with much, and those with a long
packet. The lines take turns, in a line the hosts, and of a host the peers. So who sends little is
served within a few slices, whoever floods; more ports gain a host nothing; and nobody waits for
ever. The packets of one peer stay in order.
"""

from __future__ import annotations

import time
from collections import OrderedDict, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from yehu_server.live.osc.answering import Peer

OVERHEAD_BYTES = 256  # memory for a stored packet beside its own bytes
LITTLE_BYTES = 4 << 10  # for which a peer finds room beside greedy ones
# What a host, and a peer and its host together, may hold for each byte that stays free.
HOST_TO_FREE_FOR_LITTLE, BOTH_TO_FREE = 4, 2


class MemoryQuota:
    """A number of bytes for all peers: how much each may hold depends on how much is free.

    A peer alone gets half of it, and the peers of one host together two thirds. A peer that holds
    little finds room beside many of its own host that hold all they can: they get four fifths
    then. There is always some for another host.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most_bytes = most_bytes
        self._by_peer: dict[Peer, int] = {}
        self._by_host: dict[str, int] = {}
        self.taken_bytes = 0

    def of(self, peer: Peer) -> int:
        """Bytes that a peer holds; any thread may call."""
        return self._by_peer.get(peer, 0)

    def of_both(self, peer: Peer) -> int:
        """Bytes that a peer holds, and those of all of its host, added."""
        return self.of(peer) + self._by_host.get(peer.host, 0)

    def take(self, peer: Peer, size: int, *, always: bool = False) -> bool:
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

    def give_back(self, peer: Peer, size: int) -> None:
        """Give back bytes of a peer."""
        self._add(peer, -size)

    def _add(self, peer: Peer, size: int) -> None:
        self.taken_bytes += size
        _count(self._by_peer, peer, size)
        _count(self._by_host, peer.host, size)


def _count(held: dict[Any, int], owner: object, size: int) -> None:
    """Add to what an owner holds; one that holds nothing is not kept."""
    held[owner] = held.get(owner, 0) + size
    if not held[owner]:
        del held[owner]


MOST_BYTES = 16 << 20  # of all waiting packets
TURN_NS, SLICE_NS = 2_000_000, 500_000  # of one call of `work`, and of one peer's turn in it
LONG_BYTES = 1 << 10  # a packet is long that is longer

T = TypeVar("T")


@dataclass(slots=True)
class Work(Generic[T]):
    """A packet to handle; `steps` are what is left of it."""

    thing: T
    when: int
    size: int
    steps: Iterator[None] | None = None


class RoundRobin:
    """Peers in turn: one of each host, and the peers of a host one after another."""

    def __init__(self) -> None:
        self._hosts: OrderedDict[str, deque[Peer]] = OrderedDict()

    def __bool__(self) -> bool:
        return bool(self._hosts)

    def append(self, peer: Peer) -> None:
        """Put a peer behind the others of its host."""
        self._hosts.setdefault(peer.host, deque()).append(peer)

    def popleft(self) -> Peer:
        """Remove and return the peer whose turn it is."""
        host, peers = self._hosts.popitem(last=False)
        peer = peers.popleft()
        if peers:
            self._hosts[host] = peers
        return peer


class FairQueue(Generic[T]):
    """The packets of all peers that wait to be handled.

    `handle`: called with a packet, its peer, and the number it was added with; returns an iterator
    whose steps handle it.
    `most_bytes`: limit on the size of all waiting packets.
    """

    def __init__(
        self, handle: Callable[[T, Peer, int], Iterator[None]], most_bytes: int = MOST_BYTES
    ) -> None:
        self._handle = handle
        self._quota = MemoryQuota(most_bytes)
        self._works: dict[Peer, deque[Work[T]]] = {}  # of peers that have any
        self._lines = RoundRobin(), RoundRobin(), RoundRobin()
        self._turn = -1  # the line that was served last

    def __bool__(self) -> bool:
        return bool(self._works)

    def __len__(self) -> int:
        return sum(map(len, self._works.values()))

    @property
    def bytes(self) -> int:
        """The size of all waiting packets."""
        return self._quota.taken_bytes

    def bytes_of(self, peer: Peer) -> int:
        """The size of one peer's waiting packets; any thread may call."""
        return self._quota.of(peer)

    def bytes_of_both(self, peer: Peer) -> int:
        """The size of one peer's waiting packets, and of all of its host, added."""
        return self._quota.of_both(peer)

    def add(self, thing: T, peer: Peer, when: int, size: int = 0, *, always: bool = False) -> bool:
        """Add a packet; return whether there was room.

        With `always` there is: for a peer that is limited otherwise.
        """
        size += OVERHEAD_BYTES
        if not self._quota.take(peer, size, always=always):
            return False
        work = Work(thing, when, size)
        if peer in self._works:
            self._works[peer].append(work)
        else:
            self._works[peer] = deque([work])
            self._line_up(peer)
        return True

    def drop(self, which: Callable[[T], bool]) -> None:
        """Drop some waiting packets."""
        for peer, works in self._works.items():
            for _ in range(len(works)):
                work = works.popleft()
                if which(work.thing):
                    self._quota.give_back(peer, work.size)
                else:
                    works.append(work)

    def clear(self) -> None:
        """Drop all waiting packets."""
        self.drop(lambda _thing: True)

    def work(self) -> None:
        """Handle waiting packets for up to TURN_NS."""
        until_ns = time.monotonic_ns() + TURN_NS
        while self._works and time.monotonic_ns() < until_ns:
            peer = self._next()
            try:
                self._serve(peer, self._works[peer])
            finally:
                if self._works[peer]:
                    self._line_up(peer)
                else:
                    del self._works[peer]

    def _line_up(self, peer: Peer) -> None:
        """Put a peer into the line for what it has waiting."""
        is_long = self._works[peer][0].size > LONG_BYTES + OVERHEAD_BYTES
        has_much = self._quota.of(peer) > LITTLE_BYTES
        self._lines[2 if is_long else has_much].append(peer)

    def _next(self) -> Peer:
        """Take the peer whose turn it is out of its line."""
        while True:
            self._turn = (self._turn + 1) % len(self._lines)
            if self._lines[self._turn]:
                return self._lines[self._turn].popleft()

    def _serve(self, peer: Peer, works: deque[Work[T]]) -> None:
        """Handle packets of a peer for up to SLICE_NS.

        A packet that fails has no more steps, so it is gone with the peer's next turn.
        """
        until_ns = time.monotonic_ns() + SLICE_NS
        while works and time.monotonic_ns() <= until_ns:
            work = works[0]
            if work.steps is None:
                work.steps = self._handle(work.thing, peer, work.when)
            for _ in work.steps:
                if time.monotonic_ns() > until_ns:
                    return
            if works and works[0] is work:  # not dropped
                works.popleft()
                self._quota.give_back(peer, work.size)
