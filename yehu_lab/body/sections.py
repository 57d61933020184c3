"""Fit stable second-order sections, side by side, to a measured radiation.

The model's body makes sound pressure of bridge force by such sections and a direct gain. Poles are
found by vector fitting in the z domain: a linear least-squares problem is solved again and again,
each time with the poles at the zeros that the last one found, and those outside the unit circle
mirrored into it. Then the error is evened out over the band.

Source: B. Gustavsen and A. Semlyen, IEEE Trans. Power Delivery 14 (1999) 1052; relaxed as in
B. Gustavsen, ibid. 21 (2006) 1587.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from yehu_lab.body.curve import Complexes, Curve, Floats, as_db, interpolated
from yehu_server.core.physics.radiation import response
from yehu_server.errors import MeasurementError

NARROWEST_HZ, LOWEST_HZ = 2.0, 20.0  # half a section's bandwidth, and its frequency, at least
ROUNDS, FEW_ROUNDS = 20, 4
EVENING = 8  # rounds in which weight goes to where the error is large
ENOUGH, PATIENCE = 0.99, 3  # an error as much smaller is progress; rounds without that
LATER, STEP = 4, 0.4  # onsets that are tried after the first; periods of the highest frequency
START_DAMPING = 0.02
FLOOR, NOISE = 0.02, 4.0  # errors that do not matter: relative, and in deviations
OUTSIDE, OUTSIDE_LINES = 0.15, 60  # weight of silence outside the band, and at how many places
MAX_DELAY_S = 0.02  # of sound on its way to the microphone: 7 m


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


@dataclass(frozen=True)
class Sections:
    """Second-order sections b0, b1, a1, a2 [shape=(sections, 4)], a direct gain, and their rate."""

    coefficients: Floats
    direct_gain: float
    rate: float
    delay_s: float  # that was taken off the measurement

    def response(self, frequency_hz: Floats) -> Complexes:
        """Pressure per force (Pa/N) at frequencies [shape=(lines,)], without the delay."""
        direct = np.array([self.direct_gain])
        return np.asarray(response(self.coefficients, direct, self.rate, frequency_hz))


def fit_sections(curve: Curve, count: int = 32, rate: float = 44100.0) -> Sections:
    """Fit sections to a radiation.

    The curve (Pa/N) is over the band that counts. Outside of it the sections are kept quiet, since
    nobody measured there. They are `count`, for a sample rate (Hz). The time that sound takes to
    the microphone is estimated, and taken off before the fit: as a filter it would want poles of
    its own. Raises MeasurementError where there are fewer lines than numbers to find.
    """
    curve = curve.within(LOWEST_HZ, 0.49 * rate)
    lo, hi = float(curve.frequency_hz[0]), float(curve.frequency_hz[-1])
    start_hz = np.geomspace(lo, min(hi, 0.45 * rate), count)
    poles = np.exp((1j - START_DAMPING) * 2.0 * np.pi * start_hz / rate)
    onset_s = _delay(curve)
    best = _fitted(curve, onset_s, poles, rate, ROUNDS)
    for later in range(1, LATER + 1):
        delay_s = onset_s + later * STEP / hi
        other = _fitted(curve, delay_s, best.poles, rate, FEW_ROUNDS)
        best = min(best, other, key=lambda tried: tried.error)
    return _evened(best)


@dataclass(frozen=True)
class _Tried:
    error: float
    lines: Lines
    matters: Floats  # errors (Pa/N) that are neither noise nor inaudible
    poles: Complexes
    found: Sections


def _fitted(curve: Curve, delay_s: float, poles: Complexes, rate: float, rounds: int) -> _Tried:
    """The best of some rounds that begin with given poles."""
    steady = curve.values * np.exp(2j * np.pi * curve.frequency_hz * delay_s)
    grouped = Curve(curve.frequency_hz, steady).grouped()
    if len(grouped.values) < 2 * len(poles):
        raise MeasurementError(
            f"radiation: {len(grouped.values)} lines are too few for {len(poles)} sections"
        )
    lines, matters = _with_silence(grouped, rate)
    tried: list[_Tried] = []
    best, since = np.inf, 0
    for _ in range(rounds):
        found = Sections(*numerators(lines, poles), rate, delay_s)
        error = float(
            np.linalg.norm((found.response(lines.frequency_hz) - lines.wanted) * lines.weight)
        )
        since = 0 if error < ENOUGH * best else since + 1
        best = min(best, error)
        tried.append(_Tried(error, lines, matters, poles, found))
        if since > PATIENCE:
            break
        poles = moved(lines, poles)
    return min(tried, key=lambda one: one.error)


def _evened(best: _Tried) -> Sections:
    """Numerators again, with more weight where the error matters: its largest becomes smaller."""
    lines, found, weight = best.lines, best.found, best.lines.weight
    chosen, least = found, np.inf
    for _ in range(EVENING):
        off = np.abs(found.response(lines.frequency_hz) - lines.wanted) / best.matters
        if off.max() < least:
            chosen, least = found, float(off.max())
        if least < 1.0:
            break
        weight = weight * np.sqrt(np.maximum(off, 1.0))
        again = replace(lines, weight=weight)
        found = Sections(*numerators(again, best.poles), found.rate, found.delay_s)
    return chosen


def _with_silence(curve: Curve, rate: float) -> tuple[Lines, Floats]:
    """The lines to be met, and silence outside the band, with weights; and what error matters."""
    level = np.abs(curve.values)
    weight = 1.0 / np.sqrt(curve.deviation**2 + (FLOOR * level) ** 2)
    # As many lines an octave count as much low as high.
    weight *= np.sqrt(np.gradient(np.log(curve.frequency_hz)))
    lo, hi = float(curve.frequency_hz[0]), float(curve.frequency_hz[-1])
    below = (
        np.geomspace(LOWEST_HZ, lo / 1.1, OUTSIDE_LINES) if lo > 1.5 * LOWEST_HZ else np.empty(0)
    )
    above = np.linspace(min(1.15 * hi, 0.499 * rate), 0.499 * rate, OUTSIDE_LINES)
    edge = np.median(weight * FLOOR * level) * OUTSIDE
    edges = [
        np.full(len(places), edge / (FLOOR * np.median(level[ends])))
        for places, ends in ((below, slice(0, 20)), (above, slice(-20, None)))
    ]
    at_hz = np.concatenate([below, curve.frequency_hz, above])
    wanted = np.concatenate([np.zeros(len(below)), curve.values, np.zeros(len(above))])
    matters = np.full(len(at_hz), np.inf)
    matters[len(below) : len(at_hz) - len(above)] = np.hypot(FLOOR * level, NOISE * curve.deviation)
    lines = Lines(at_hz, wanted, np.concatenate([edges[0], weight, edges[1]]), rate)
    return lines, matters


def _delay(curve: Curve) -> float:
    """How long (s) sound is on its way: when the impulse response begins.

    By the envelope of the band's impulse response: the first moment above a fifth of its peak,
    less half the time that the band's width blurs it.
    """
    step = float(np.median(np.diff(curve.frequency_hz)))
    even = np.arange(0.0, curve.frequency_hz[-1], step)
    values = interpolated(even, curve.frequency_hz, curve.values, left=0.0)
    inside = even >= curve.frequency_hz[0]
    values[inside] *= np.hanning(int(inside.sum()))
    envelope = np.abs(np.fft.ifft(values, 8 * len(values)))
    time = np.arange(len(envelope)) / (8 * len(values) * step)
    envelope, time = envelope[time < MAX_DELAY_S], time[time < MAX_DELAY_S]
    onset = float(time[int(np.argmax(envelope > 0.2 * envelope.max()))])
    width = float(curve.frequency_hz[-1] - curve.frequency_hz[0])
    return max(0.0, onset - 1.0 / width) if as_db(envelope.max()) > -280.0 else 0.0
