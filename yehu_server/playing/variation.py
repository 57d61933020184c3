"""Random differences between notes, in bow speed, bow pressure and intonation."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass

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
        self._random = random.Random(seed)  # noqa: S311 - for music, not secrets
        self._wish = wish
        self._note = Deviates()

    def seed(self, seed: int) -> None:
        """Begin the sequence of a seed."""
        self._random.seed(seed)

    def next_note(self) -> None:
        """Draw the deviates of a new note."""
        self._note = Deviates(*(self._random.gauss(0.0, 1.0) for _ in range(3)))

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
