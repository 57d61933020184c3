"""Messages with a time tag, until they are due.

A tag names a moment of the world's clock; the instrument counts frames. The first tag of a
series ties the two together, and later ones are counted from it at the nominal rate: so
distances are exact to the frame. Where the device's own pace has led more than a millisecond
away from that, the tie is made anew.
"""

from __future__ import annotations

import heapq
import itertools
import time
from typing import Generic, TypeVar

from yehu_server.control.room import OVERHEAD_BYTES, Room
from yehu_server.playing.live import LivePlayer

AHEAD_S = 0.01  # how long before a message of now a scheduled one is decided on
TOGETHER_NS, TRIES = 100_000, 10
STRAY_S = 0.001
MOST_BYTES = 20 << 20  # that wait: some 65,000 notes, half as many of one sender


T = TypeVar("T")
Sender = TypeVar("Sender")


def both_clocks() -> tuple[float, int]:
    """The world's clock (s since 1970) and the monotonic one (ns) at one moment."""
    for _ in range(TRIES):
        before = time.monotonic_ns()
        now_s = time.time()
        if time.monotonic_ns() - before < TOGETHER_NS:  # nothing held us up between them
            break
    return now_s, before


class TagClock:
    """Frames of time tags."""

    def __init__(self, player: LivePlayer) -> None:
        self._player = player
        self._tie: tuple[float, int] | None = None  # a moment (s since 1970) and its frame

    def frame_at(self, due_s: float) -> int:
        """The frame that is played at a moment."""
        rate = self._player.instrument.rate
        now_s, now_ns = both_clocks()
        true = self._player.instrument.frame_at(now_ns) + (due_s - now_s) * rate
        if self._tie is not None:
            moment, frame = self._tie
            counted = frame + round((due_s - moment) * rate)
            if abs(counted - true) < STRAY_S * rate:
                return counted
        self._tie = (due_s, round(true))
        return self._tie[1]


class Schedule(Generic[T, Sender]):
    """What is to be done when, as far as it has not come.

    Parameters
    ----------
    ahead_s : float
        How long before its time a thing is handed out.
    most_bytes : int
        Room for all that waits; half of it for one sender's.
    """

    def __init__(self, ahead_s: float = AHEAD_S, most_bytes: int = MOST_BYTES) -> None:
        self.ahead_s = ahead_s
        self._room = Room(most_bytes)
        self._order = itertools.count()
        self._waiting: list[tuple[float, int, T, Sender, int]] = []

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, due_s: float, thing: T, sender: Sender, size: int = 0) -> bool:
        """Keep a thing until its time (s since 1970); return whether there was room.

        `size` is what it takes, in bytes.
        """
        size += OVERHEAD_BYTES
        if not self._room.take(sender, size):
            return False
        heapq.heappush(self._waiting, (due_s, next(self._order), thing, sender, size))
        return True

    def due(self, most: int) -> list[tuple[float, T, Sender]]:
        """What is to be handed out now, with the times it is meant for: so many at most."""
        ready: list[tuple[float, T, Sender]] = []
        horizon = time.time() + self.ahead_s
        while self._waiting and self._waiting[0][0] <= horizon and len(ready) < most:
            due_s, _, thing, sender, size = heapq.heappop(self._waiting)
            self._room.give_back(sender, size)
            ready.append((due_s, thing, sender))
        return ready

    def wait_s(self) -> float | None:
        """Seconds until the next thing is to be handed out."""
        if not self._waiting:
            return None
        return max(0.0, self._waiting[0][0] - self.ahead_s - time.time())

    def clear(self) -> None:
        """Forget everything."""
        self._waiting.clear()
        self._room.clear()
