"""Torsion: a bow rubs the surface of a string, and so twists it.

The friction force f_b also is a torque r f_b. The surface moves by w = r theta besides the string's
own u, and w obeys a wave equation of its own, with half the string's mass per length and the speed
sqrt(G/rho). In modes, w = sum of q_n sin(n pi x/x_c), from the loop to the bridge, both of which
hold the surface:

    M (q_n'' + omega_n/Q_t q_n' + omega_n^2 q_n) = -f_b sin(n pi x_b/x_c),    M = rho A x_c/4.

Friction sees u + w, so torsion is one more compliance under the bow. The scheme has the poles of
each mode, and its response to an impulse, without error. The finger nearest to the bridge that
presses a string drags on its surface as a dashpot.

Differs: [Yehu] has no torsion.
Source: [Mansour]; [Euphonics] 9.5.3. Derivation: docs/derivation.md, section 8.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.elementary import cos, elementwise, exp, kernel_sincospi, sin, tanh
from yehu_server.core.physics.layout import LEVELS, MAX_TWISTS, STRINGS, VECTOR
from yehu_server.core.physics.records import Array, Contacts, Model, Refined, Work
from yehu_server.errors import ParameterError

MAX_OF_NYQUIST = 0.9  # of half the sample rate: modes above are left out
# Denormal numbers would cost a hundred times the others.
NEGLIGIBLE_M = 1e-30


def prepare_torsion(refined: Any, quantities: Quantities, k: float) -> None:
    """Write the torsional modes of both strings into `refined`, for a time step (s).

    Raises ParameterError where no mode is low enough for the sample rate.
    """
    refined["R_skin"] = quantities.finger.R_t
    x_c, most = quantities.bridge_x, 0
    for i, string in enumerate(quantities.strings):
        omega = np.pi * np.arange(1, MAX_TWISTS + 1) / x_c * math.sqrt(string.G / string.rho)
        omega = omega[omega * k < MAX_OF_NYQUIST * np.pi]
        if len(omega) == 0:
            raise ParameterError(
                f"string_{i + 1}: G {string.G:g} Pa puts its torsional modes above this sample rate"
            )
        sigma = omega / (2.0 * string.Q_t)
        ringing = np.sqrt(omega**2 - sigma**2)
        decay, loss = elementwise(exp, -sigma * k), elementwise(tanh, sigma * k)
        modes = slice(0, len(omega))
        # q[n+1] = A q[n] + B q[n-1] + C f is sampled from the mode that k f sets off.
        A = 2.0 * decay * elementwise(cos, ringing * k)
        C = 4.0 * k / (string.rho_A * x_c) * decay * elementwise(sin, ringing * k) / ringing
        refined["A_t"][i, modes], refined["B_t"][i, modes] = A, -(decay**2)
        refined["C_t"][i, modes] = C
        # The same as M delta_tt q + R delta_t. q + K q = f, for the ledger.
        M = k * k / (C * (1.0 + loss))
        refined["M_t"][i, modes], refined["R_t"][i, modes] = M, 2.0 * M * loss / k
        refined["K_t"][i, modes] = M / (k * k) * (2.0 - A * (1.0 + loss))
        most = max(most, len(omega))
    refined["twists"] = -(-most // VECTOR) * VECTOR


def largest_yielding(refined: np.void) -> float:
    """Return how far a newton moves the surface by torsion within a step, at most (m)."""
    shapes = elementwise(
        sin, math.pi * np.outer(np.linspace(0.0, 0.5, 101), np.arange(1, MAX_TWISTS + 1))
    )
    return float((shapes[:, np.newaxis] ** 2 * refined["C_t"]).sum(axis=2).max())


@compiled
def place_twist(m: Model, t: Refined, place: int, x: float) -> None:
    """Write sin(n pi x/x_c) of all modes for a place (m), where it has changed."""
    if t.twist_x[place] == x:
        return
    t.twist_x[place] = x
    part = max(0.0, min(x / m.bridge_x, 1.0))
    minus_cosine, sine = kernel_sincospi(part - 0.5)  # -cos(pi part) and sin(pi part)
    before, shape = 0.0, sine
    for n in range(MAX_TWISTS):
        t.twist_shapes[place, n] = shape
        before, shape = shape, -2.0 * minus_cosine * shape - before


@compiled
def read_twist(t: Refined, shapes: Array, twist: Array) -> float:
    """Return w where the modes have these shapes (m)."""
    total = 0.0
    for n in range(t.twists):
        total += shapes[n] * twist[n]
    return total


@compiled
def twist_travel(t: Refined, i: int, place: int, next_: int) -> float:
    """Return how far the surface of string `i` has turned in two samples, at a place (m)."""
    prev = (next_ + 1) % LEVELS
    shapes = t.twist_shapes[place]
    return read_twist(t, shapes, t.twist[next_, i]) - read_twist(t, shapes, t.twist[prev, i])


@compiled
def advance_torsion(
    m: Model, t: Refined, c: Contacts, w: Work, near: int, next_: int, now: int, prev: int
) -> None:
    """Advance the torsion of both strings free of the bow, but with the drag of the fingers."""
    for i in range(STRINGS):
        for n in range(t.twists):
            free = t.A_t[i, n] * t.twist[now, i, n] + t.B_t[i, n] * t.twist[prev, i, n]
            t.twist[next_, i, n] = free if abs(free) > NEGLIGIBLE_M else 0.0
        t.skin_drag[i] = 0.0
        for a in range(near):  # from the loop to the bridge: the last one holds the string
            p = STRINGS * c.candidates[a] + i
            if w.ghat[p] > 0.0:
                t.skin_drag[i] = 0.5 * m.rate * t.R_skin
                place_twist(m, t, i, c.x[p])
        if t.skin_drag[i] > 0.0:
            compliance = 0.0
            for n in range(t.twists):
                compliance += t.C_t[i, n] * t.twist_shapes[i, n] ** 2
            t.skin_drag[i] /= 1.0 + t.skin_drag[i] * compliance
            force = t.skin_drag[i] * twist_travel(t, i, i, next_)
            for n in range(t.twists):
                t.twist[next_, i, n] -= t.C_t[i, n] * t.twist_shapes[i, n] * force


@compiled
def yield_to_point(m: Model, t: Refined, i: int, e: int, x: float) -> None:
    """Write how far a newton at point `e` (at x m) moves each mode, the finger's drag in place."""
    place_twist(m, t, STRINGS + e, x)
    shapes, held, moved = t.twist_shapes[STRINGS + e], t.twist_shapes[i], t.twist_per_newton[e]
    coupling = 0.0
    for n in range(t.twists):
        coupling += t.C_t[i, n] * shapes[n] * held[n]
    coupling *= t.skin_drag[i]
    for n in range(t.twists):
        moved[n] = t.C_t[i, n] * (shapes[n] - coupling * held[n])


@compiled
def move_twist(t: Refined, i: int, e: int, next_: int, f: float) -> None:
    """Twist string `i` by the force at point `e` (N)."""
    for n in range(t.twists):
        t.twist[next_, i, n] -= t.twist_per_newton[e, n] * f


# ---------------------------------------------------------------- for the ledger


@compiled
def torsion_energy(m: Model, t: Refined, i: int, next_: int, now: int) -> float:
    """Return the torsional energy of string `i` at n + 1/2 (J)."""
    total = 0.0
    for n in range(t.twists):
        q_next, q = t.twist[next_, i, n], t.twist[now, i, n]
        total += 0.5 * t.M_t[i, n] * (m.rate * (q_next - q)) ** 2 + 0.5 * t.K_t[i, n] * q_next * q
    return total


@compiled
def torsion_loss(m: Model, t: Refined, i: int, next_: int, prev: int) -> float:
    """Return what the torsion of string `i` loses by itself (W)."""
    total = 0.0
    for n in range(t.twists):
        velocity = 0.5 * m.rate * (t.twist[next_, i, n] - t.twist[prev, i, n])
        total += t.R_t[i, n] * velocity**2
    return total


@compiled
def skin_loss(m: Model, t: Refined, i: int, next_: int) -> float:
    """Return what a finger's drag takes from the torsion of string `i` (W)."""
    if t.skin_drag[i] == 0.0:
        return 0.0
    return float(t.R_skin * (0.5 * m.rate * twist_travel(t, i, i, next_)) ** 2)
