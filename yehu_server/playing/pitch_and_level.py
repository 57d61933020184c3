"""Pitch of a sound, by autocorrelation, and its A-weighted level.

Source: [McLeod], the normalised square difference. Its peak is refined at ever more periods,
where an error of the lag is a smaller error of the pitch.
"""

import math
from typing import Any

import numpy as np

from yehu_server.core.physics.elementary import log2, log10
from yehu_server.util.loudness import a_weighting

Array = Any

LOWEST_HZ, HIGHEST_HZ = 120.0, 2400.0
CLEAR = 0.8  # autocorrelation (1: the same again) under which there is no pitch
NEARLY_BEST = 0.93  # the first peak this near to the highest is the period, not a multiple of it


NOTE_NAMES = ("C", "C#", "D", "D#", "E", "F", "F#", "G", "G#", "A", "A#", "B")


def note_name(pitch: float) -> str:
    """Return the name of a fractional MIDI note, such as ``A4+12`` (cents)."""
    nearest = round(pitch)
    cents = round(100.0 * (pitch - nearest))
    name = NOTE_NAMES[nearest % 12] + str(nearest // 12 - 1)
    return f"{name}{cents:+d}" if cents else name


def cents(frequency_hz: float, reference_hz: float) -> float:
    """Return how far a frequency lies above another (cents)."""
    return 1200.0 * log2(frequency_hz / reference_hz)


def autocorrelation(samples: Array, longest: int) -> Array:
    """Return the normalised autocorrelation of a sound at each lag up to `longest` (frames).

    Returns: ndarray [shape=(longest,)], 1 where it is the same again, 0 where unrelated.
    """
    x = np.asarray(samples, np.float64)
    size = 1 << (2 * len(x) - 1).bit_length()
    spectrum = np.fft.rfft(x, size)
    product = np.fft.irfft(np.abs(spectrum) ** 2, size)[:longest]
    squares = np.concatenate(([0.0], np.cumsum(x * x)))
    lags = np.arange(longest)
    energy = squares[len(x) - lags] + squares[-1] - squares[lags]
    return 2.0 * product / np.maximum(energy, 1e-300)


def pitch_hz(samples: Array, rate: float, lo: float = LOWEST_HZ, hi: float = HIGHEST_HZ) -> float:
    """Return the fundamental frequency (Hz) of a steady sound; NaN where it has none.

    `samples` (ndarray [shape=(frames,)]): at least two periods of `lo`; more are more reliable.
    """
    x = np.asarray(samples, np.float64)
    x = x - x.mean()
    longest = len(x) // 2
    first, last = int(rate / hi), min(int(rate / lo) + 2, longest - 2)
    if last <= first or not np.any(x):
        return math.nan
    like = autocorrelation(x, longest)
    peaks = _peaks(like[: last + 1], max(first, 1))
    if len(peaks) == 0 or like[peaks].max() < CLEAR:
        return math.nan
    best = peaks[like[peaks] >= NEARLY_BEST * like[peaks].max()][0]
    return rate / _refine(like, float(_vertex(like, int(best))))


def _peaks(like: Array, first: int) -> Array:
    inner = np.arange(max(first, 1), len(like) - 1)
    is_peak = (like[inner] > like[inner - 1]) & (like[inner] >= like[inner + 1])
    return inner[is_peak]


def _vertex(like: Array, near: int) -> float:
    """Return the place of the maximum of a parabola through three values."""
    left, here, right = like[near - 1 : near + 2]
    bend = left - 2.0 * here + right
    return near if bend == 0.0 else float(near + 0.5 * (left - right) / bend)


def _refine(like: Array, period: float) -> float:
    periods = 2
    while (periods + 0.25) * period < len(like) - 2:
        reach = 0.25 * period
        start = round(periods * period - reach)
        near = start + int(np.argmax(like[start : round(periods * period + reach) + 1]))
        if like[near] < CLEAR or len(_peaks(like[: near + 2], near)) == 0:
            break
        period = _vertex(like, near) / periods
        periods = max(periods + 1, int(1.5 * periods))
    return period


SILENCE_DB = -200.0


def a_weighted_db(samples: Array, rate: float) -> float:
    """Return the A-weighted root mean square level (dB of full scale) of a steady sound."""
    x = np.asarray(samples, np.float64)
    spectrum = np.fft.rfft(x * np.hanning(len(x)))
    power = np.abs(spectrum * a_weighting(np.fft.rfftfreq(len(x), 1.0 / rate))) ** 2
    mean = 2.0 * power.sum() / (len(x) ** 2 * 0.375)  # 0.375: the window's own power
    return 10.0 * log10(mean) if mean > 0.0 else SILENCE_DB
