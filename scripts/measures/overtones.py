"""The pitch of a short note among what still rings of those before, by its harmonics.

Strings and body ring on when a note changes. Open C5, or the other string under the same finger,
lies a fifth above a note on the F string: both together repeat after two periods of the note, so
autocorrelation tells an octave too low. The harmonics lie apart, and are told apart by frequency.
"""

from __future__ import annotations

import numpy as np

from measures.intonation import NONE
from measures.take import Sound
from yehu_server.core.player.calibration import frequency_hz

REACH_CENTS, STEP_CENTS = 150.0, 1.0
HIGHEST_HZ, MOST = 6000.0, 12  # of the harmonics that count
LEAST_OWN = 0.03  # share of the power that the harmonics must have
LEAST_ODD = 0.01  # share of theirs, of those that a higher register lacks


def overtones_off_by(
    sound: Sound, rate: float, start_s: float, seconds: float, pitch: float
) -> float:
    """Return the error (cents) of a note from its pitch (fractional MIDI note).

    It is that of the harmonic series, within 150 cents, with the largest sum of amplitudes. NONE
    where that is at an end, has less than 3 % of the power, or lacks all harmonics but the
    multiples of 2 or of 3.
    """
    part = sound[round(start_s * rate) : round((start_s + seconds) * rate)].astype(np.float64)
    heard = (part - part.mean()) * np.hanning(len(part))
    wanted = frequency_hz(pitch, 440.0)
    orders = np.arange(1, min(int(HIGHEST_HZ / wanted), MOST) + 1)
    shifts = np.arange(-REACH_CENTS, REACH_CENTS + STEP_CENTS, STEP_CENTS)
    size = 1 << (8 * len(part)).bit_length()
    spectrum = np.abs(np.fft.rfft(heard, size))
    places = wanted * 2.0 ** (shifts[:, np.newaxis] / 1200.0) * orders * size / rate
    amplitudes = np.interp(places, np.arange(len(spectrum)), spectrum)
    sums = amplitudes.sum(axis=1)
    best = int(np.argmax(sums))
    if best in (0, len(shifts) - 1) or not np.any(heard):
        return NONE
    # The power of a line, of that of its Hann window's main lobe.
    own = amplitudes[best] ** 2 * (1.5 * size / len(part))
    frequencies = np.arange(len(spectrum)) * rate / size
    within = (frequencies > 0.5 * wanted) & (frequencies < HIGHEST_HZ)
    if own.sum() < LEAST_OWN * (spectrum[within] ** 2).sum():
        return NONE
    if any(own[orders % n != 0].sum() < LEAST_ODD * own.sum() for n in (2, 3)):
        return NONE
    left, here, right = sums[best - 1 : best + 2]
    return float(shifts[best] + STEP_CENTS * 0.5 * (left - right) / (left - 2.0 * here + right))
