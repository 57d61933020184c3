"""A queue of received packets that shares processing time fairly between senders.

The sender that has used least processor time of late is served first, for one slice of time. A
client that floods the server therefore delays only itself; a sender that uses less than its share
is served at once. A long packet is charged beforehand for the time that it may take, and a new
sender is charged as if it had used much, so that neither many long packets nor many new ports
delay a player. Time used by all senders of a host counts for each of them, so that opening more
ports gains nothing. The packets of one sender stay in order.
"""

from __future__ import annotations

import heapq
import itertools
import math
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from yehu_server.live.osc.limits import OVERHEAD_BYTES, MemoryQuota
from yehu_server.live.osc.peers import Peer

MOST_BYTES = 16 << 20  # of all waiting packets
TURN_NS, SLICE_NS = 2_000_000, 500_000  # of one call of `work`, and of one sender's turn in it
USE_HALF_LIFE_NS = 1_000_000_000  # half-life of the time that a sender has used
RESCALE_NS = 500 * USE_HALF_LIFE_NS  # before numbers grow too large
# A packet longer than the first is charged the second beforehand.
LITTLE_BYTES, LONG_TAKES_NS = 1 << 10, 1_000_000_000.0
# A sender is established once it is NEW_SENDER_NS old, until it is silent for SILENT_NS. A new one
# is charged as if it had used the third.
NEW_SENDER_NS, SILENT_NS = 1_000_000_000, 60_000_000_000
NEW_SENDER_USED_NS = 100_000_000.0
MOST_KNOWN, MOST_SENDERS = 256, 2048
GUARANTEED_BYTES = 4 << 10  # for which a known sender always finds room

T = TypeVar("T")


@dataclass(slots=True)
class Work(Generic[T]):
    """A packet to handle, or (None) that its peer hung up; `steps` are what is left of it."""

    thing: T | None
    when: int
    size: int
    steps: Iterator[None] | None = None


@dataclass(slots=True, eq=False)
class Host:
    """The time that all senders of a host have used (ns), weighted by `Backlog._scale`."""

    took: float = 0.0


@dataclass(slots=True, eq=False)
class Sender(Generic[T]):
    """A peer and its waiting packets; times in ns."""

    peer: Peer
    host: Host
    since_ns: int
    heard_ns: int
    took: float  # as in `Host`
    works: deque[Work[T]] = field(default_factory=deque)
    is_known: bool = False
    is_queued: bool = False


class Backlog(Generic[T]):
    """The packets of all peers that wait to be handled.

    Parameters
    ----------
    handle : callable
        Called with a packet, its peer, and the number it was added with; returns an iterator
        whose steps handle it.
    end : callable
        Called with a peer that hung up, once all of its packets are handled.
    most_bytes : int
        Limit on the size of all waiting packets.
    """

    def __init__(
        self,
        handle: Callable[[T, Peer, int], Iterator[None]],
        end: Callable[[Peer], None],
        most_bytes: int = MOST_BYTES,
    ) -> None:
        self._handle = handle
        self._end = end
        self._quota = MemoryQuota(most_bytes)
        self._count = 0
        self._senders: dict[Peer, Sender[T]] = {}
        self._hosts: dict[str, Host] = {}
        self._known: list[Sender[T]] = []
        self._sweep_at = MOST_SENDERS
        self._looked_ns = 0  # when silent senders were last looked for
        # Senders with waiting packets, by time used and expected for the next packet.
        self._queue: list[tuple[float, int, Sender[T]]] = []
        self._order = itertools.count()
        self._began_ns = time.monotonic_ns()

    def __len__(self) -> int:
        return self._count

    def add(
        self, thing: T | None, peer: Peer, when: int, size: int = 0, *, is_due: bool = False
    ) -> bool:
        """Add a packet, or None where the peer hung up; return whether there was room.

        There is always room for the latter, and where `is_due` (its sender is limited otherwise).
        """
        sender = self._sender(peer, time.monotonic_ns())
        size += OVERHEAD_BYTES
        is_owed = sender.is_known and self._quota.of(sender) + size <= GUARANTEED_BYTES
        if not self._quota.take(sender, size, is_due=is_due or is_owed or thing is None):
            return False
        self._count += 1
        sender.works.append(Work(thing, when, size))
        if not sender.is_queued:
            self._enqueue(sender)
        return True

    @property
    def bytes(self) -> int:
        """The size of all waiting packets."""
        return self._quota.taken_bytes

    def bytes_of(self, peer: Peer) -> int:
        """The size of one peer's waiting packets; any thread may call."""
        sender = self._senders.get(peer)
        return 0 if sender is None else self._quota.of(sender)

    def drop(self, which: Callable[[T], bool]) -> None:
        """Drop some waiting packets."""
        for sender in self._senders.values():
            dropped = [
                work for work in sender.works if work.thing is not None and which(work.thing)
            ]
            for work in dropped:
                sender.works.remove(work)
                self._count -= 1
                self._quota.give_back(sender, work.size)

    def clear(self) -> None:
        """Drop all waiting packets."""
        for sender in self._senders.values():
            sender.works.clear()
        self._count = 0
        self._quota.clear()

    def work(self) -> None:
        """Handle waiting packets for up to TURN_NS."""
        until_ns = time.monotonic_ns() + TURN_NS
        while self._queue and time.monotonic_ns() < until_ns:
            _, _, sender = heapq.heappop(self._queue)
            try:
                if sender.works:
                    self._serve(sender)
            finally:
                sender.is_queued = False
                if sender.works:
                    self._enqueue(sender)

    def _enqueue(self, sender: Sender[T]) -> None:
        is_long = sender.works[0].size > LITTLE_BYTES + OVERHEAD_BYTES
        expected_ns = LONG_TAKES_NS if is_long else 0.0
        key = sender.host.took + sender.took + expected_ns * self._scale(time.monotonic_ns())
        heapq.heappush(self._queue, (key, next(self._order), sender))
        sender.is_queued = True

    def _serve(self, sender: Sender[T]) -> None:
        """Handle packets of a sender for up to SLICE_NS; a single one, where other senders wait.

        To measure the time used takes as long as to read a short packet, so it is done once.
        """
        began_ns = time.thread_time_ns()
        until_ns = time.monotonic_ns() + SLICE_NS
        try:
            while self._advance(sender, until_ns) and sender.works and not self._queue:
                pass
        finally:
            took_ns = time.thread_time_ns() - began_ns
            took = took_ns * self._scale(time.monotonic_ns())
            sender.took += took
            sender.host.took += took

    def _advance(self, sender: Sender[T], until_ns: int) -> bool:
        """Handle the next packet of a sender until a time; return whether some is left of that."""
        work = sender.works[0]
        is_done = True  # also after an error: it is not tried again
        try:
            is_done = self._act(work, sender.peer, until_ns)
        finally:
            if is_done and sender.works and sender.works[0] is work:  # not cleared
                sender.works.popleft()
                self._count -= 1
                self._quota.give_back(sender, work.size)
        return is_done and time.monotonic_ns() <= until_ns

    def _act(self, work: Work[T], peer: Peer, until_ns: int) -> bool:
        """Take steps of a packet until a time; return whether it is done."""
        if work.thing is None:
            self._end(peer)
            self._forget(peer)
            return True
        if work.steps is None:
            work.steps = self._handle(work.thing, peer, work.when)
        for _ in work.steps:  # noqa: SIM110 - `all` of a generator takes twice as long
            if time.monotonic_ns() > until_ns:
                return False
        return True

    def _scale(self, now_ns: int) -> float:
        """Weight of a nanosecond used now: it grows, so that earlier ones count less.

        Scaling new values up and not old ones down keeps the order of those that wait.
        """
        passed_ns = now_ns - self._began_ns
        if passed_ns > RESCALE_NS:
            factor = 0.5 ** (passed_ns / USE_HALF_LIFE_NS)
            for sender in self._senders.values():
                sender.took *= factor
            for host in self._hosts.values():
                host.took *= factor
            self._queue = [(key * factor, order, sender) for key, order, sender in self._queue]
            self._began_ns, passed_ns = now_ns, 0
        return math.pow(2.0, passed_ns / USE_HALF_LIFE_NS)

    # -- senders -------------------------------------------------------------------------------

    def _sender(self, peer: Peer, now_ns: int) -> Sender[T]:
        sender = self._senders.get(peer)
        if sender is None:
            if len(self._senders) >= self._sweep_at:
                self._sweep()
            took = NEW_SENDER_USED_NS * self._scale(now_ns)
            host = self._hosts.setdefault(peer.host, Host())
            sender = self._senders[peer] = Sender(peer, host, now_ns, now_ns, took)
        elif not sender.is_known and now_ns - sender.since_ns > NEW_SENDER_NS:
            self._know(sender, now_ns)
        sender.heard_ns = now_ns
        return sender

    def _know(self, sender: Sender[T], now_ns: int) -> None:
        """Count a sender among the known ones, if there is a place."""
        if len(self._known) >= MOST_KNOWN and now_ns - self._looked_ns > NEW_SENDER_NS:
            self._looked_ns = now_ns
            for one in self._known:
                one.is_known = now_ns - one.heard_ns < SILENT_NS
            self._known = [one for one in self._known if one.is_known]
        if len(self._known) < MOST_KNOWN:
            sender.is_known = True
            self._known.append(sender)

    def _forget(self, peer: Peer) -> None:
        sender = self._senders.pop(peer)
        if sender.is_known:
            self._known.remove(sender)

    def _sweep(self) -> None:
        """Forget unknown senders that have no waiting packets."""
        self._senders = {
            peer: sender
            for peer, sender in self._senders.items()
            if sender.works or sender.is_known
        }
        hosts = {peer.host for peer in self._senders}
        self._hosts = {name: host for name, host in self._hosts.items() if name in hosts}
        self._sweep_at = max(MOST_SENDERS, 2 * len(self._senders))
