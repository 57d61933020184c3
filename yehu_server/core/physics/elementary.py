"""Elementary functions by arithmetic alone, and pseudorandom numbers.

C libraries, and NumPy, differ in their last bits from system to system and from processor to
processor, and a bowed string is chaotic. So whatever reaches a sample is computed by these. Those
of the first half are for the kernel, over the ranges that it needs; those of the second half take
any number, and give the same bits compiled and as Python. Polynomials are summed in pairs, so that
terms can be computed in parallel.
"""

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from yehu_server.compile.jit import arithmetic, compiled


@compiled
def pseudorandom(number: int) -> float:
    """The pseudorandom number, -1 to 1, of an integer, as [SplitMix] has it."""
    x = np.uint64(number) * np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    x = x ^ (x >> np.uint64(31))
    return float(x >> np.uint64(11)) * 2.0**-52 - 1.0


MANTISSA_BITS = 52
EXPONENT_OF_1 = 1023
MIN_EXPONENT, MAX_EXPONENT = -1000.0, 1000.0
R_1, R_2, R_3, R_4, R_5 = 1.0 / 2.0, -3.0 / 8.0, 5.0 / 16.0, -35.0 / 128.0, 63.0 / 256.0
SERIES_BELOW = 1e-3  # below it a few terms of the series are exact to rounding

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


def sincospi(x: Any) -> tuple[Any, Any]:
    """Sine (to 5e-16) and cosine (to 3e-15) of pi times x, which is within -1/2 to 1/2.

    As Python it takes arrays, too. Real time: safe.
    """
    t = x * x
    t_2 = t * t
    t_4 = t_2 * t_2
    sine = (S_0 + S_1 * t) + t_2 * (S_2 + S_3 * t)
    sine += t_4 * ((S_4 + S_5 * t) + t_2 * (S_6 + S_7 * t))
    cosine = (C_0 + C_1 * t) + t_2 * (C_2 + C_3 * t)
    cosine += t_4 * ((C_4 + C_5 * t) + t_2 * (C_6 + C_7 * t))
    return x * sine, cosine


kernel_sincospi = compiled(sincospi)  # for the kernel
sincospi = arithmetic(sincospi)


def exp2(x: float) -> float:
    """Return 2 to the power of `x`, clamped to -1000..1000, to 4e-16. Real time: safe."""
    if math.isnan(x):  # NaN cannot be rounded
        return x
    x = min(max(x, MIN_EXPONENT), MAX_EXPONENT)
    exponent = np.rint(x)
    t = x - exponent
    t_2 = t * t
    t_4 = t_2 * t_2
    low = (P_0 + P_1 * t) + t_2 * (P_2 + P_3 * t)
    middle = (P_4 + P_5 * t) + t_2 * (P_6 + P_7 * t)
    high = (P_8 + P_9 * t) + t_2 * (P_10 + P_11 * t)
    scale = np.int64((np.int64(exponent) + EXPONENT_OF_1) << MANTISSA_BITS).view(np.float64)
    return float(scale * ((low + t_4 * middle) + (t_4 * t_4) * high))


kernel_exp2 = compiled(exp2)  # for the kernel
exp2 = arithmetic(exp2)


@compiled
def one_minus_inverse_root(t: float) -> float:
    """1 - 1 / sqrt(1 + t) for t >= 0, to rounding of the result. Real time: safe."""
    if t < SERIES_BELOW:
        t_2 = t * t
        return float(R_1 * t + t_2 * ((R_2 + R_3 * t) + t_2 * (R_4 + R_5 * t)))
    root = math.sqrt(1.0 + t)
    return t / (root * (1.0 + root))


# ---------------------------------------------------------------- for any argument

# The natural logarithm of 2 in two parts, the first of few bits: products with whole numbers are
# exact.
LN_2, LN_2_HIGH, LN_2_LOW = 0.6931471805599453, 0.693147180369123816490, 1.90821492927058770002e-10
LN_10, MAX_EXP_ARGUMENT = 2.302585092994046, 690.0
BITS_OF_ROOT_HALF = 0x3FE6A09E667F3BCD  # of the square root of 1/2
# Minimax polynomial of asin(x) / x in x^2, for x from -1/2 to 1/2 (off by 2e-17).
ASIN_COEFFICIENTS = (
    1.0,
    0.16666666666664942,
    0.07500000000385201,
    0.044642856805998936,
    0.03038195969768514,
    0.022371749733164054,
    0.01735977964134998,
    0.01388484282640208,
    0.012170138592391726,
    0.0065293020047365695,
    0.019513468251252167,
    -0.016187392271599134,
    0.03187962140081284,
)


@arithmetic
def exp(x: float) -> float:
    """Return e to the power of `x`, clamped to -690..690, to 6e-16. Real time: safe."""
    x = min(max(x, -MAX_EXP_ARGUMENT), MAX_EXP_ARGUMENT)
    exponent = np.rint(x / LN_2)
    return float(exp2(exponent) * exp2(((x - exponent * LN_2_HIGH) - exponent * LN_2_LOW) / LN_2))


@arithmetic
def exp10(x: float) -> float:
    """Return 10 to the power of `x`; see `exp`."""
    return float(exp(x * LN_10))


@arithmetic
def exponent_and_log(x: Any) -> tuple[Any, Any]:
    """Exponent of 2, and natural logarithm of the mantissa, of a positive normal number.

    The mantissa is between the roots of 1/2 and of 2.
    As Python it takes arrays, too.
    """
    bits = np.float64(x).view(np.int64)
    exponent = (bits - BITS_OF_ROOT_HALF) >> MANTISSA_BITS
    mantissa = np.int64(bits - (exponent << MANTISSA_BITS)).view(np.float64)
    # log((1 + s) / (1 - s)) = 2 (s + s^3/3 + s^5/5 + ...)
    s = (mantissa - 1.0) / (mantissa + 1.0)
    t = s * s
    series = 1.0 / 21.0
    for n in range(9, 0, -1):
        series = series * t + 1.0 / (2.0 * n + 1.0)
    return exponent, 2.0 * s + 2.0 * s * t * series


@arithmetic
def log(x: float) -> float:
    """Return the natural logarithm, of normal numbers to 4e-16. Real time: safe.

    It is minus infinity at 0, and not a number below.
    """
    if not 0.0 < x < math.inf:
        return -math.inf if x == 0.0 else (x if x > 0.0 else math.nan)
    exponent, rest = exponent_and_log(x)
    return float(exponent * LN_2_HIGH + (rest + exponent * LN_2_LOW))


@arithmetic
def log2(x: float) -> float:
    """Return the logarithm to base 2; see `log`. That of a power of two is exact."""
    if not 0.0 < x < math.inf:
        return log(x)
    exponent, rest = exponent_and_log(x)
    return float(exponent + rest / LN_2)


@arithmetic
def log10(x: float) -> float:
    """Return the logarithm to base 10; see `log`."""
    return float(log(x) / LN_10)


@arithmetic
def power(x: float, y: float) -> float:
    """Return a positive number to the power of `y`, to some units in the last place."""
    return float(exp(y * log(x)))


@arithmetic
def sin_and_cos(x: float) -> tuple[float, float]:
    """Sine and cosine of an angle (rad), to 4e-16 and that times `x`. Real time: safe."""
    turns = x / math.pi
    whole = np.rint(turns)
    sine, half = sincospi(turns - whole)[0], sincospi(0.5 * (turns - whole))[0]
    sign = 1.0 - 2.0 * (whole - 2.0 * math.floor(0.5 * whole))
    return float(sign * sine), float(sign * (1.0 - 2.0 * half * half))


@arithmetic
def sin(x: float) -> float:
    """Sine of an angle; see `sin_and_cos`."""
    return float(sin_and_cos(x)[0])


@arithmetic
def cos(x: float) -> float:
    """Cosine of an angle; see `sin_and_cos`."""
    return float(sin_and_cos(x)[1])


@arithmetic
def tan(x: float) -> float:
    """Tangent of an angle; see `sin_and_cos`."""
    sine, cosine = sin_and_cos(x)
    return float(sine / cosine)


@arithmetic
def asin(x: float) -> float:
    """Return the angle (rad) whose sine is `x`, -1 to 1, to 4e-16. Real time: safe."""
    magnitude = abs(x)
    t = x * x if magnitude <= 0.5 else 0.5 * (1.0 - magnitude)
    root = magnitude if magnitude <= 0.5 else math.sqrt(t)
    series = 0.0
    for term in ASIN_COEFFICIENTS[::-1]:
        series = series * t + term
    angle = root * series
    angle = angle if magnitude <= 0.5 else 0.5 * math.pi - 2.0 * angle
    return float(angle if x >= 0.0 else -angle)


@arithmetic
def tanh(x: float) -> float:
    """Return the hyperbolic tangent, to 6e-16. Real time: safe."""
    if abs(x) > 20.0:
        return 1.0 if x > 0.0 else -1.0
    if abs(x) > 0.5:
        twice = exp(2.0 * x)
        return float((twice - 1.0) / (twice + 1.0))
    t = x * x  # its continued fraction
    return float(x / (1.0 + t / (3.0 + t / (5.0 + t / (7.0 + t / (9.0 + t / (11.0 + t / 13.0)))))))


def decibels(power: Any) -> Any:
    """Return ten times the logarithm to base 10 of each number of an array, as Python."""
    exponent, rest = exponent_and_log(power)
    return 10.0 / LN_10 * (exponent * LN_2 + rest)


def elementwise(function: Callable[[float], float], values: Iterable[float]) -> Any:
    """Apply a scalar function to each element of an array; not compiled."""
    array = np.asarray(values, np.float64)
    return np.array([function(x) for x in array.ravel().tolist()]).reshape(array.shape)
