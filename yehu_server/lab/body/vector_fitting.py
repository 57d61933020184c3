"""Vector fitting in the z domain: poles and numerators of second-order sections side by side.

A linear least-squares problem is solved again and again, each time with the poles at the zeros
that the last one found. Poles outside the unit circle are mirrored into it, so that every section
is stable.

Source: B. Gustavsen and A. Semlyen, IEEE Trans. Power Delivery 14 (1999) 1052; relaxed as in
B. Gustavsen, ibid. 21 (2006) 1587.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.lab.body.curve import Complexes, Floats

NARROWEST_HZ, LOWEST_HZ = 2.0, 20.0  # half a section's bandwidth, and its frequency, at least


@dataclass(frozen=True)
class Lines:
    """What is to be met: values at frequencies, with weights, each [shape=(lines,)]."""

    frequency_hz: Floats
    wanted: Complexes
    weight: Floats
    rate: float  # sample rate (Hz)

    @property
    def z_1(self) -> Complexes:
        """One sample of delay at each frequency."""
        return np.asarray(np.exp(-2j * np.pi * self.frequency_hz / self.rate))


def _basis(z_1: Complexes, poles: Complexes) -> Complexes:
    """Two columns a pair of poles: 1 / A(z) of all, then z^-1 / A(z) of all."""
    inverse = 1.0 / (
        1.0 - 2.0 * poles.real * z_1[:, np.newaxis] + np.abs(poles) ** 2 * z_1[:, np.newaxis] ** 2
    )
    return np.concatenate([inverse, z_1[:, np.newaxis] * inverse], axis=1)


def numerators(lines: Lines, poles: Complexes) -> tuple[Floats, float]:
    """Sections b0, b1, a1, a2 of given poles, and the direct gain, by least squares."""
    z_1, weight = lines.z_1, lines.weight
    columns = np.concatenate([_basis(z_1, poles), np.ones((len(z_1), 1))], axis=1)
    solution = _least_squares(columns * weight[:, np.newaxis], lines.wanted * weight)
    n = len(poles)
    coefficients = np.stack(
        [solution[:n], solution[n : 2 * n], -2.0 * poles.real, np.abs(poles) ** 2], axis=1
    )
    return coefficients, float(solution[-1])


def moved(lines: Lines, poles: Complexes) -> Complexes:
    """The poles of the next round: the zeros of the factor that the measurement lacks."""
    z_1, wanted, weight = lines.z_1, lines.wanted, lines.weight
    n = len(poles)
    basis = _basis(z_1, poles)
    delayed = z_1[:, np.newaxis] * basis  # strictly proper, so that zeros are eigenvalues
    ones = np.ones((len(z_1), 1))
    own = np.concatenate([basis, ones], axis=1) * weight[:, np.newaxis]
    factor = np.concatenate([delayed, ones], axis=1) * (-wanted * weight)[:, np.newaxis]
    # One more equation keeps the factor from vanishing: its mean real part is one.
    size = float(np.linalg.norm(wanted * weight)) / np.sqrt(len(z_1))
    mean = np.concatenate([delayed, ones], axis=1).real.mean(axis=0) * size * len(z_1) ** 0.5
    matrix = np.concatenate([own, factor], axis=1)
    row = np.concatenate([np.zeros(own.shape[1]), mean])
    solution = _least_squares(matrix, np.zeros(len(z_1)), row, size * len(z_1) ** 0.5)
    sigma = solution[own.shape[1] :]
    direct = sigma[-1] if abs(sigma[-1]) > 1e-8 else 1e-8
    state = np.zeros((2 * n, 2 * n))
    entry, exits = np.zeros(2 * n), np.empty(2 * n)
    for i, pole in enumerate(poles):
        state[2 * i, 2 * i : 2 * i + 2] = 2.0 * pole.real, -(abs(pole) ** 2)
        state[2 * i + 1, 2 * i] = 1.0
        entry[2 * i] = 1.0
        exits[2 * i : 2 * i + 2] = sigma[i], sigma[n + i]
    zeros: Any = np.linalg.eigvals(state - np.outer(entry, exits) / direct)
    return usable(zeros, n, lines.rate)


def usable(zeros: Complexes, count: int, rate: float) -> Complexes:
    """Stable poles above the real axis, `count` of them: real ones are taken two at a time."""
    zeros = np.where(np.abs(zeros) > 1.0, 1.0 / np.conj(zeros), zeros)
    pairs = list(zeros[zeros.imag > 1e-9])
    rest = sorted(zeros[np.abs(zeros.imag) <= 1e-9].real)
    pairs += [
        complex((one + other) / 2.0, abs(other - one) / 2.0)
        for one, other in zip(rest[::2], rest[1::2], strict=False)
    ]
    angle = np.angle(pairs)[:count].clip(2.0 * np.pi * LOWEST_HZ / rate, 0.98 * np.pi)
    radius = np.abs(pairs)[:count].clip(1e-3, np.exp(-2.0 * np.pi * NARROWEST_HZ / rate))
    return np.asarray(radius * np.exp(1j * angle))


def _least_squares(
    matrix: Any, wanted: Any, row: Floats | None = None, value: float = 0.0
) -> Floats:
    """Real solution of complex equations, columns scaled, with one more real equation."""
    real = np.concatenate([matrix.real, matrix.imag])
    right = np.concatenate([np.real(wanted), np.imag(wanted)])
    if row is not None:
        real, right = np.vstack([real, row]), np.append(right, value)
    size = np.maximum(np.linalg.norm(real, axis=0), 1e-300)
    solution, *_ = np.linalg.lstsq(real / size, right, rcond=1e-13)
    return np.asarray(solution / size)
