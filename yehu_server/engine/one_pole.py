"""The one-pole low-pass filter, for values that follow others smoothly. Compiled.

``y[n] = y[n-1] + a (x[n] - y[n-1])``: the pole of its transfer function lies at 1 - a.
"""

from __future__ import annotations

import math

from yehu_server.jit import compiled


def pole_of_time(seconds: float, rate: float) -> float:
    """The pole of a filter with a time constant (s), at a sample rate (Hz)."""
    return math.exp(-1.0 / (seconds * rate))


def pole_of_cutoff(frequency: float, rate: float) -> float:
    """The pole of a filter with a cutoff (Hz) far below the sample rate (Hz)."""
    return math.exp(-2.0 * math.pi * frequency / rate)


@compiled
def one_pole(y: float, x: float, a: float) -> float:
    """The next output: after the output `y`, for the input `x`. Real time: safe.

    Parameters
    ----------
    a : float
        1 less the pole, from 0 (nothing changes) to 1 (the output is the input).
    """
    return y + a * (x - y)
