"""Finger positions for pitches, and gains for even loudness, from a calibration."""

from __future__ import annotations

import math
from bisect import bisect_right

from yehu_server.physics.quantities import Quantities
from yehu_server.playing.calibration import (
    OPEN_NOTES,
    PITCHES,
    SPEEDS,
    Calibration,
    frequency_hz,
    ideal_position,
)
from yehu_server.playing.calibrations import calibration_for

DEFAULT_RATE = 44100.0
LOG_SPEEDS = [math.log(speed) for speed in SPEEDS]


class Intonation:
    """Finger positions and gains of one calibrated instrument.

    Attributes
    ----------
    trust : float
        Weight of the calibration: 0 gives the finger positions of an ideal string.
    """

    def __init__(
        self, calibration: Calibration | None = None, quantities: Quantities | None = None
    ) -> None:
        quantities = quantities or Quantities()
        self._calibration = calibration or calibration_for(DEFAULT_RATE, quantities)
        self._quantities = self._calibration.tuned(quantities)
        self.trust = 1.0

    def position(self, string: int, pitch: float, speed: float) -> float:
        """Finger position (m) for a pitch (fractional MIDI note) on string 0 or 1.

        A faster bow changes the pitch: `speed` (m/s) is the one the player wishes for. Notes
        that are bowed more slowly were measured so.
        """
        sharp = self.trust * self._sharpening(string, pitch, speed)
        frequency = frequency_hz(pitch - sharp / 100.0, self._calibration.a4)
        return ideal_position(self._quantities, string, frequency)

    def balance_db(self, string: int, pitch: float, speed: float) -> float:
        """Gain (dB) that makes a note as loud as the average note, at a wished `speed` (m/s).

        The pitch of an open string is that of its note.
        """
        levels = self._calibration.levels
        if not levels:
            return 0.0
        all_notes = [_at_speed(row, speed) for table in levels for row in table]
        pitches = (float(OPEN_NOTES[string]), *PITCHES[string])
        own = _read(levels[string], pitches, pitch, speed)
        return sum(all_notes) / len(all_notes) - own

    def _sharpening(self, string: int, pitch: float, speed: float) -> float:
        return _read(self._calibration.sharpening[string], PITCHES[string], pitch, speed)


def _read(
    table: tuple[tuple[float, ...], ...], pitches: tuple[float, ...], pitch: float, speed: float
) -> float:
    """Interpolate a table of pitches and SPEEDS; beyond its ends, the end values apply."""
    row = min(max(bisect_right(pitches, pitch) - 1, 0), len(pitches) - 2)
    part = (pitch - pitches[row]) / (pitches[row + 1] - pitches[row])
    low, high = _at_speed(table[row], speed), _at_speed(table[row + 1], speed)
    return low + min(max(part, 0.0), 1.0) * (high - low)


def _at_speed(row: tuple[float, ...], speed: float) -> float:
    logarithm = math.log(max(speed, 1e-3))
    column = sum(logarithm >= entry for entry in LOG_SPEEDS[1:-1])
    part = (logarithm - LOG_SPEEDS[column]) / (LOG_SPEEDS[column + 1] - LOG_SPEEDS[column])
    return row[column] + min(max(part, 0.0), 1.0) * (row[column + 1] - row[column])
