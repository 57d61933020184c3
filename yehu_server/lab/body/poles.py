"""Starting poles of a body's modes, by the least-squares complex frequency method (LSCF)."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.lab.body.curve import Complexes, Floats, interpolated
from yehu_server.util.extras import need

HIGHEST_ORDER = 40  # of the polynomials; each order gives candidates
MOST_LINES = 4000  # of the even grid that the method needs
LEAST_DAMPING, MOST_DAMPING = 5e-4, 0.3  # damping ratios
BESIDE = 1.05  # how far outside the band a pole may lie
SAME_HZ, SAME_DAMPING = 0.002, 0.15  # relative: poles of two orders that are one candidate


def starting_poles(frequency_hz: Floats, mobility: Complexes) -> tuple[Floats, Floats]:
    """Candidates for modes: what LSCF of any order takes for a pole.

    Parameters
    ----------
    frequency_hz : ndarray [shape=(lines,)]
        Rising; any spacing.
    mobility : ndarray [shape=(lines,)]
        Velocity per force (s/kg).

    Returns
    -------
    frequency_hz : ndarray [shape=(candidates,)]
    damping : ndarray [shape=(candidates,)]
        Damping ratios, 1 / 2Q.

    Notes
    -----
    Source: P. Guillaume and others, the least-squares complex frequency-domain estimator (IMAC
    2003), as sdypy-EMA has it. It wants an even grid, so an uneven one is interpolated. Poles of
    different orders that agree are given once.
    """
    need("sdypy.EMA", "the body workshop", "body")
    from sdypy.EMA import Model

    lo, hi = float(frequency_hz[0]), float(frequency_hz[-1])
    lines = min(MOST_LINES, max(len(frequency_hz), 4 * HIGHEST_ORDER))
    grid = np.linspace(lo, hi, lines)
    even = interpolated(grid, frequency_hz, mobility)[np.newaxis]
    form: Any = {"pol_order_high": HIGHEST_ORDER, "frf_form": "mobility"}
    model = Model(even, grid, lower=lo, upper=hi, **form)
    model.get_poles(method="lscf", show_progress=False)
    found_hz = np.concatenate([np.asarray(row).real for row in model.pole_freq])
    damping = np.concatenate([np.asarray(row).real for row in model.pole_xi])
    usable = (found_hz > lo / BESIDE) & (found_hz < hi * BESIDE)
    usable &= (damping > LEAST_DAMPING) & (damping < MOST_DAMPING)
    return _once(found_hz[usable], damping[usable])


def _once(frequency_hz: Floats, damping: Floats) -> tuple[Floats, Floats]:
    """Leave out poles that are as another, found by a higher order."""
    kept: list[tuple[float, float]] = []
    for hz, ratio in zip(frequency_hz[::-1], damping[::-1], strict=True):
        if all(
            abs(hz / other - 1.0) > SAME_HZ or abs(np.log(ratio / its)) > SAME_DAMPING
            for other, its in kept
        ):
            kept.append((float(hz), float(ratio)))
    table = np.array(kept).reshape(-1, 2)
    return table[:, 0], table[:, 1]
