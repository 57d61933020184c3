"""Where the finger goes for a pitch."""

from __future__ import annotations

import math

from yehu_server.physics.quantities import Quantities
from yehu_server.playing.calibration import (
    OPEN_NOTES,
    SPEEDS,
    Calibration,
    calibration_for,
    frequency_hz,
    ideal_position,
)

HIGHEST_X = 0.19  # m; beyond it fingers and bow crowd, and notes turn to the octave
DEFAULT_RATE = 44100.0
LOG_SPEEDS = [math.log(speed) for speed in SPEEDS]


class Intonation:
    """Finger positions in equal temperament, for one calibrated instrument."""

    def __init__(
        self, calibration: Calibration | None = None, quantities: Quantities | None = None
    ) -> None:
        quantities = quantities or Quantities()
        self._calibration = calibration or calibration_for(DEFAULT_RATE, quantities)
        self._quantities = self._calibration.tuned(quantities)

    def position(self, string: int, pitch: float, speed: float) -> float:
        """Finger position (m) for a pitch (fractional MIDI note) on string 0 or 1.

        The pitch is that of a bow of `speed` (m/s): a faster one pulls it.
        """
        sharp = self._sharpening(string, pitch, speed)
        frequency = frequency_hz(pitch - sharp / 100.0, self._calibration.a4)
        return ideal_position(self._quantities, string, frequency)

    def reaches(self, string: int, pitch: float) -> bool:
        """Whether a finger gets there without crowding the bow."""
        return self.position(string, pitch, SPEEDS[0]) <= HIGHEST_X

    def balance_db(self, string: int, pitch: float, speed: float, wish: float) -> float:
        """Gain (dB) that makes a note as loud as notes are on average.

        The note is bowed at `speed` (m/s); the average is that of a bow of `wish`, since some notes
        bear no faster one. The open string is the pitch of its note.
        """
        levels = self._calibration.levels
        if not levels:
            return 0.0
        usual = [_read(table, row, wish) for table in levels for row in range(len(table))]
        own = _read(levels[string], pitch - OPEN_NOTES[string], speed)
        return sum(usual) / len(usual) - own

    def _sharpening(self, string: int, pitch: float, speed: float) -> float:
        table = self._calibration.sharpening[string]
        return _read(table, pitch - OPEN_NOTES[string] - 1.0, speed)


def _read(table: tuple[tuple[float, ...], ...], place: float, speed: float) -> float:
    """A table of notes and SPEEDS, read between its entries; its ends go on beyond it."""
    row, across = _between(place, len(table))
    logarithm = math.log(max(speed, 1e-3))
    column = sum(logarithm >= entry for entry in LOG_SPEEDS[1:-1])
    part = (logarithm - LOG_SPEEDS[column]) / (LOG_SPEEDS[column + 1] - LOG_SPEEDS[column])
    part = min(max(part, 0.0), 1.0)

    def at(note: int) -> float:
        return table[note][column] + part * (table[note][column + 1] - table[note][column])

    return at(row) + across * (at(row + 1) - at(row))


def _between(place: float, rows: int) -> tuple[int, float]:
    """The row below a place in a table, and how far it is to the next."""
    place = min(max(place, 0.0), rows - 1.0)
    row = min(int(place), rows - 2)
    return row, place - row
