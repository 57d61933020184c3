"""The grid of one string: the finest that is stable."""

from __future__ import annotations

import math

from yehu_server.errors import ParameterError
from yehu_server.physics.layout import MAX_INTERVALS
from yehu_server.physics.quantities import StringQuantities

LOWEST_RATE, HIGHEST_RATE = 22050.0, 192000.0  # Hz


def least_spacing(string: StringQuantities, k: float, headroom: float = 1.0) -> float:
    """Return the smallest stable grid spacing h_min (m) for time step `k` (s).

    `headroom` multiplies the tension: the grid stays stable up to there.
    Source: [Yehu] eq. (57); Differs: its term in sigma_1 is 2 k sigma_1, see docs/physics.md.
    """
    c_squared = headroom * string.T / string.rho_A
    kappa_squared = string.EI / string.rho_A
    return math.sqrt(
        c_squared * k**2 / 2.0
        + 2.0 * k * string.sigma_1
        + k / 2.0 * math.sqrt((c_squared * k + 4.0 * string.sigma_1) ** 2 + 16.0 * kappa_squared)
    )


def intervals(string: StringQuantities, k: float, headroom: float = 1.0) -> int:
    """Return N, the number of grid intervals of a string; its spacing is then L/N.

    Raises
    ------
    ParameterError
        Where the string gets too few or too many nodes.
    """
    N = math.floor(string.L / least_spacing(string, k, headroom))
    if not 12 <= N <= MAX_INTERVALS:
        raise ParameterError(
            f"a string of {string.L} m needs {N} grid intervals at {1.0 / k:.0f} Hz; "
            f"12 to {MAX_INTERVALS} are possible"
        )
    return N


def check_rate(rate: float) -> None:
    """Refuse a sample rate (Hz) outside 22,050 to 192,000.

    Raises
    ------
    ParameterError
        With the range.
    """
    if not LOWEST_RATE <= rate <= HIGHEST_RATE:
        raise ParameterError(
            f"sample rate: {rate} Hz is not within {LOWEST_RATE:g} to {HIGHEST_RATE:g} Hz"
        )
