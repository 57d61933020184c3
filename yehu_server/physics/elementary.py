"""Sine, cosine, exponential and power for what the model asks of them, without a call.

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
_AREA_TANGENT = [2.0 / (2.0 * n + 1.0) for n in range(11)]
S_0, S_1, S_2, S_3, S_4, S_5, S_6, S_7 = _SINE
C_0, C_1, C_2, C_3, C_4, C_5, C_6, C_7, C_8 = _COSINE
E_0, E_1, E_2, E_3, E_4, E_5, E_6, E_7, E_8, E_9, E_10, E_11, E_12, E_13 = _POWER_OF_E
L_0, L_1, L_2, L_3, L_4, L_5, L_6, L_7, L_8, L_9, L_10 = _AREA_TANGENT
LN_2, PER_LN_2 = math.log(2.0), 1.0 / math.log(2.0)
MANTISSA_BITS = 52
EXPONENT_OF_1 = 1023
BITS_OF_ROOT_HALF = int(np.float64(math.sqrt(0.5)).view(np.int64))
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


@compiled
def logarithm(x: float) -> float:
    """Natural logarithm of a positive number that is not denormal, to 4e-16 (of 1 or more).

    Real time: safe.
    """
    bits = np.float64(x).view(np.int64)
    twos = (bits - BITS_OF_ROOT_HALF) >> MANTISSA_BITS
    part = np.int64(bits - (twos << MANTISSA_BITS)).view(np.float64)  # within 0.707 to 1.414
    w = (part - 1.0) / (part + 1.0)
    t = w * w
    t_2 = t * t
    t_4 = t_2 * t_2
    low = (L_0 + L_1 * t) + t_2 * (L_2 + L_3 * t)
    high = (L_4 + L_5 * t) + t_2 * (L_6 + L_7 * t) + t_4 * ((L_8 + L_9 * t) + t_2 * L_10)
    return float(twos * LN_2 + w * (low + t_4 * high))


@compiled
def power(x: float, exponent: float) -> float:
    """A positive number that is not denormal, to a power. Real time: safe."""
    return exponential(exponent * logarithm(x))
