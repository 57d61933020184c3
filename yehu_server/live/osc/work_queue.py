"""A bounded queue of all senders' work, with a share for each.

What the senders of a host send is done in order of arrival, so that a patch may play from several
sockets. But hosts take turns, each for a slice of time, and so does a sender that sends much: one
that sends little is served within a few slices, however much others have waiting.
"""

import contextlib
import socket
from collections import OrderedDict, deque
from collections.abc import Callable, Iterator

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.peers import Peer
from yehu_server.system import clocks

TURN_NS, SLICE_NS = 2_000_000, 500_000  # of one call of `work`, and of one sender's turn in it
# Of a sender: pieces of work that wait, and what those took, before it gets turns of its own.
MOST_IN_ORDER, LONGEST_IN_ORDER_NS = 64, 32 * SLICE_NS
DONE = object()


class Shares:
    """Bytes for all senders together, of which each may hold as many as it leaves free.

    So one alone may hold half of them, and there are always some for the next.
    """

    def __init__(self, most: int) -> None:
        self._free = most
        self._held: dict[Peer, int] = {}

    def held(self, peer: Peer) -> int:
        """Bytes that a sender holds; any thread may call."""
        return self._held.get(peer, 0)

    def take(self, peer: Peer, size: int, *, always: bool = False) -> bool:
        """Take bytes for a sender; return whether there were enough (with `always` there are)."""
        held = self._held.get(peer, 0) + size
        if held > self._free - size and not always:
            return False
        self._held[peer] = held
        self._free -= size
        return True

    def give_back(self, peer: Peer, size: int) -> None:
        """Give back bytes of a sender."""
        self._free += size
        self._held[peer] -= size
        if not self._held[peer]:
            del self._held[peer]


class WorkQueue:
    """The work of all senders that waits to be done: iterators, whose steps are short."""

    def __init__(self, most_bytes: int = limits.WAITING) -> None:
        self._shares = Shares(most_bytes)
        self._works: dict[Peer, deque[tuple[Iterator[None], int]]] = {}
        self._worked_ns: dict[Peer, int] = {}  # for those who have work, since they had none
        self._crowding: set[Peer] = set()  # those with turns of their own, until they have no work
        # Of each host, and of each of those: whose work is next.
        self._turns: OrderedDict[Peer | str, deque[Peer]] = OrderedDict()
        self.held = self._shares.held

    def __bool__(self) -> bool:
        return bool(self._works)

    def add(
        self, steps: Iterator[None], peer: Peer, size: int = 0, *, always: bool = False
    ) -> bool:
        """Add work of a size in bytes; return whether there was room, or it goes `always`."""
        size += limits.OVERHEAD
        if not self._shares.take(peer, size, always=always):
            return False
        works = self._works.setdefault(peer, deque())
        works.append((steps, size))
        self._turns.setdefault(self._key(peer), deque()).append(peer)
        if len(works) > MOST_IN_ORDER:
            self._separate(peer)
        return True

    def _key(self, peer: Peer) -> Peer | str:
        return peer if peer in self._crowding else peer.host

    def _separate(self, peer: Peer) -> None:
        """Give a sender turns of its own; those among its host's are passed over."""
        if peer not in self._crowding:
            self._crowding.add(peer)
            self._turns[peer] = deque([peer] * len(self._works[peer]))

    def work(self) -> None:
        """Do what waits, for up to TURN_NS; work that fails is gone."""
        now = clocks.monotonic_ns()
        until = now + TURN_NS
        while self._turns and now < until:
            key, order = next(iter(self._turns.items()))
            self._turns.move_to_end(key)
            slice_ends = now + SLICE_NS
            while order and now < slice_ends:
                peer = order[0]
                if peer in self._works and self._key(peer) == key:
                    now = self._step(peer, order, now)
                else:  # it has turns of its own, or had
                    order.popleft()
            if not order:
                del self._turns[key]

    def _step(self, peer: Peer, order: deque[Peer], began_ns: int) -> int:
        """Do a step of a sender's work; return the time (ns)."""
        works, rest = self._works[peer], DONE
        steps, size = works[0]
        try:
            rest = next(steps, DONE)
        finally:
            now = clocks.monotonic_ns()
            self._worked_ns[peer] = self._worked_ns.get(peer, 0) + now - began_ns
            if rest is DONE:
                works.popleft()
                order.popleft()
                self._shares.give_back(peer, size)
                if not works:
                    del self._works[peer], self._worked_ns[peer]
                    self._crowding.discard(peer)
            if self._worked_ns.get(peer, 0) > LONGEST_IN_ORDER_NS:
                self._separate(peer)
        return now


class Calls:
    """Functions that other threads have called in one that waits for this as for a socket."""

    def __init__(self) -> None:
        self._waiting: deque[Callable[[], object]] = deque()
        self._here, self._there = socket.socketpair()
        for end in (self._here, self._there):
            end.setblocking(False)

    def __len__(self) -> int:
        return len(self._waiting)

    def fileno(self) -> int:
        """What becomes readable where something is to be called."""
        return self._here.fileno()

    def soon(self, action: Callable[[], object]) -> None:
        """Call a function soon; any thread may call."""
        self._waiting.append(action)
        self.wake()

    def wake(self) -> None:
        """Wake the thread."""
        with contextlib.suppress(OSError):  # full: the thread will wake anyway
            self._there.send(b"!")

    def run(self) -> None:
        """Call what waits; what is added meanwhile waits for the next turn."""
        with contextlib.suppress(BlockingIOError):
            self._here.recv(limits.STREAM_READ)
        for _ in range(len(self._waiting)):
            self._waiting.popleft()()
        if self._waiting:
            self.wake()

    def close(self) -> None:
        """Close both sockets."""
        self._here.close()
        self._there.close()
