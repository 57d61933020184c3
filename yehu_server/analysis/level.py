"""A-weighted level of a sound."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

Array = Any

SILENCE_DB = -200.0


def a_weighting(frequencies_hz: Array) -> Array:
    """Return the amplitude factor of A weighting, 1 at 1 kHz. Source: [IEC61672]."""
    f2 = np.asarray(frequencies_hz, np.float64) ** 2
    curve = (12194.0**2 * f2 * f2) / (
        (f2 + 20.6**2) * np.sqrt((f2 + 107.7**2) * (f2 + 737.9**2)) * (f2 + 12194.0**2)
    )
    return curve * 10.0 ** (2.0 / 20.0)


def a_weighted_db(samples: Array, rate: float) -> float:
    """Return the A-weighted root mean square level (dB of full scale) of a steady sound."""
    x = np.asarray(samples, np.float64)
    spectrum = np.fft.rfft(x * np.hanning(len(x)))
    power = np.abs(spectrum * a_weighting(np.fft.rfftfreq(len(x), 1.0 / rate))) ** 2
    mean = 2.0 * power.sum() / (len(x) ** 2 * 0.375)  # 0.375: the window's own power
    return 10.0 * math.log10(mean) if mean > 0.0 else SILENCE_DB
