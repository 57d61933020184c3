"""A shelf: a filter that raises or lowers what lies above a frequency. Compiled.

Of second order, with trapezoidal integrators, so that gain and frequency may move while it sounds.
Source: [Simper].
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.elementary import exp10, sincospi, tan

Array = Any

Q = 1.5  # steeper than a shelf without resonance: a few decibels beyond it on either side
MAX_CORNER_OF_RATE = 0.45  # of the sample rate

SHELF = np.dtype(
    [
        ("rate", np.float64),  # Hz
        ("gain_db", np.float64),  # what the coefficients are for
        ("frequency", np.float64),
        ("a", np.float64, 3),
        ("m", np.float64, 3),
        ("held", np.float64, 2),  # by both integrators
    ],
    align=True,
)


def prepare_shelf(shelf: Any, rate: float) -> None:
    """Prepare a record of dtype SHELF for a sample rate (Hz), in place."""
    shelf["rate"], shelf["frequency"], shelf["held"] = rate, 0.0, 0.0


@compiled
def shelved(s: Any, x: float, gain_db: float, frequency: float) -> float:
    """The next output, with a gain (dB) of what is above a frequency (Hz). Real time: safe."""
    if gain_db != s.gain_db or frequency != s.frequency:
        s.gain_db, s.frequency = gain_db, frequency
        root = exp10(gain_db / 80.0)
        half = root * root  # amplitude, of half the decibels
        g = tan(math.pi * min(frequency / s.rate, MAX_CORNER_OF_RATE)) * root
        s.a[0] = 1.0 / (1.0 + g * (g + 1.0 / Q))
        s.a[1] = g * s.a[0]
        s.a[2] = g * s.a[1]
        s.m[0] = half * half
        s.m[1] = (1.0 - half) * half / Q
        s.m[2] = 1.0 - half * half
    above = x - s.held[1]
    band = s.a[0] * s.held[0] + s.a[1] * above
    low = s.held[1] + s.a[1] * s.held[0] + s.a[2] * above
    s.held[0] = 2.0 * band - s.held[0]
    s.held[1] = 2.0 * low - s.held[1]
    return float(s.m[0] * x + s.m[1] * band + s.m[2] * low)


def shelf_gain(frequencies: Array, rate: float, gain_db: float, frequency: float) -> Array:
    """Amplitude factor at some frequencies (Hz) up to half the sample rate (Hz), closed form."""
    half = exp10(gain_db / 40.0)
    middle = tan(math.pi * min(frequency / rate, MAX_CORNER_OF_RATE))
    sine, cosine = sincospi(np.asarray(frequencies) / rate)
    t = sine / cosine / middle
    t_2 = t * t
    damped = math.sqrt(half) / Q * t
    up, down = 1.0 - half * t_2, half - t_2
    damped = damped * damped
    return half * np.sqrt((up * up + damped) / (down * down + damped))
