"""Schelleng's limits of the bow force: between them Helmholtz motion is possible. Compiled.

Source: [Schelleng].
"""

from __future__ import annotations

import math
from typing import Any

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.elementary import tan


@compiled
def bridge_resistance(m: Any, f: float) -> float:
    """Return the resistance R (kg/s) of Schelleng's lower limit: Re(1/Y) at the fundamental f (Hz).

    Y is the admittance of the bridge, the sum over the body's modes of
    j w / (K_m - M_m w^2 + j w R_m). Schelleng's bridge is a pure resistance, for which Re(1/Y)
    equals 1/Re(Y). Between its modes this bridge is mostly mass or spring, and Re(1/Y) is much
    smaller than 1/Re(Y). This makes the limit high, and close to that of the model, where finger
    and strings lose energy too. In the scheme w is (2/k) tan(pi f k), as the modes are pre-warped.

    Parameters
    ----------
    m : record of layout.MODEL
    """
    w = 2.0 / m.k * tan(math.pi * f * m.k)
    real, imaginary = 0.0, 0.0
    for i in range(m.modes):
        spring = m.K_m[i] - m.M_m[i] * w * w
        loss = w * m.R_m[i]
        size = spring * spring + loss * loss
        real += w * loss / size
        imaginary += w * spring / size
    return float(real / (real * real + imaginary * imaginary))


@compiled
def upper_limit(Z: float, grip: float, v_b: float, beta: float) -> float:
    """Return the largest bow force (N).

    Parameters
    ----------
    Z : float
        Wave impedance of the string (kg/s).
    grip : float
        mu_S - mu_C.
    v_b : float
        Bow speed (m/s).
    beta : float
        Bow position.
    """
    return 2.0 * Z * v_b / (beta * grip)


@compiled
def lower_limit(Z: float, grip: float, R: float, v_b: float, beta: float) -> float:
    """Return the least bow force (N); R is the resistance of the bridge (kg/s)."""
    return Z * Z * v_b / (2.0 * R * beta * beta * grip)
