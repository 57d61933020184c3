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

    def _sharpening(self, string: int, pitch: float, speed: float) -> float:
        table = self._calibration.sharpening[string]
        row, across = _between(pitch - OPEN_NOTES[string] - 1.0, len(table))
        speeds = [math.log(entry) for entry in SPEEDS]
        logarithm = math.log(max(speed, 1e-3))
        column = sum(logarithm >= entry for entry in speeds[1:-1])
        part = (logarithm - speeds[column]) / (speeds[column + 1] - speeds[column])
        part = min(max(part, 0.0), 1.0)

        def at(note: int) -> float:
            return table[note][column] + part * (table[note][column + 1] - table[note][column])

        return at(row) + across * (at(row + 1) - at(row))


def _between(place: float, rows: int) -> tuple[int, float]:
    """The row below a place in a table, and how far it is to the next."""
    place = min(max(place, 0.0), rows - 1.0)
    row = min(int(place), rows - 2)
    return row, place - row
