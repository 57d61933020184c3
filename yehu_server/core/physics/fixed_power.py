"""One power of many numbers: the exponent is fixed, so tables made once do most of it.

A number is 2^e part, with part within 1 to 2. Intervals divide that range; about the midpoint
of one, part = midpoint (1 + t) with a t so small that a few terms of the binomial series do:

    factor x^p = factor 2^(p e) midpoint^p (1 + p t + p (p - 1)/2 t^2 + ...).
"""

from functools import lru_cache

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.elementary import EXPONENT_OF_1, MANTISSA_BITS, elementwise, exp2
from yehu_server.core.physics.elementary import power as power_of
from yehu_server.core.physics.records import Tables

EXPONENT_COUNT = 2048  # of all floats
INTERVAL_BITS = 7
INTERVALS = 1 << INTERVAL_BITS
TERMS = 5
INTERVAL_SHIFT = MANTISSA_BITS - INTERVAL_BITS
MANTISSA_MASK = (1 << MANTISSA_BITS) - 1
BITS_OF_1 = EXPONENT_OF_1 << MANTISSA_BITS
EXTREME_EXPONENT = 400  # a power of two that no number of the model comes near

TABLES = np.dtype(
    [
        ("series", np.float64, TERMS),
        ("of_exponent", np.float64, EXPONENT_COUNT),
        ("per_midpoint", np.float64, INTERVALS),
        ("of_midpoint", np.float64, INTERVALS),
    ],
    align=True,
)


def prepare_power(tables: np.void, factor: float, exponent: float) -> None:
    """Write the tables by which `power` finds `factor` x^`exponent` (0 to 2)."""
    made = tables_of(exponent)
    for name in TABLES.names or ():
        tables[name] = made[name][0]
    tables["of_exponent"] *= factor


@lru_cache(maxsize=16)
def tables_of(exponent: float) -> np.ndarray:
    """Return the tables of x^`exponent` [shape=(1,)]: most of the time that an instrument takes."""
    made = np.zeros(1, TABLES)
    tables = made[0]
    twos = np.arange(-EXTREME_EXPONENT, EXTREME_EXPONENT + 1)
    coarse = float(np.float32(exponent))  # a product with this is not rounded
    of_exponent = elementwise(exp2, coarse * twos) * elementwise(exp2, (exponent - coarse) * twos)
    known = (
        np.clip(np.arange(EXPONENT_COUNT) - EXPONENT_OF_1, -EXTREME_EXPONENT, EXTREME_EXPONENT)
        + EXTREME_EXPONENT
    )
    tables["of_exponent"] = of_exponent[known]
    per_midpoint = 1.0 / (1.0 + (np.arange(INTERVALS) + 0.5) / INTERVALS)
    tables["per_midpoint"] = per_midpoint
    tables["of_midpoint"] = [power_of(x, -exponent) for x in per_midpoint.tolist()]
    term = 1.0
    for n in range(TERMS):
        term *= (exponent - n) / (n + 1.0)
        tables["series"][n] = term
    return made


@compiled
def power(tables: Tables, x: float) -> float:
    """Return the power that `prepare_power` made tables for, of a positive number, to 1.3e-15.

    Below 1e-120 and above 1e120 it is about what it is there. Real time: safe.
    """
    bits = np.float64(x).view(np.uint64)
    exponent = (bits >> np.uint64(MANTISSA_BITS)) & np.uint64(EXPONENT_COUNT - 1)
    interval = (bits >> np.uint64(INTERVAL_SHIFT)) & np.uint64(INTERVALS - 1)
    part_bits = np.uint64((bits & np.uint64(MANTISSA_MASK)) | np.uint64(BITS_OF_1))
    t = part_bits.view(np.float64) * tables.per_midpoint[interval] - 1.0
    c = tables.series
    series = (c[0] + c[1] * t) + (t * t) * ((c[2] + c[3] * t) + (t * t) * c[4])
    nearby = tables.of_exponent[exponent] * tables.of_midpoint[interval]
    return float(nearby + (nearby * t) * series)
