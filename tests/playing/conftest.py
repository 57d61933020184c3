"""An instrument that only listens, and a neck that is easy to reckon with."""

from __future__ import annotations

import math
from typing import NamedTuple

import pytest

from yehu_server.playing.performer import Performer

ENGINE = {
    "/bow/speed",
    "/bow/side",
    "/bow/force",
    "/bow/pressure",
    "/bow/assist",
    "/bow/position",
    "/finger/1/position",
    "/finger/1/press",
    "/output/gain",
    "/output/level",
}


class Move(NamedTuple):
    """One call of an instrument's `write`."""

    address: str
    value: float
    frame: int | None
    ramp_ms: float | None


class Listener:
    """Stands in for the instrument and keeps what it is told."""

    def __init__(self) -> None:
        self.moves: list[Move] = []
        self.silenced: list[int | None] = []

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        assert address in ENGINE
        assert math.isfinite(value)
        self.moves.append(Move(address, value, frame, ramp_ms))
        return value

    def silence(self, *, frame: int | None = None) -> None:
        self.silenced.append(frame)

    def of(self, address: str) -> list[Move]:
        return [move for move in self.moves if move.address == address]

    def __getitem__(self, address: str) -> float:
        """Where a parameter goes, by the last word."""
        return self.of(address)[-1].value

    def where(self) -> tuple[str, float | None]:
        """The string bowed, and how many semitones above it the finger stops it, if it does."""
        string = {1.0: "F", -1.0: "C", 0.0: "none"}[self["/bow/side"]]
        if self["/finger/1/press"] == 0.0:
            return string, None
        return string, round(self["/finger/1/position"] * 100.0, 6)


class Ruler:
    """A neck with a centimetre a semitone on both strings; nobody reaches beyond 19 cm."""

    OPEN = (65.0, 72.0)

    def position(self, string: int, pitch: float) -> float:
        return 0.01 * (pitch - self.OPEN[string])

    def reaches(self, string: int, pitch: float) -> bool:
        return self.position(string, pitch) <= 0.19


@pytest.fixture
def listener() -> Listener:
    return Listener()


@pytest.fixture
def ruler() -> Ruler:
    return Ruler()


@pytest.fixture
def player(listener, ruler) -> Performer:
    """A player without chance."""
    performer = Performer(listener, ruler)
    performer.write("/playing/variation", 0.0)
    return performer
