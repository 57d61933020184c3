"""Stiff strings by their partials, each without error of frequency, in the place of the grid.

The displacement is u = sum of a_n sin(n pi x/L). With b_n = n pi/L, [Yehu] eq. (2) leaves each
amplitude an equation of its own, driven by the forces at places x_p,

    M (a_n'' + 2 (sigma_0 + sigma_1 b_n^2) a_n' + (T b_n^2 + EI b_n^4)/(rho A) a_n)
        = sum of f_p sin(b_n x_p),    M = rho A L/2,

which is advanced as torsion's modes are (torsion.py): without error, and with an energy that is
positive. Contacts read and push the shapes sin(b_n x_p) themselves, between no nodes.

A spring between each place and the string, w, yields as the partials that are left out, near half
the sample rate and above, would under a steady force.

A place has a slot: its shape, and the compliance between it and the others of its string. What the
string does there stands in ``motion.u``, at GHOST + 1 + slot, in the place of nodes. So whatever
interpolates between nodes reads it with the weights 0, 1, 0, 0.

Differs: [Yehu] has a grid.
Source: [Bilbao] sections 3.2.4 and 6.1; [Yehu] eqs. (2), (3). Derivation: docs/derivation.md,
section 12.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.default_quantities import Quantities, StringQuantities
from yehu_server.core.physics.elementary import cos, elementwise, exp, kernel_sincospi, sin, tanh
from yehu_server.core.physics.layout import (
    GHOST,
    LEVELS,
    MAX_CONTACTS,
    REFINED,
    STRINGS,
    VECTOR,
    lined_up,
)
from yehu_server.core.physics.records import Modal, Model, Motion
from yehu_server.core.physics.torsion import MAX_OF_NYQUIST, NEGLIGIBLE_M
from yehu_server.errors import ParameterError

MAX_PARTIALS = 512
FELTS = 4  # dashpots that stand for the felt behind the bridge
# Slots: those of contacts are their numbers; then bridge and felt of each string, plucking.
BRIDGE = MAX_CONTACTS
FELT = BRIDGE + STRINGS
PLUCK = FELT + STRINGS * FELTS
SLOTS = PLUCK + 1
MAX_ROWS = 2 * STRINGS + STRINGS * FELTS + MAX_CONTACTS
REACH = 50  # times the partials, beyond which others yield nothing
STIFF = 8.0  # frequency of what a place yields besides, over the sample rate (rad/s)
NOWHERE = -1.0  # in place of a slot's position

# What only an instrument of modal strings has. It begins with REFINED, so that a pointer to it is
# one to that, too.
MODAL = lined_up(
    [
        ("refined", REFINED),
        ("partials", np.int64),
        ("L", np.float64, STRINGS),
        ("A_s", np.float64, (STRINGS, MAX_PARTIALS)),
        ("B_s", np.float64, (STRINGS, MAX_PARTIALS)),
        ("C_s", np.float64, (STRINGS, MAX_PARTIALS)),
        ("M_s", np.float64, (STRINGS, MAX_PARTIALS)),
        ("K_s", np.float64, (STRINGS, MAX_PARTIALS)),
        ("R_s", np.float64, (STRINGS, MAX_PARTIALS)),
        # tension, and felt
        ("bend", np.float64, (STRINGS, MAX_PARTIALS)),
        ("stretch_stiffness", np.float64, STRINGS),
        ("R_felt", np.float64, (STRINGS, FELTS)),
        # what each place yields besides
        ("M_w", np.float64, STRINGS),
        ("K_w", np.float64, STRINGS),
        ("R_w", np.float64, STRINGS),
        ("A_w", np.float64, STRINGS),
        ("B_w", np.float64, STRINGS),
        ("C_w", np.float64, STRINGS),
        # motion
        ("a", np.float64, (LEVELS, STRINGS, MAX_PARTIALS)),
        ("w", np.float64, (LEVELS, SLOTS, STRINGS)),
        ("Delta", np.float64, (STRINGS, MAX_PARTIALS)),
        # places
        ("x_slot", np.float64, SLOTS),
        ("string", np.uint8, SLOTS),
        ("shapes", np.float64, (SLOTS, MAX_PARTIALS)),
        ("compliance", np.float64, (SLOTS, SLOTS)),
        # the joint system
        ("rows", np.int64),
        ("slot", np.uint8, MAX_ROWS),
        ("G", np.float64, (MAX_ROWS, MAX_ROWS)),
        ("D", np.float64, MAX_ROWS),
        ("W", np.float64, MAX_ROWS),
        ("b", np.float64, MAX_ROWS),
        ("x", np.float64, MAX_ROWS),
    ]
)


def prepare_modal(modal: Any, quantities: Quantities, k: float) -> None:
    """Write the partials of both strings into `modal`, at rest, for a time step (s).

    Raises ParameterError where losses leave a partial no frequency.
    """
    most, x_c = 0, quantities.bridge_x
    modal["x_slot"] = NOWHERE
    for i, string in enumerate(quantities.strings):
        count = partials_below(string, MAX_OF_NYQUIST * np.pi / k)
        b = np.pi * np.arange(1, count + 1) / string.L
        sigma = string.sigma_0 + string.sigma_1 * b**2
        squared = (string.T * b**2 + string.EI * b**4) / string.rho_A - sigma**2
        if squared.min() <= 0.0:
            raise ParameterError(f"string_{i + 1}: its losses leave modal strings no frequency")
        ringing = np.sqrt(squared)
        decay, loss = elementwise(exp, -sigma * k), elementwise(tanh, sigma * k)
        modes = slice(0, count)
        # M delta_tt a + R delta_t. a + K a = f, with the poles of the partial, and its stiffness.
        A = 2.0 * decay * elementwise(cos, ringing * k)
        K = 0.5 * string.L * (string.T * b**2 + string.EI * b**4)
        M = K * k * k / (2.0 - A * (1.0 + loss))
        modal["A_s"][i, modes], modal["B_s"][i, modes] = A, -(decay**2)
        modal["C_s"][i, modes] = k * k / (M * (1.0 + loss))
        modal["M_s"][i, modes], modal["K_s"][i, modes] = M, K
        modal["R_s"][i, modes] = 2.0 * M * loss / k
        prepare_residual(modal, i, string, count, k)
        modal["L"][i], modal["bend"][i, modes] = string.L, 0.5 * string.L * b**2
        EA = quantities.tension_modulation * string.EA
        modal["stretch_stiffness"][i] = EA / (4.0 * string.L)
        part = (np.arange(FELTS) + 0.5) / FELTS
        loss_here = quantities.felt_loss * elementwise(sin, np.pi * part) ** 2
        modal["R_felt"][i] = 2.0 * string.rho_A * loss_here * (string.L - x_c) / FELTS
        most = max(most, count)
    modal["partials"] = -(-most // VECTOR) * VECTOR


def prepare_residual(modal: Any, i: int, string: StringQuantities, count: int, k: float) -> None:
    """Write what each place yields besides: as a spring, what the partials left out would.

    It is damped as the first of them, and has a mass that keeps it stable, by the scheme of the
    bridge's modes.
    """
    b = np.pi * np.arange(count + 1, REACH * count) / string.L
    stiffness = string.T * b**2 + string.EI * b**4
    K = string.L / (1.0 / stiffness).sum()  # the mean of sin^2 being 1/2
    M = K * (k / STIFF) ** 2
    damping = 2.0 * (string.sigma_0 + string.sigma_1 * b[0] ** 2)
    R = K * damping * string.rho_A / stiffness[0]
    Lambda = 4.0 * M + k * k * K + 2.0 * k * R
    modal["M_w"][i], modal["K_w"][i], modal["R_w"][i] = M, K, R
    modal["A_w"][i] = (8.0 * M - 2.0 * k * k * K) / Lambda
    modal["B_w"][i] = (-4.0 * M - k * k * K + 2.0 * k * R) / Lambda
    modal["C_w"][i] = 4.0 * k * k / Lambda


def partials_below(string: StringQuantities, omega: float) -> int:
    """Number of partials of a whole string below a frequency (rad/s), at most MAX_PARTIALS."""
    # T b^2 + EI b^4 = rho A omega^2
    target = string.rho_A * omega * omega
    b_squared = 2.0 * target / (string.T + math.sqrt(string.T**2 + 4.0 * string.EI * target))
    return max(1, min(MAX_PARTIALS, math.floor(string.L * math.sqrt(b_squared) / math.pi)))


def largest_compliance(modal: Any) -> float:
    """Return how far a newton moves a string under itself within a step, at most (m)."""
    n = np.arange(1, int(modal["partials"]) + 1)
    shapes = elementwise(sin, np.pi * np.outer(np.linspace(0.0, 0.5, 1001)[1:], n))
    return float((shapes**2 @ modal["C_s"][:, : len(n)].T + modal["C_w"]).max())


def pull_modal(modal: Any, x_c: float, i: int, position: float, amplitude: float) -> None:
    """As ``pluck.pluck_string``, of string `i` of a bridge at `x_c` (m)."""
    L, count = float(modal["L"][i]), int(modal["partials"])
    foot = (0.0, x_c) if position < x_c else (x_c, L)
    b = np.pi * np.arange(1, count + 1) / L
    corners = [elementwise(sin, b * x) / b**2 for x in (foot[0], position, foot[1])]
    left, right = amplitude / (position - foot[0]), amplitude / (foot[1] - position)
    a = 2.0 / L * (left * (corners[1] - corners[0]) + right * (corners[1] - corners[2]))
    moving = modal["C_s"][i, :count] > 0.0
    a, at_bridge = a * moving, elementwise(sin, b * x_c)
    still = at_bridge / b**2 * moving  # the string as a force at the bridge bends it
    modal["a"][:, i, :count] = a - still * (at_bridge @ a) / (at_bridge @ still)


def modal_shape(modal: Any, a: Any, i: int, intervals: int) -> Any:
    """Displacement (m) of so many intervals of string `i`, from amplitudes of both [STRINGS, n]."""
    n = np.arange(1, int(modal["partials"]) + 1)
    shapes = elementwise(sin, np.pi * np.outer(np.arange(intervals + 1), n) / intervals)
    found = shapes @ a[i, : len(n)]
    found[[0, -1]] = 0.0
    return found


# ---------------------------------------------------------------- a step


@compiled
def advance_partials(d: Modal, next_: int, now: int, prev: int) -> None:
    """Advance both strings free of forces; write Delta, the slope of their stretching."""
    for i in range(STRINGS):
        for n in range(d.partials):
            free = d.A_s[i, n] * d.a[now, i, n] + d.B_s[i, n] * d.a[prev, i, n]
            d.a[next_, i, n] = free if abs(free) > NEGLIGIBLE_M else 0.0
            d.Delta[i, n] = d.bend[i, n] * d.a[now, i, n]
    for slot in range(SLOTS):
        for i in range(STRINGS):
            free = d.A_w[i] * d.w[now, slot, i] + d.B_w[i] * d.w[prev, slot, i]
            d.w[next_, slot, i] = free if abs(free) > NEGLIGIBLE_M else 0.0


@compiled
def read(d: Modal, s: Motion, slot: int, level: int) -> None:
    """Write the displacement at a slot (m), at a level of time."""
    i = d.string[slot]
    total = d.w[level, slot, i]
    for n in range(d.partials):
        total += d.shapes[slot, n] * d.a[level, i, n]
    s.u[level, i, GHOST + 1 + slot] = total


@compiled
def read_all(d: Modal, s: Motion, level: int) -> None:
    """Write the displacement at all slots that are somewhere."""
    for slot in range(SLOTS):
        if d.x_slot[slot] >= 0.0:
            read(d, s, slot, level)


@compiled
def place(d: Modal, s: Motion, slot: int, i: int, x: float, now: int, prev: int) -> None:
    """Put a slot onto string `i` at `x` (m): only what moved is worked out anew."""
    if d.x_slot[slot] == x and d.string[slot] == i:
        return
    d.x_slot[slot], d.string[slot] = x, i
    minus_cosine, sine = kernel_sincospi(min(x / d.L[i], 1.0) - 0.5)
    before, shape = 0.0, sine
    for n in range(d.partials):
        d.shapes[slot, n] = shape
        before, shape = shape, -2.0 * minus_cosine * shape - before
    for other in range(SLOTS):
        G = d.C_w[i] if other == slot else 0.0
        if d.x_slot[other] >= 0.0 and d.string[other] == i:
            for n in range(d.partials):
                G += d.C_s[i, n] * d.shapes[slot, n] * d.shapes[other, n]
        d.compliance[slot, other] = d.compliance[other, slot] = G
    read(d, s, slot, now)
    read(d, s, slot, prev)


@compiled
def push(d: Modal, slot: int, level: int, f: float) -> None:
    """Move a string by a force at a slot (N)."""
    i = d.string[slot]
    for n in range(d.partials):
        d.a[level, i, n] += d.C_s[i, n] * d.shapes[slot, n] * f
    d.w[level, slot, i] += d.C_w[i] * f


@compiled
def stretching(d: Modal, i: int, slot: int) -> float:
    """Return how far a newton of tension's change moves a slot, against it (m)."""
    total = 0.0
    for n in range(d.partials):
        total += d.C_s[i, n] * d.Delta[i, n] * d.shapes[slot, n]
    return total


# ---------------------------------------------------------------- for the ledger


@compiled
def modal_energy(m: Model, d: Modal, i: int, next_: int, now: int) -> float:
    """Return the energy of string `i` at n + 1/2 (J)."""
    total, slope = 0.0, 0.0
    for n in range(d.partials):
        a_next, a = d.a[next_, i, n], d.a[now, i, n]
        total += 0.5 * d.M_s[i, n] * (m.rate * (a_next - a)) ** 2
        total += 0.5 * d.K_s[i, n] * a_next * a
        slope += d.bend[i, n] * a_next * a
    for slot in range(SLOTS):
        w_next, w = d.w[next_, slot, i], d.w[now, slot, i]
        total += 0.5 * d.M_w[i] * (m.rate * (w_next - w)) ** 2
        total += 0.5 * d.K_w[i] * (0.5 * (w_next + w)) ** 2
    return float(total + 0.5 * d.stretch_stiffness[i] * slope * slope)


@compiled
def modal_loss(m: Model, d: Modal, s: Motion, next_: int, prev: int) -> float:
    """Return what both strings lose by themselves and to the felt (W)."""
    total = 0.0
    for i in range(STRINGS):
        for n in range(d.partials):
            velocity = 0.5 * m.rate * (d.a[next_, i, n] - d.a[prev, i, n])
            total += d.R_s[i, n] * velocity * velocity
        for slot in range(SLOTS):
            velocity = 0.5 * m.rate * (d.w[next_, slot, i] - d.w[prev, slot, i])
            total += d.R_w[i] * velocity * velocity
        for place_ in range(FELTS):
            at = GHOST + 1 + FELT + FELTS * i + place_
            velocity = 0.5 * m.rate * (s.u[next_, i, at] - s.u[prev, i, at])
            total += d.R_felt[i, place_] * velocity * velocity
    return float(total)
