"""Sine, cosine and exponential for what the model asks of them, without a call.

A call of the C library's makes the processor put away all it holds, and takes any argument.
Polynomials here are summed in pairs, so that their terms need not wait for each other.
"""

from __future__ import annotations

import math

import numpy as np

from yehu_server.jit import compiled

_SINE = [(-1.0) ** n / math.factorial(2 * n + 1) for n in range(8)]
_COSINE = [(-1.0) ** n / math.factorial(2 * n) for n in range(9)]
_POWER_OF_E = [1.0 / math.factorial(n) for n in range(14)]
S_0, S_1, S_2, S_3, S_4, S_5, S_6, S_7 = _SINE
C_0, C_1, C_2, C_3, C_4, C_5, C_6, C_7, C_8 = _COSINE
E_0, E_1, E_2, E_3, E_4, E_5, E_6, E_7, E_8, E_9, E_10, E_11, E_12, E_13 = _POWER_OF_E
LN_2, PER_LN_2 = math.log(2.0), 1.0 / math.log(2.0)
MANTISSA_BITS = 52
EXPONENT_OF_1 = 1023
LEAST = -700.0  # of what `exponential` raises e to


@compiled
def sine_and_cosine(angle: float) -> tuple[float, float]:
    """Sine and cosine of an angle within -pi/2 to pi/2, to 4e-16. Real time: safe."""
    half = 0.5 * angle
    t = half * half
    t_2 = t * t
    t_4 = t_2 * t_2
    sine = (S_0 + S_1 * t) + t_2 * (S_2 + S_3 * t)
    sine += t_4 * ((S_4 + S_5 * t) + t_2 * (S_6 + S_7 * t))
    sine *= half
    cosine = (C_0 + C_1 * t) + t_2 * (C_2 + C_3 * t)
    cosine += t_4 * ((C_4 + C_5 * t) + t_2 * (C_6 + C_7 * t) + t_4 * C_8)
    return 2.0 * sine * cosine, 1.0 - 2.0 * sine * sine


@compiled
def exponential(x: float) -> float:
    """e to the power of `x`, from -700 (what is below counts as that) to 700.

    To 2e-15 for exponents up to 40, less exact as they grow. Real time: safe.
    """
    x = max(x, LEAST)
    twos = np.floor(x * PER_LN_2 + 0.5)
    t = x - twos * LN_2
    t_2 = t * t
    t_4 = t_2 * t_2
    low = (E_0 + E_1 * t) + t_2 * (E_2 + E_3 * t)
    middle = (E_4 + E_5 * t) + t_2 * (E_6 + E_7 * t)
    high = (E_8 + E_9 * t) + t_2 * (E_10 + E_11 * t) + t_4 * (E_12 + E_13 * t)
    power_of_2 = np.int64((np.int64(twos) + EXPONENT_OF_1) << MANTISSA_BITS)
    return float(power_of_2.view(np.float64) * (low + t_4 * (middle + t_4 * high)))
