"""A one-pole low-pass filter: ``y[n] = y[n-1] + a (x[n] - y[n-1])``. Compiled.

Its pole is at 1 - a.
"""

from __future__ import annotations

import math

from yehu_server.jit import compiled


def pole_of_time(seconds: float, rate: float) -> float:
    """Pole of the filter with a time constant (s), at a sample rate (Hz)."""
    return math.exp(-1.0 / (seconds * rate))


def pole_of_cutoff(frequency: float, rate: float) -> float:
    """Pole of the filter with a cutoff frequency (Hz) far below the sample rate (Hz)."""
    return math.exp(-2.0 * math.pi * frequency / rate)


@compiled
def one_pole(y: float, x: float, a: float) -> float:
    """Compute the next output. Real time: safe.

    Parameters
    ----------
    y, x : float
        The last output, and the input.
    a : float
        1 less the pole: from 0 (the output is held) to 1 (the output is the input).
    """
    return y + a * (x - y)
