"""Who moves the bow and the fingers: the player, as long as nobody took them over.

A direct write to a parameter marked ``owned`` takes that one over until the next note begins.
Any parameter written with ``hold`` stays as it is, whatever notes and controllers say
(decisions/0006).
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Protocol

from yehu_server.params.table import find


class Sink(Protocol):
    """What a player moves: an ``engine.instrument.Instrument``, or a stand-in."""

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        """Let a parameter of the engine move to a value."""

    def silence(self, *, frame: int | None = None) -> None:
        """Stop the sound at once."""


class Ownership:
    """The instrument, as far as it is the player's."""

    def __init__(self, sink: Sink) -> None:
        self.sink = sink
        self._taken: set[str] = set()
        self._kept: set[str] = set()
        self._glide_ms = 0.0
        self._sent: dict[str, float] = {}  # where the player last sent each parameter

    def move(
        self, address: str, value: float, frame: int | None, ramp_ms: float | None = None
    ) -> None:
        """Move a parameter, unless somebody else has it, or it is on its way there already."""
        if self.has(address) and self._sent.get(address) != value:
            self._sent[address] = value
            if self._glide_ms > 0.0:
                usual_ms = find(address).smooth_ms if ramp_ms is None else ramp_ms
                ramp_ms = max(usual_ms, self._glide_ms)
            self.sink.write(address, value, frame=frame, ramp_ms=ramp_ms)

    @contextlib.contextmanager
    def gliding(self, glide_ms: float) -> Iterator[None]:
        """Let each move take this long at least."""
        before, self._glide_ms = self._glide_ms, glide_ms
        try:
            yield
        finally:
            self._glide_ms = before

    def forget(self, address: str) -> None:
        """Let the next move of a parameter be made, wherever it is."""
        self._sent.pop(address, None)

    def has(self, address: str) -> bool:
        """Whether the player may move a parameter."""
        return address not in self._taken and address not in self._kept

    def keeps(self, address: str) -> bool:
        """Whether a parameter was taken over for good."""
        return address in self._kept

    def give_up(self, address: str, *, hold: bool) -> None:
        """Leave a parameter to who wrote it: until the next note, or for good."""
        (self._kept if hold else self._taken).add(address)
        self.forget(address)

    def take_back(self, *addresses: str) -> None:
        """Have these again, to move them at once; all but what is held where none is named."""
        self._taken -= set(addresses) if addresses else set(self._taken)
        for address in addresses:
            self.forget(address)

    def release(self) -> None:
        """Have everything again."""
        self._taken.clear()
        self._kept.clear()
