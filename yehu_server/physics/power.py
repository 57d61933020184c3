"""One power of many numbers: the exponent is fixed, so tables made once do most of it.

A number is 2^e part, with part within 1 to 2. Intervals divide that range; about the middle
of one, part = middle (1 + t) with a t so small that a few terms of the binomial series do:

    factor x^p = factor 2^(p e) middle^p (1 + p t + p (p - 1)/2 t^2 + ...).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.jit import compiled
from yehu_server.physics.elementary import EXPONENT_OF_1, MANTISSA_BITS
from yehu_server.physics.layout import EXPONENTS, INTERVAL_BITS, INTERVALS, POWER_TERMS

INTERVAL_SHIFT = MANTISSA_BITS - INTERVAL_BITS
MANTISSA_MASK = (1 << MANTISSA_BITS) - 1
BITS_OF_1 = EXPONENT_OF_1 << MANTISSA_BITS
EXTREME = 400  # a power of two that no number of the model comes near


def prepare_power(model: np.void, factor: float, exponent: float) -> None:
    """Write into `model` the tables by which `power` finds `factor` x^`exponent` (0 to 2)."""
    twos = np.clip(np.arange(EXPONENTS) - EXPONENT_OF_1, -EXTREME, EXTREME)
    coarse = float(np.float32(exponent))  # a product with this is not rounded
    model["power_of_twos"] = factor * 2.0 ** (coarse * twos) * 2.0 ** ((exponent - coarse) * twos)
    per_middle = 1.0 / (1.0 + (np.arange(INTERVALS) + 0.5) / INTERVALS)
    model["per_middle"] = per_middle
    model["power_of_middle"] = per_middle**-exponent
    term = 1.0
    for n in range(POWER_TERMS):
        term *= (exponent - n) / (n + 1.0)
        model["power_series"][n] = term


@compiled
def power(model: Any, x: float) -> float:
    """The power that `prepare_power` made tables for, of a positive number, to 6e-16.

    Beyond 1e-120 and 1e120 it stays near to what it is there. Real time: safe.
    """
    bits = np.float64(x).view(np.uint64)
    exponent = (bits >> np.uint64(MANTISSA_BITS)) & np.uint64(EXPONENTS - 1)
    interval = (bits >> np.uint64(INTERVAL_SHIFT)) & np.uint64(INTERVALS - 1)
    part_bits = np.uint64((bits & np.uint64(MANTISSA_MASK)) | np.uint64(BITS_OF_1))
    t = part_bits.view(np.float64) * model.per_middle[interval] - 1.0
    c = model.power_series
    series = (c[0] + c[1] * t) + (t * t) * ((c[2] + c[3] * t) + (t * t) * c[4])
    about = model.power_of_twos[exponent] * model.power_of_middle[interval]
    return float(about + (about * t) * series)
