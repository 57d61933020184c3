"""Keep messages with time tags until they are due.

A tag is a time of the system's clock; the instrument counts frames. The first tag of a series
gives a time and its frame, and later tags are counted from it at the nominal sample rate, so that
intervals are exact to the frame. Once the device's own rate has led more than a millisecond away
from that, a new pair of time and frame is taken.
"""

import heapq
import itertools

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.peers import Peer
from yehu_server.live.osc.work_queue import Shares
from yehu_server.live.part_addresses import PART, part_of
from yehu_server.params.table import PREFIX
from yehu_server.playing.player import Player
from yehu_server.system import clocks

AHEAD_S = 0.01  # scheduled messages are posted so long before they are due
SAME_MOMENT_NS, TRIES = 100_000, 10
LARGEST_DRIFT_S = 0.001


def both_clocks() -> tuple[float, int]:
    """The system's clock (s since 1970) and the monotonic clock (ns) at the same moment."""
    for _ in range(TRIES):
        before = clocks.monotonic_ns()
        now_s = clocks.now_s()
        if clocks.monotonic_ns() - before < SAME_MOMENT_NS:  # the thread was not held up in between
            break
    return now_s, before


class TagClock:
    """Converts time tags to frames."""

    def __init__(self, player: Player) -> None:
        self._player = player
        self._anchor: tuple[float, int] | None = None  # a time (s since 1970) and its frame

    def frame_at(self, due_s: float) -> int:
        """The frame that is played at a time (s since 1970)."""
        rate = self._player.instrument.rate
        now_s, now_ns = both_clocks()
        true = self._player.instrument.frame_at(now_ns) + (due_s - now_s) * rate
        if self._anchor is not None:
            moment, frame = self._anchor
            counted = frame + round((due_s - moment) * rate)
            if abs(counted - true) < LARGEST_DRIFT_S * rate:
                return counted
        self._anchor = (due_s, round(true))
        return self._anchor[1]


class Schedule:
    """Messages that wait for their time.

    `ahead_s`: how long before its time a message is due.
    `most_bytes`: limit on the size of all of them; see `Shares` for what one peer gets.
    """

    def __init__(self, ahead_s: float = AHEAD_S, most_bytes: int = limits.SCHEDULED) -> None:
        self.ahead_s = ahead_s
        self._shares = Shares(most_bytes)
        self._order = itertools.count()
        self._waiting: list[tuple[float, int, bytes, Peer, int]] = []

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, due_s: float, packet: bytes, peer: Peer) -> bool:
        """Keep a message until its time (s since 1970); return whether there was room."""
        size = len(packet) + limits.OVERHEAD
        if not self._shares.take(peer, size):
            return False
        heapq.heappush(self._waiting, (due_s, next(self._order), packet, peer, size))
        return True

    def due(self) -> tuple[float, bytes, Peer] | None:
        """Remove and return the next message that is due now, with its time and peer."""
        if not self._waiting or self._waiting[0][0] > clocks.now_s() + self.ahead_s:
            return None
        due_s, _, packet, peer, size = heapq.heappop(self._waiting)
        self._shares.give_back(peer, size)
        return due_s, packet, peer

    def wait_s(self) -> float | None:
        """Seconds until the next message is due; None where there is none."""
        if not self._waiting:
            return None
        return max(0.0, self._waiting[0][0] - self.ahead_s - clocks.now_s())

    def drop_part(self, group: str) -> None:
        """Drop the messages of a group of addresses; of `FIRST`, all."""
        own, parts = f"{PREFIX}{group}/".encode(), f"{PREFIX}{PART}".encode()
        remaining = []
        for entry in self._waiting:
            _, _, packet, peer, size = entry
            is_of_first = part_of(group) == 0 and not packet.startswith(parts)
            if not group or packet.startswith(own) or is_of_first:
                self._shares.give_back(peer, size)
            else:
                remaining.append(entry)
        self._waiting = remaining
        heapq.heapify(self._waiting)
