"""Puts the messages of MIDI inputs into the rings from which the audio callback takes them.

So they pass no other Python than that of the process that holds the inputs, however busy the
server is. It loads no compiled code; the rings are those of ``engine.mailbox``.
"""

import struct
import threading
from collections.abc import Mapping, Sequence
from ctypes import c_int64
from typing import Any

from yehu_server.core.midi.packing import packed
from yehu_server.live.midi.routes import Router

PORTS = 16  # inputs that are open at a time
ENTRY = struct.Struct("@qqqdd")  # of a ring: time (ns), kind, index, value, other
STATUS, CHANNEL, SYSTEM = 0x80, 0x0F, 0xF0


class SharedRing:
    """The ring of a part in shared memory, of which this process is the only writer.

    `place`: where in the memory its `entries` and its cursors `posted`, `drained` and `dropped` lie
    (bytes), and its `size` (entries; a power of two).
    """

    def __init__(self, memory: Any, place: Mapping[str, int]) -> None:
        self._memory, self._entries, self._size = memory, place["entries"], place["size"]
        self._posted, self._drained, self._dropped = (
            c_int64.from_buffer(memory, place[name]) for name in ("posted", "drained", "dropped")
        )
        self._order = threading.Lock()

    def post(self, time_ns: int, kind: int, index: int) -> bool:
        """Add an event with its time of arrival; without room it is dropped, and counted."""
        posted = self._posted.value
        if posted - self._drained.value >= self._size:
            self._dropped.value += 1
            return False
        at = self._entries + ENTRY.size * (posted & (self._size - 1))
        ENTRY.pack_into(self._memory, at, time_ns, kind, index, 0.0, 0.0)
        # The entry has to be seen before its number. A lock that is released and taken again
        # orders them on every processor; Python has nothing lighter.
        for _ in range(2):
            with self._order:
                pass
        self._posted.value = posted + 1
        return True


class MidiFeed:
    """Finds the parts that each input plays, and posts its messages to their rings.

    An input that comes back gets the number that it had: it distinguishes MIDI's channels.
    Its methods may be called from any thread.

    `rings`: of each part.
    `message`, `disconnect`: kinds of the events (``midi.events``): a message, and that a port is
    gone.
    `numbers`: numbers of inputs, by name, that were known before.
    """

    def __init__(
        self,
        rings: Sequence[SharedRing],
        router: Router,
        *,
        message: int,
        disconnect: int,
        numbers: Mapping[str, int] | None = None,
    ) -> None:
        self._rings = rings
        self._router = router
        self._message, self._disconnect = message, disconnect
        self._numbers = dict(numbers or {})
        self._open: set[str] = set()
        self._posting = threading.Lock()

    def open(self, name: str) -> int | None:
        """Count an input as open; return its number, if need be one that is gone left, or None."""
        with self._posting:
            if name not in self._numbers:
                free = set(range(PORTS)) - {*self._numbers.values()}
                gone = [known for known in self._numbers if known not in self._open]
                if not free and not gone:
                    return None
                self._numbers[name] = min(free) if free else self._numbers.pop(gone[0])
            self._open.add(name)
            self._router.parts_of(name)  # in the order of coming
            return self._numbers[name]

    def receive(self, name: str, data: Sequence[int], time_ns: int) -> None:
        """Post a message of an open input to the parts that its channel plays."""
        is_of_channel = STATUS <= data[0] < SYSTEM
        channel = data[0] & CHANNEL if is_of_channel else None
        with self._posting:
            index = packed(data, self._numbers[name])
            for part in self._router.parts_of(name, channel):
                self._rings[part].post(time_ns, self._message, index)

    def end_port_notes(self, name: str, time_ns: int, *, is_gone: bool) -> None:
        """End the notes of an input; with `is_gone`, count it as no longer open."""
        with self._posting:
            for part in self._router.parts_of(name):
                self._rings[part].post(time_ns, self._disconnect, self._numbers[name])
            if is_gone:
                self._open.discard(name)
