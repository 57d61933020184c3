"""Sine, cosine and powers of two over the ranges that the model needs, and numbers by chance.

Calling the C library makes the processor save its registers, and handles any argument.
Polynomials here are summed in pairs, so that terms can be computed in parallel.
"""

from __future__ import annotations

import math

import numpy as np

from yehu_server.compile.jit import compiled


@compiled
def chance(number: int) -> float:
    """A pseudorandom number in -1..1, the same for the same `number`.

    Source: [SplitMix], its output function.
    """
    x = np.uint64(number) * np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    x = x ^ (x >> np.uint64(31))
    return float(x >> np.uint64(11)) * 2.0**-52 - 1.0


MANTISSA_BITS = 52
EXPONENT_OF_1 = 1023
LEAST_EXPONENT = -900
R_1, R_2, R_3, R_4, R_5 = 1.0 / 2.0, -3.0 / 8.0, 5.0 / 16.0, -35.0 / 128.0, 63.0 / 256.0
SLIGHT = 1e-3  # below it a few terms of the series are exact to rounding

# Minimax polynomials of sin(pi x) / x and cos(pi x) in x^2, for x
# from -1/2 to 1/2 (off by 4e-16 and 2e-15), and of 2^x there (3e-18).
S_0, S_1, S_2, S_3 = 3.1415926535897927, -5.1677127800497855, 2.5501640398618677, -0.599264528825224
S_4, S_5 = 0.08214587881631043, -0.007370364326530415
S_6, S_7 = 0.0004659870158043349, -2.1133627352049886e-05
C_0, C_1, C_2, C_3 = 0.9999999999999981, -4.934802200543686, 4.058712126333295, -1.3352627661817635
C_4, C_5 = 0.23533058831317874, -0.025806531975921556
C_6, C_7 = 0.0019278700526981177, -0.00010041646422052226
P_0, P_1, P_2, P_3 = 1.0, 0.6931471805599453, 0.24022650695910158, 0.055504108664821625
P_4, P_5, P_6 = 0.009618129107587256, 0.001333355814640647, 0.00015403530463724353
P_7, P_8, P_9 = 1.5252733841556773e-05, 1.3215432535912375e-06, 1.0178057087733941e-07
P_10, P_11 = 7.074194297288521e-09, 4.4558179083360645e-10


@compiled
def sine_and_cosine(half_turns: float) -> tuple[float, float]:
    """Sine (to 5e-16) and cosine (to 3e-15) of pi times an argument within -1/2 to 1/2.

    Real time: safe.
    """
    t = half_turns * half_turns
    t_2 = t * t
    t_4 = t_2 * t_2
    sine = (S_0 + S_1 * t) + t_2 * (S_2 + S_3 * t)
    sine += t_4 * ((S_4 + S_5 * t) + t_2 * (S_6 + S_7 * t))
    cosine = (C_0 + C_1 * t) + t_2 * (C_2 + C_3 * t)
    cosine += t_4 * ((C_4 + C_5 * t) + t_2 * (C_6 + C_7 * t))
    return half_turns * sine, cosine


@compiled
def power_of_2(x: float) -> float:
    """Return 2 to the power of `x`, up to 1000; 2 to the power of -900 below that.

    To 4e-16. Real time: safe.
    """
    twos = np.rint(x)
    t = x - twos
    t_2 = t * t
    t_4 = t_2 * t_2
    low = (P_0 + P_1 * t) + t_2 * (P_2 + P_3 * t)
    middle = (P_4 + P_5 * t) + t_2 * (P_6 + P_7 * t)
    high = (P_8 + P_9 * t) + t_2 * (P_10 + P_11 * t)
    exponent = max(np.int64(twos), np.int64(LEAST_EXPONENT))
    scale = np.int64((exponent + EXPONENT_OF_1) << MANTISSA_BITS).view(np.float64)
    return float(scale * ((low + t_4 * middle) + (t_4 * t_4) * high))


@compiled
def one_minus_inverse_root(t: float) -> float:
    """1 - 1 / sqrt(1 + t) for t >= 0, to rounding of the result. Real time: safe."""
    if t < SLIGHT:
        t_2 = t * t
        return float(R_1 * t + t_2 * ((R_2 + R_3 * t) + t_2 * (R_4 + R_5 * t)))
    root = math.sqrt(1.0 + t)
    return t / (root * (1.0 + root))
