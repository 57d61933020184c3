"""Keeps which parameters of bow and fingers the player may move.

A direct write to a parameter marked ``owned`` takes it over until the next note begins. A
parameter written with ``hold`` keeps its value, whatever notes and controllers do
(decisions/0006).
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Protocol

from yehu_server.params.table import find


class Sink(Protocol):
    """The instrument that a player moves: ``engine.instrument.Instrument``, or a stand-in."""

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        """Ramp a parameter of the engine to a value; return the value accepted."""

    def silence(self, *, frame: int | None = None) -> None:
        """Stop the sound at once."""


class Ownership:
    """Passes on the player's moves of parameters that nobody has taken over."""

    def __init__(self, sink: Sink) -> None:
        self.sink = sink
        self._taken: set[str] = set()
        self._kept: set[str] = set()
        self._glide_ms = 0.0
        self._sent: dict[str, float] = {}  # where the player last sent each parameter

    def move(
        self, address: str, value: float, frame: int | None, ramp_ms: float | None = None
    ) -> None:
        """Move a parameter, unless it is taken over or already moving to this value."""
        if self.has(address) and self._sent.get(address) != value:
            self._sent[address] = value
            if self._glide_ms > 0.0:
                own_ms = find(address).smooth_ms if ramp_ms is None else ramp_ms
                ramp_ms = max(own_ms, self._glide_ms)
            self.sink.write(address, value, frame=frame, ramp_ms=ramp_ms)

    @contextlib.contextmanager
    def gliding(self, glide_ms: float) -> Iterator[None]:
        """Make each move take at least this time (ms)."""
        before, self._glide_ms = self._glide_ms, glide_ms
        try:
            yield
        finally:
            self._glide_ms = before

    def forget(self, address: str) -> None:
        """Forget the value last sent, so that the next move is sent in any case."""
        self._sent.pop(address, None)

    def has(self, address: str) -> bool:
        """Whether the player may move a parameter."""
        return address not in self._taken and address not in self._kept

    def keeps(self, address: str) -> bool:
        """Whether a parameter is held."""
        return address in self._kept

    def give_up(self, address: str, *, hold: bool) -> None:
        """Record that a direct write took a parameter over, until the next note or as held."""
        (self._kept if hold else self._taken).add(address)
        self.forget(address)

    def take_back(self, *addresses: str) -> None:
        """Own these parameters again; without any, all that are not held."""
        self._taken -= set(addresses) if addresses else set(self._taken)
        for address in addresses:
            self.forget(address)

    def release(self) -> None:
        """Own all parameters again, held ones too."""
        self._taken.clear()
        self._kept.clear()
