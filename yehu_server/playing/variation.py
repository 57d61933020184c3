"""Random differences between notes, in bow speed, bow pressure and intonation."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from yehu_server.engine.controls import chance

# A sum of so many uniform numbers is all but normal.
ADDED = 12
# Standard deviations at full variation. By ear.
VARIED_FRACTION = 0.1  # of bow speed and pressure
VARIED_CENTS = 6.0


@dataclass
class Deviates:
    """Normal deviates of one note, of variance 1."""

    speed: float = 0.0
    pressure: float = 0.0
    pitch: float = 0.0


class Variation:
    """Draws the deviates of each note; the same seed gives the same sequence.

    Parameters
    ----------
    wish : callable
        Returns the present value of a parameter under ``/playing``.
    """

    def __init__(self, seed: int, wish: Callable[[str], float]) -> None:
        self._seed, self._drawn = seed, 0
        self._wish = wish
        self._note = Deviates()

    def seed(self, seed: int) -> None:
        """Begin the sequence of a seed."""
        self._seed, self._drawn = seed, 0

    def next_note(self) -> None:
        """Draw the deviates of a new note."""
        self._note = Deviates(self._deviate(), self._deviate(), self._deviate())

    def _deviate(self) -> float:
        """A number of mean 0 and variance 1; each of the uniform ones has a variance of 1/3."""
        total = 0.0
        for _ in range(ADDED):
            total += chance((self._seed << 32) + self._drawn)
            self._drawn += 1
        return total / math.sqrt(ADDED / 3.0)

    @property
    def _amount(self) -> float:
        return self._wish("/playing/variation")

    def bow_factors(self) -> tuple[float, float]:
        """Factors on the bow speed and pressure of the note."""
        varied = self._amount * VARIED_FRACTION
        return 1.0 + varied * self._note.speed, 1.0 + varied * self._note.pressure

    @property
    def semitones(self) -> float:
        """Deviation of the note from its pitch."""
        return self._amount * self._note.pitch * VARIED_CENTS / 100.0
