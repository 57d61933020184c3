"""The pitch of a sound: an estimator for tests that shares nothing with the package's.

YIN (de Cheveigné and Kawahara, "YIN, a fundamental frequency estimator for speech and music",
JASA 111, 2002): the difference function, normalised by its running mean, falls under a
threshold first at one period. A parabola through the dips at ever more periods refines that.
"""

import math
from typing import Any

import numpy as np

THRESHOLD = 0.15
FRAME_S = 0.06
LOWEST_HZ, HIGHEST_HZ = 80.0, 3000.0


def hertz(note: float) -> float:
    """Frequency of a MIDI note in equal temperament at A4 = 440 Hz."""
    return 440.0 * 2.0 ** ((note - 69.0) / 12.0)


def cents(frequency: Any, reference: Any) -> Any:
    """How far frequencies lie above references."""
    return 1200.0 * np.log2(np.asarray(frequency) / np.asarray(reference))


def difference(samples: np.ndarray, longest: int) -> np.ndarray:
    """Power of the difference between a sound and itself delayed by each lag."""
    window = len(samples) - longest
    head = samples[:window]
    squares = np.concatenate(([0.0], np.cumsum(samples**2)))
    energy = squares[window : window + longest] - squares[:longest]
    size = 2 ** math.ceil(math.log2(len(samples) + window))
    product = np.fft.rfft(samples, size) * np.conj(np.fft.rfft(head, size))
    return energy[0] + energy - 2.0 * np.fft.irfft(product, size)[:longest]


def dip(d: np.ndarray, near: int) -> float:
    """The local minimum next to a lag, by a parabola."""
    left, here, right = d[near - 1 : near + 2]
    return near + 0.5 * (left - right) / (left - 2.0 * here + right)


def frame_pitch(samples: np.ndarray, rate: float, lo: float = LOWEST_HZ) -> float:
    """Fundamental frequency (Hz) of one frame, `lo` at least; NaN where nothing repeats."""
    longest, last = int(rate / LOWEST_HZ) + 2, int(rate / lo) + 1
    d = difference(np.asarray(samples, dtype=np.float64), longest)
    if not d.any():
        return math.nan
    mean = np.cumsum(d[1:]) / np.arange(1, longest)
    normal = np.concatenate(([1.0], d[1:] / mean))
    lag = max(2, int(rate / HIGHEST_HZ))
    while lag < last and normal[lag] >= THRESHOLD:
        lag += 1
    while lag < last and normal[lag + 1] < normal[lag]:
        lag += 1
    if lag >= last:
        return math.nan
    period = dip(d, lag)
    for periods in range(2, int((longest - 2) / period)):
        reach = period / 4.0
        start = int(periods * period - reach)
        stop = min(int(periods * period + reach) + 2, longest - 1)
        period = dip(d, start + int(np.argmin(d[start:stop]))) / periods
    return rate / period


def pitch_of(samples: np.ndarray, rate: float, lo: float = LOWEST_HZ) -> float:
    """Median fundamental frequency (Hz) of a steady sound; NaN where most of it has none."""
    size = int(rate * FRAME_S)
    starts = range(0, len(samples) - size + 1, size // 2)
    found = [frame_pitch(samples[start : start + size], rate, lo) for start in starts]
    voiced = [value for value in found if math.isfinite(value)]
    return float(np.median(voiced)) if 2 * len(voiced) > len(found) else math.nan
