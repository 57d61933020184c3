"""The measurements that tune an instrument, as the player reads them."""

import math
from dataclasses import dataclass, replace

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.elementary import exp2

Tables = tuple[tuple[tuple[float, ...], ...], ...]  # of strings, notes, speeds

OPEN_NOTES = (65, 72)  # F4 and C5, of a yehu
SPEEDS = (0.12, 0.16, 0.2, 0.26)  # m/s
USUAL_SPEED = 0.2
# Gains (dB) of the shelf that makes a note brighter; its frequency, times the note's centroid.
GAINS = (-6.0, 0.0, 6.0, 12.0, 18.0)
PLAIN = GAINS.index(0.0)
ABOVE = 1.4
# The stopped pitches measured on each string: semitones, and quarter tones where the body's mode
# at 439 Hz bends pitches most, and at 850 Hz, where the body radiates 9 dB more than beside it.
# A yehu is stopped in the first ROWS_OF_A_YEHU; other fiddles may reach higher.
PITCHES = (
    (*(66.0 + 0.5 * step for step in range(13)), *(float(note) for note in range(73, 85))),
    (*(float(note) for note in range(73, 81)), 80.5, *(float(note) for note in range(81, 97))),
)
ROWS_OF_A_YEHU = 18


@dataclass(frozen=True)
class NoteTables:
    """The measurements that tune an instrument.

    Attributes
    ----------
    tensions : tuple of float
        Tensions of the strings (N).
    sharpening : tuple
        How much sharper (cents) a stopped note sounds than c/2f of its length: for each string
        a row for each of PITCHES, with a value for each of SPEEDS.
    levels : tuple
        Level of each note (dB, A-weighted), in the same form, the open string first.
    open_notes : tuple of int
        What the strings are tuned to (MIDI notes). Where that is not as on a yehu, a row is of the
        stop that has its pitch there.
    centroids : tuple
        Spectral centroid of each note (Hz), the open string first, with each of GAINS for what
        lies ABOVE it, bowed at USUAL_SPEED.
    louder : tuple
        How much louder (dB, A-weighted) these gains make it.
    """

    a4: float
    tensions: tuple[float, float]
    sharpening: Tables
    levels: Tables = ()
    open_notes: tuple[int, int] = OPEN_NOTES
    centroids: Tables = ()
    louder: Tables = ()

    def tuned(self, quantities: Quantities) -> Quantities:
        """The quantities with the tensions of this calibration."""
        first, second = self.tensions
        return replace(
            quantities,
            string_1=replace(quantities.string_1, T=first),
            string_2=replace(quantities.string_2, T=second),
        )


def frequency_hz(pitch: float, a4: float) -> float:
    """Frequency of a fractional MIDI note in equal temperament."""
    return a4 * exp2((pitch - 69.0) / 12.0)


def wave_speed(quantities: Quantities, string: int) -> float:
    """Speed (m/s) of waves on an ideal string."""
    silk = quantities.strings[string]
    return math.sqrt(silk.T / silk.rho_A)


def ideal_position(quantities: Quantities, string: int, frequency: float) -> float:
    """Finger position (m) at which an ideal string has a frequency (Hz): c/2f from the bridge."""
    return quantities.bridge_x - wave_speed(quantities, string) / (2.0 * frequency)
