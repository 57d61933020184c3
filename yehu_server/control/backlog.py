"""What has come and is still to be done: nobody's long work before others' short.

Senders are served promptly as long as they say little that takes little: all in the order in
which it came, and those who have been here for a while before strangers. Whoever says more is put
aside: each of these gets one turn after another, while the others are served. So what many
strangers send at a time, or one without an end, is late for them alone. What one sender says keeps
its order.
"""

from __future__ import annotations

import time
from collections import OrderedDict, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from yehu_server.control.peers import Peer
from yehu_server.control.room import OVERHEAD_BYTES, Room

MOST_BYTES = 16 << 20  # that wait
TURN_NS = 1_000_000  # for each of those served promptly, strangers, and those put aside
# What a sender may say promptly: small packets, few at once, a tenth of the time.
LITTLE_BYTES = 1 << 10
FEW = 32
SPENT_AT_ONCE_NS, SHARE = 5_000_000, 0.1
# Who has been heard for so long is no stranger, until it has been silent for longer.
STRANGE_NS, FORGOTTEN_NS = 1_000_000_000, 60_000_000_000
MOST_KNOWN, MOST_SENDERS = 256, 2048
OWED_BYTES = 4 << 10  # room that one who is known always finds

T = TypeVar("T")


@dataclass(slots=True)
class Work(Generic[T]):
    """A thing to be handled, or the end of its peer; `steps` are what is left once begun."""

    thing: T | None
    when: int
    size: int
    steps: Iterator[None] | None = None


@dataclass(slots=True, eq=False)
class Sender(Generic[T]):
    """One peer, and what it is still to be served; times in ns."""

    peer: Peer
    since_ns: int
    heard_ns: int
    works: deque[Work[T]] = field(default_factory=deque)
    prompts: int = 0  # turns that wait for it among those who are served promptly
    may_spend_ns: float = SPENT_AT_ONCE_NS
    spent_ns: int = 0  # when `may_spend_ns` was
    is_known: bool = False
    is_aside: bool = False

    def spend(self, took_ns: int, now_ns: int) -> None:
        """Count what serving it took."""
        gained = SHARE * (now_ns - self.spent_ns)
        self.may_spend_ns = min(SPENT_AT_ONCE_NS, self.may_spend_ns + gained) - took_ns
        self.spent_ns = now_ns


class Backlog(Generic[T]):
    """Things of all peers that wait to be handled.

    Parameters
    ----------
    handle : callable
        Gives the steps that a thing takes, from it, its peer and the number it was added with.
    end : callable
        A peer has hung up, and all it said is done.
    most_bytes : int
        Room for what waits.
    """

    def __init__(
        self,
        handle: Callable[[T, Peer, int], Iterator[None]],
        end: Callable[[Peer], None],
        most_bytes: int = MOST_BYTES,
    ) -> None:
        self._handle = handle
        self._end = end
        self._room = Room(most_bytes)
        self._count = 0
        self._senders: dict[Peer, Sender[T]] = {}
        self._known: list[Sender[T]] = []
        self._sweep_at = MOST_SENDERS
        self._looked_ns = 0  # at who of those who are known is silent
        # Turns: of who is known, and of strangers.
        self._prompt: tuple[deque[Sender[T]], deque[Sender[T]]] = (deque(), deque())
        self._aside: OrderedDict[Peer, Sender[T]] = OrderedDict()  # the next one first

    def __len__(self) -> int:
        return self._count

    def add(
        self, thing: T | None, peer: Peer, when: int, size: int = 0, *, is_due: bool = False
    ) -> bool:
        """Keep a thing, or None where the peer has hung up; return whether there was room.

        There always is for the end of a peer, and for what `is_due`: of who is bounded otherwise.
        """
        now_ns = time.monotonic_ns()
        sender = self._sender(peer, now_ns)
        size += OVERHEAD_BYTES
        is_owed = sender.is_known and self._room.of(sender) + size <= OWED_BYTES
        if not self._room.take(sender, size, is_due=is_due or is_owed or thing is None):
            return False
        self._count += 1
        sender.works.append(Work(thing, when, size))
        if not sender.is_aside:
            sender.spend(0, now_ns)
            is_little = size <= LITTLE_BYTES + OVERHEAD_BYTES and sender.prompts < FEW
            if is_little and sender.may_spend_ns >= 0.0:
                sender.prompts += 1
                self._prompt[not sender.is_known].append(sender)
            else:
                self._put_aside(sender)
        return True

    @property
    def bytes(self) -> int:
        """What all that waits takes."""
        return self._room.taken_bytes

    def bytes_of(self, peer: Peer) -> int:
        """What one peer's takes; any thread may ask."""
        sender = self._senders.get(peer)
        return 0 if sender is None else self._room.of(sender)

    def clear(self) -> None:
        """Forget all that waits."""
        for sender in self._senders.values():
            sender.works.clear()
        self._count = 0
        self._room.clear()

    def work(self) -> None:
        """Handle some of it, for a turn of each kind."""
        for turns in self._prompt:
            until_ns = time.monotonic_ns() + TURN_NS
            while turns and time.monotonic_ns() < until_ns:
                self._serve_promptly(turns.popleft(), until_ns)
        until_ns = time.monotonic_ns() + TURN_NS
        while self._aside and time.monotonic_ns() < until_ns:
            self._serve_aside(until_ns)

    def _serve_promptly(self, sender: Sender[T], until_ns: int) -> None:
        """Handle one thing of a sender, unless it was put aside since."""
        sender.prompts -= 1
        if sender.works and not sender.is_aside:
            is_done = True  # also where it goes wrong: it is not tried again
            try:
                is_done = self._do(sender, until_ns)
            finally:
                if sender.works and (not is_done or sender.may_spend_ns < 0.0):
                    self._put_aside(sender)

    def _put_aside(self, sender: Sender[T]) -> None:
        sender.is_aside = True
        self._aside[sender.peer] = sender

    def _serve_aside(self, until_ns: int) -> None:
        """Handle what is next of those who were put aside, for as long as there is time."""
        peer, sender = self._aside.popitem(last=False)
        try:
            while sender.works and time.monotonic_ns() < until_ns:
                self._do(sender, until_ns)
        finally:
            if sender.works:
                self._aside[peer] = sender  # behind the others
            else:
                sender.is_aside = False

    def _do(self, sender: Sender[T], until_ns: int) -> bool:
        """Handle the next thing of a sender, as far as time goes; return whether it is done."""
        work = sender.works[0]
        began_ns = time.monotonic_ns()
        is_done = True
        try:
            is_done = self._advance(work, sender.peer, until_ns)
        finally:
            now_ns = time.monotonic_ns()
            sender.spend(now_ns - began_ns, now_ns)
            if is_done and sender.works and sender.works[0] is work:  # it may have cleared all
                sender.works.popleft()
                self._count -= 1
                self._room.give_back(sender, work.size)
        return is_done

    def _advance(self, work: Work[T], peer: Peer, until_ns: int) -> bool:
        if work.thing is None:
            self._end(peer)
            return True
        if work.steps is None:
            work.steps = self._handle(work.thing, peer, work.when)
        return all(time.monotonic_ns() <= until_ns for _ in work.steps)

    # -- who they are --------------------------------------------------------------------------

    def _sender(self, peer: Peer, now_ns: int) -> Sender[T]:
        sender = self._senders.get(peer)
        if sender is None:
            if len(self._senders) >= self._sweep_at:
                self._sweep()
            sender = self._senders[peer] = Sender(peer, now_ns, now_ns, spent_ns=now_ns)
        elif not sender.is_known and now_ns - sender.since_ns > STRANGE_NS:
            self._know(sender, now_ns)
        sender.heard_ns = now_ns
        return sender

    def _know(self, sender: Sender[T], now_ns: int) -> None:
        """Take up a sender among those who are known, if there is a place."""
        if len(self._known) >= MOST_KNOWN and now_ns - self._looked_ns > STRANGE_NS:
            self._looked_ns = now_ns
            for one in self._known:
                one.is_known = now_ns - one.heard_ns < FORGOTTEN_NS
            self._known = [one for one in self._known if one.is_known]
        if len(self._known) < MOST_KNOWN:
            sender.is_known = True
            self._known.append(sender)

    def _sweep(self) -> None:
        """Forget strangers who have nothing to be done."""
        self._senders = {
            peer: sender
            for peer, sender in self._senders.items()
            if sender.works or sender.is_known
        }
        self._sweep_at = max(MOST_SENDERS, 2 * len(self._senders))
