"""A bank of modes: masses on springs and dashpots, and the least-squares problem of fitting them.

[Yehu] eqs. (10)-(12). With positive masses and dashpots the real part of the admittance is at
no frequency below zero: such a body never gives more energy than it got.

The admittance is a sum of modes, each 1/M times a function of its frequency and damping. For
given frequencies and dampings the inverse masses follow by non-negative least squares, so that
only frequencies and dampings are searched (variable projection). All that a step of the search
needs are inner products of a few columns, which are taken once a step.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_lab.body.curve import Complexes, Floats

RIDGE = 1e-13  # of the diagonal: keeps the factor of two modes at one place finite
MIN_SHARE = 1e-9  # of the largest amount: less is none


@dataclass(frozen=True)
class Modes:
    """A bank of modes; each array has one value a mode [shape=(modes,)], by rising frequency."""

    frequency_hz: Floats
    damping: Floats  # damping ratio, 1 / 2Q
    inverse_mass: Floats  # 1/kg, above zero

    @property
    def mass(self) -> Floats:
        """Masses (kg)."""
        return 1.0 / self.inverse_mass

    @property
    def resistance(self) -> Floats:
        """Dashpots (kg/s): 2 damping M omega."""
        return 2.0 * self.damping * self.mass * (2.0 * np.pi * self.frequency_hz)

    def admittance(self, frequency_hz: Floats) -> Complexes:
        """Velocity per force (s/kg) at frequencies [shape=(lines,)]."""
        columns = mode_columns(frequency_hz, self.frequency_hz, self.damping)
        return np.asarray(columns @ self.inverse_mass)


def mode_columns(frequency_hz: Floats, modes_hz: Floats, damping: Floats) -> Complexes:
    """Admittance of modes of one kilogram [shape=(lines, modes)], [Yehu] eq. (12) for M = 1."""
    omega = 2.0 * np.pi * frequency_hz[:, np.newaxis]
    omega_m = 2.0 * np.pi * modes_hz
    return np.asarray(1j * omega / (omega_m**2 - omega**2 + 2j * damping * omega_m * omega))


Numbers = np.ndarray[Any, np.dtype[np.int64]]


@dataclass(frozen=True)
class Problem:
    """A measured admittance, weighted."""

    frequency_hz: Floats  # [shape=(lines,)]
    mobility: Complexes  # [shape=(lines,)] velocity per force (s/kg)
    # [shape=(lines,)] by which errors are multiplied (kg/s): one by the size of an error that
    # does not matter.
    weight: Floats

    @property
    def wanted(self) -> Floats:
        """The weighted admittance, real parts and then imaginary ones [shape=(2 lines,)]."""
        return stacked(self.mobility * self.weight)

    def columns(self, points: Floats) -> tuple[Floats, Floats]:
        """Weighted admittances of modes, each scaled to length one, and the lengths they had.

        Of points [shape=(modes, 2)], logarithms of frequency (Hz) and damping ratio: columns
        [shape=(2 lines, modes)] and lengths [shape=(modes,)].
        """
        plain = mode_columns(self.frequency_hz, *np.exp(points.T))
        columns = stacked(plain * self.weight[:, np.newaxis])
        lengths = np.linalg.norm(columns, axis=0)
        return columns / lengths, lengths

    def derivatives(self, points: Floats, lengths: Floats) -> Floats:
        """Of the columns by both logarithms, not counting the scaling [shape=(2 lines, 2 modes)].

        All by frequency come first, then all by damping.
        """
        frequency_hz, damping = np.exp(points.T)
        omega = 2.0 * np.pi * self.frequency_hz[:, np.newaxis]
        omega_m = 2.0 * np.pi * frequency_hz
        below = omega_m**2 - omega**2 + 2j * damping * omega_m * omega
        outer = -1j * omega / below**2 * (self.weight[:, np.newaxis] / lengths)
        damped = 2j * damping * omega_m * omega
        return stacked(
            np.concatenate([outer * (2.0 * omega_m**2 + damped), outer * damped], axis=1)
        )


@dataclass(frozen=True)
class Step:
    """The least-squares solution at given frequencies and dampings, with its derivatives."""

    points: Floats
    amounts: Floats  # of the columns of length one, not below zero
    error: float  # sum of squares that remains
    gradient: Floats  # of half of it, by the logarithms of those that move [shape=(2 moving,)]
    curvature: Floats  # Gauss-Newton's, of the same


def step_at(
    problem: Problem, points: Floats, wanted: Floats, moving: Numbers | None = None
) -> Step:
    """Solve for the amounts at `points`, and find how the error changes with them.

    `moving` has the numbers of the modes that may move; by default all. The curvature is Kaufman's
    approximation: derivatives are taken beside the columns in use.
    """
    columns, lengths = problem.columns(points)
    m = len(points)
    moving = np.arange(m) if moving is None else moving
    moved = problem.derivatives(points[moving], lengths[moving])
    together = np.concatenate([columns, moved, wanted[:, np.newaxis]], axis=1)
    products = together.T @ together
    own, towards = products[:m, :m], products[:m, -1]
    amounts = amounts_of(own, towards)
    error = float(products[-1, -1] - 2.0 * towards @ amounts + amounts @ own @ amounts)
    twice = np.tile(amounts[moving], 2)
    left = products[m:-1, -1] - products[m:-1, :m] @ amounts
    curvature = products[m:-1, m:-1]
    used = amounts > 0.0
    if used.any():
        across = products[:m, m:-1][used]
        curvature = curvature - across.T @ np.linalg.solve(_firm(own[np.ix_(used, used)]), across)
    return Step(points, amounts, max(error, 0.0), -twice * left, np.outer(twice, twice) * curvature)


def amounts_of(own: Floats, towards: Floats) -> Floats:
    """Non-negative amounts of columns, from their inner products and those with the wanted."""
    from scipy.linalg import solve_triangular
    from scipy.optimize import nnls

    if not len(towards):
        return np.empty(0)
    factor = np.linalg.cholesky(_firm(own))
    amounts, _ = nnls(factor.T, solve_triangular(factor, towards, lower=True), maxiter=500)
    return np.asarray(np.where(amounts > MIN_SHARE * amounts.max(), amounts, 0.0))


def stacked(values: Complexes) -> Floats:
    """Real parts, then imaginary ones, along the first axis."""
    return np.concatenate([values.real, values.imag])


def _firm(own: Floats) -> Floats:
    return np.asarray(own + RIDGE * np.eye(len(own)))
