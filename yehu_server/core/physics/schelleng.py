"""Schelleng's limits of the bow force: between them Helmholtz motion can last. Compiled.

Schelleng's bridge is a pure resistance R. Here the string loses energy to a bridge with modes, to
the finger, and by itself; R is that of a bridge that would ask for the same force. Both ends of the
string bear the force of Helmholtz motion, whose n-th partial goes as 1/n, and move by it; the bow's
friction has to make up for it. Where the sum over partials of Re(Y_n) (1 - cos 2 pi n t)/n^2 is
largest within a period, the string lets go too soon, unless it is held by the least force
[Woodhouse]. For a pure resistance this is Schelleng's limit.

The limit is of a motion that is there. To begin one from rest takes more (docs/validation.md).

Source: [Schelleng]; [Woodhouse].
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.elementary import cos, sin, tan

PARTIALS = 7  # about 1/beta: the bow is near a node of those above
PHASES = 16  # of half a period
MAX_OF_RATE = 0.4  # of the sample rate: partials above are left out


@compiled
def bridge_conductance(m: Any, f: float) -> float:
    """Return Re(Y) of the bridge (s/kg) at a frequency (Hz).

    Y is the sum over the body's modes of j w/(K_m - M_m w^2 + j w R_m). In the scheme w is (2/k)
    tan(pi f k), as the modes are pre-warped.
    """
    w, total = 2.0 / m.k * tan(math.pi * f * m.k), 0.0
    for i in range(m.modes):
        spring, loss = m.K_m[i] - m.M_m[i] * w * w, w * m.R_m[i]
        total += w * loss / (spring * spring + loss * loss)
    return float(total)


@compiled
def finger_conductance(m: Any, i: int, f: float, x_f: float, press: float) -> float:
    """Return Re(Y) of the finger's end of string `i` (s/kg) at a frequency (Hz).

    Half the press is on each string, where the contact is a dashpot beta F; its stiffness is small
    beside that. Behind it move the finger's mass and the other string. The string ends at the loop,
    behind the finger.
    """
    w, Z = 2.0 * math.pi * f, math.sqrt(m.T[i] * m.rho_A[i])
    R = 0.5 * m.beta * press
    other = 2.0 * math.sqrt(m.T[1 - i] * m.rho_A[1 - i])
    held, X = R * other / (R + other), w * m.M_f
    size = (R + held) ** 2 + X * X
    real, imaginary = R * (held * (R + held) + X * X) / size, R * R * X / size
    turn = w * x_f * math.sqrt(m.rho_A[i] / m.T[i])
    sine, cosine = sin(turn), cos(turn)
    across = real * sine * real * sine + (imaginary * sine - Z * cosine) ** 2
    return float(sine * sine * real / across)


@compiled
def resistance(m: Any, i: int, f: float, x_f: float, press: float) -> float:
    """The resistance R (kg/s) of Schelleng's lower limit, for a note (Hz) of string `i`.

    `x_f` (m) and `press` (N) are the nearest finger's; no press on an open string.
    """
    Z = math.sqrt(m.T[i] * m.rho_A[i])
    per_length = math.pi / (m.bridge_x - (x_f if press > 0.0 else 0.0))
    most, pure = 1e-12, 0.0
    for phase in range(1, PHASES + 1):
        total, pure = 0.0, 0.0
        for n in range(1, PARTIALS + 1):
            if n > 1 and n * f > MAX_OF_RATE * m.rate:
                break
            Y = bridge_conductance(m, n * f)
            Y += (m.sigma_0[i] + m.sigma_1[i] * (n * per_length) ** 2) / (2.0 * f * Z)
            if press > 0.0:
                Y += finger_conductance(m, i, n * f, x_f, press)
            rise = (1.0 - cos(math.pi * n * phase / PHASES)) / (n * n)
            total += Y * rise
            pure += rise
        most = max(most, total)
    return float(pure / most)


@compiled
def upper_limit(Z: float, grip: float, v_b: float, beta: float) -> float:
    """The largest bow force (N), for Z (kg/s), mu_S - mu_C, bow speed (m/s) and position."""
    return 2.0 * Z * v_b / (beta * grip)


@compiled
def lower_limit(Z: float, grip: float, R: float, v_b: float, beta: float) -> float:
    """Return the least bow force (N) that keeps Helmholtz motion; R is that of `resistance`."""
    return Z * Z * v_b / (2.0 * R * beta * beta * grip)
