"""What has come and is still to be done: in order, and one's long work not before others' short."""

from __future__ import annotations

import time
from collections import OrderedDict, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from yehu_server.control.peers import Peer

TURN_NS = 1_000_000
OLD_NS = 50_000_000  # who waits so long is kept waiting by somebody


@dataclass(slots=True)
class Work:
    """A packet, or the end of its peer; `steps` are what is left of one that has begun."""

    packet: bytes | None
    peer: Peer
    arrived_ns: int
    steps: Iterator[None] | None = None


class Backlog:
    """Packets of all peers, handled in the order in which they came.

    But who sends more than can be handled waits for it alone: a packet that takes longer than
    a turn is put aside, with what its peer says after it, and so are packets that have grown old.
    Of those that are put aside each peer gets one turn after another, while others are
    handled at once. What one peer says keeps its order always.

    Parameters
    ----------
    handle : callable
        Gives the steps that a packet takes, in between which others may be handled.
    end : callable
        A peer has hung up, and all it said is done.
    """

    def __init__(
        self,
        handle: Callable[[bytes, Peer, int], Iterator[None]],
        end: Callable[[Peer], None],
    ) -> None:
        self._handle = handle
        self._end = end
        self._queue: deque[Work] = deque()
        self._aside: OrderedDict[Peer, deque[Work]] = OrderedDict()  # the next one first
        self._count = 0
        self.bytes = 0

    def __len__(self) -> int:
        return self._count

    def add(self, packet: bytes | None, peer: Peer, arrived_ns: int) -> None:
        """Keep a packet, or None where the peer has hung up."""
        self._count += 1
        self.bytes += len(packet or b"")
        self._queue.append(Work(packet, peer, arrived_ns))

    def work(self) -> None:
        """Handle some of it: a turn of what came in order, and one of what was put aside."""
        now_ns = time.monotonic_ns()
        until_ns = now_ns + TURN_NS
        while self._queue and time.monotonic_ns() < until_ns:
            work = self._queue.popleft()
            if work.peer in self._aside or 0 < work.arrived_ns < now_ns - OLD_NS:
                self._aside.setdefault(work.peer, deque()).append(work)
            elif not self._do(work):
                self._aside[work.peer] = deque([work])
        if self._aside:
            self._work_aside()

    def _work_aside(self) -> None:
        until_ns = time.monotonic_ns() + TURN_NS
        while self._aside and time.monotonic_ns() < until_ns:
            peer, works = self._aside.popitem(last=False)
            try:
                while works and time.monotonic_ns() < until_ns:
                    work = works.popleft()
                    if not self._do(work):
                        works.appendleft(work)
            finally:
                if works:
                    self._aside[peer] = works  # behind the others

    def _do(self, work: Work) -> bool:
        """Handle a packet for a turn; return whether it is done."""
        is_done = True  # also where it goes wrong: it is not tried again
        try:
            is_done = self._advance(work)
        finally:
            if is_done:
                self._count -= 1
                self.bytes -= len(work.packet or b"")
        return is_done

    def _advance(self, work: Work) -> bool:
        if work.packet is None:
            self._end(work.peer)
            return True
        until_ns = time.monotonic_ns() + TURN_NS
        if work.steps is None:
            work.steps = self._handle(work.packet, work.peer, work.arrived_ns)
        return all(time.monotonic_ns() <= until_ns for _ in work.steps)
