"""Where to stop a string for a pitch."""

from __future__ import annotations

import math

from yehu_server.physics.quantities import Quantities

OPEN_NOTES = (65, 72)  # F4 and C5
HIGHEST_X = 0.19  # m; beyond it fingers and bow crowd, and notes turn to the octave

# How much sharper a stopped note sounds than c/2f promises (cents), from a semitone above
# the open string upwards: stiffness, the finger's width and the body pull at it. Measured
# at 44.1 kHz by scripts/measure_intonation.py.
# fmt: off
SHARPENING: tuple[tuple[float, ...], tuple[float, ...]] = (
    # F#4 to A#5
    (27.2, 30.5, 32.7, 47.9, 50.2, 47.7, 51.3, 55.3, 57.1,
     46.3, 38.9, 45.9, 67.5, 65.8, 68.8, 70.6, 87.0),
    # C#5 to F6
    (16.3, 19.7, 18.6, 18.1, 22.3, 22.0, 23.4, 19.7, 27.1,
     25.5, 23.3, 22.8, 24.0, 23.5, 25.0, 30.3, 40.1),
)
# fmt: on


def ideal_position(quantities: Quantities, string: int, pitch: float) -> float:
    """Finger position (m) that leaves c/2f of an ideal string to the bridge."""
    silk = quantities.strings[string]
    frequency_hz = 440.0 * math.exp2((pitch - 69.0) / 12.0)
    return quantities.bridge_x - math.sqrt(silk.T / silk.rho_A) / (2.0 * frequency_hz)


class Intonation:
    """Finger positions in equal temperament at A4 = 440 Hz."""

    def __init__(self, quantities: Quantities | None = None) -> None:
        self._quantities = quantities or Quantities()

    def position(self, string: int, pitch: float) -> float:
        """Finger position (m) for a pitch (fractional MIDI note) on string 0 or 1."""
        cents = self._sharpening(string, pitch)
        return ideal_position(self._quantities, string, pitch - cents / 100.0)

    def reaches(self, string: int, pitch: float) -> bool:
        """Whether a finger gets there without crowding the bow."""
        return self.position(string, pitch) <= HIGHEST_X

    def _sharpening(self, string: int, pitch: float) -> float:
        table = SHARPENING[string]
        place = min(max(pitch - OPEN_NOTES[string] - 1.0, 0.0), len(table) - 1.0)
        below = min(int(place), max(len(table) - 2, 0))
        above = min(below + 1, len(table) - 1)
        return table[below] + (place - below) * (table[above] - table[below])
