"""From bridge force to radiated sound: parallel second-order sections, 25 of the measured body.

[Yehu] section 4.3. The filter was measured at one sample rate; at others its poles are
moved to the same frequencies and its numerators fitted to the same response.
"""

import math
from functools import lru_cache
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics import elementary
from yehu_server.core.physics.default_quantities import Body
from yehu_server.core.physics.layout import MAX_SECTIONS, MAX_TAPS, USUAL_SECTIONS
from yehu_server.core.physics.records import Model, Motion
from yehu_server.errors import ParameterError

FIT_ROUNDS = 6  # of the fit; over 22.05 to 192 kHz they bring 1.7 dB of error down to 0.4
Floats = np.ndarray[Any, np.dtype[np.float64]]


def prepare_radiation(model: np.void, body: Body) -> None:
    """Write the filter, re-fitted for its rate; raises ParameterError for too many sections."""
    if len(body.sections) > MAX_SECTIONS:
        raise ParameterError(
            f"a body has at most {MAX_SECTIONS} radiation sections, not {len(body.sections)}"
        )
    rate = 1.0 / model["k"]
    if abs(rate - body.radiation_rate) < 1e-6:
        sections = np.array(body.sections).reshape(-1, 4)
        taps = np.array([body.direct_gain])
    else:
        sections, taps = refit(body, rate)
    n = model["sections"] = len(sections)
    model["b_0"][:n], model["b_1"][:n] = sections[:, 0], sections[:, 1]
    model["a_1"][:n], model["a_2"][:n] = sections[:, 2], sections[:, 3]
    model["taps"][: len(taps)] = taps
    model["last_tap"] = len(taps) - 1


def unit_delay(frequency_hz: Floats, rate: float) -> tuple[Floats, Floats]:
    """Real and imaginary part of z^-1 at some frequencies (Hz), up to half the rate (Hz)."""
    minus_cosine, sine = elementary.sincospi(2.0 * frequency_hz / rate - 0.5)
    return -minus_cosine, -sine


def over_poles(b_0: Any, b_1: Any, a_1: Any, a_2: Any, z_1: tuple[Floats, Floats]) -> Any:
    """Real and imaginary part of (b0 + b1 z^-1) / (1 + a1 z^-1 + a2 z^-2)."""
    re, im = z_1
    down_re = 1.0 + a_1 * re + a_2 * (re * re - im * im)
    down_im = im * (a_1 + 2.0 * a_2 * re)
    up_re, up_im = b_0 + b_1 * re, b_1 * im
    size = down_re * down_re + down_im * down_im
    return ((up_re * down_re + up_im * down_im) / size, (up_im * down_re - up_re * down_im) / size)


def response(sections: Floats, taps: Floats, rate: float, frequency_hz: Floats) -> Any:
    """Complex response [shape=(frequencies,), Pa/N] of sections (b0, b1, a1, a2) and taps."""
    re, im = response_parts(sections, taps, rate, frequency_hz)
    return re + 1j * im


def response_parts(
    sections: Floats, taps: Floats, rate: float, frequency_hz: Floats
) -> tuple[Floats, Floats]:
    """Real and imaginary part of `response`; NumPy's complex products vary by processor."""
    z_1 = unit_delay(frequency_hz, rate)
    re, im = np.zeros_like(frequency_hz), np.zeros_like(frequency_hz)
    for b_0, b_1, a_1, a_2 in sections.tolist():
        own_re, own_im = over_poles(b_0, b_1, a_1, a_2, z_1)
        re, im = re + own_re, im + own_im
    for tap, (delayed_re, delayed_im) in zip(taps, delays(z_1, len(taps)), strict=True):
        re, im = re + tap * delayed_re, im + tap * delayed_im
    return re, im


def delays(z_1: tuple[Floats, Floats], count: int) -> list[tuple[Floats, Floats]]:
    """Real and imaginary parts of the powers of z^-1, from 0 on."""
    (re, im), one = z_1, np.ones_like(z_1[0])
    found = [(one, 0.0 * one)]
    while len(found) < count:
        last_re, last_im = found[-1]
        found.append((last_re * re - last_im * im, last_re * im + last_im * re))
    return found


def magnitude(value: tuple[Floats, Floats]) -> Floats:
    """Absolute value of a real and an imaginary part."""
    re, im = value
    return np.asarray(np.sqrt(re * re + im * im))


def pole_of(a_1: float, a_2: float) -> tuple[float, float]:
    """Radius and angle (rad) of the poles of a section; of two real ones, the larger."""
    middle, under = -0.5 * a_1, a_2 - 0.25 * a_1 * a_1
    if under <= 0.0:
        radius = abs(middle) + math.sqrt(-under)
        return radius, 0.0 if middle >= 0.0 else math.pi
    radius = math.sqrt(a_2)
    return radius, 0.5 * math.pi - elementary.asin(middle / radius)


def least_squares(columns: Floats, wanted: Floats) -> Floats:
    """Factors of the columns whose sum is nearest to the wanted one, by Householder's reflections.

    NumPy's own takes other sums on other processors. `columns` has the shape (columns, rows).
    """
    left, rest = columns.copy(), wanted.copy()
    for j in range(len(left)):
        mirror = left[j, j:].copy()
        mirror[0] += math.copysign(math.sqrt((mirror * mirror).sum()), mirror[0])
        per_size = 2.0 / (mirror * mirror).sum()
        shares = (left[j:, j:] * mirror).sum(axis=1) * per_size
        left[j:, j:] -= shares[:, np.newaxis] * mirror
        rest[j:] -= (rest[j:] * mirror).sum() * per_size * mirror
    factors = np.zeros(len(left))
    for j in reversed(range(len(left))):
        factors[j] = (rest[j] - (left[j + 1 :, j] * factors[j + 1 :]).sum()) / left[j, j]
    return factors


@lru_cache(maxsize=16)  # it takes a tenth of a second
def refit(body: Body, rate: float) -> tuple[Floats, Floats]:
    """Fit the measured filter for another sample rate (Hz).

    The poles keep frequency and decay (z -> z^(measured rate / rate)); those beyond the
    new Nyquist frequency are left out. Numerators and direct taps then follow by linear
    least squares on the relative error up to 16 kHz (or 0.45 of the rate). Above that
    the weight is lower, and beyond the measured band the aim is silence, to keep the
    filter from rising where nobody measured. A few rounds put more weight where the
    response is off, which evens out the error.

    Returns
    -------
    sections : ndarray [shape=(sections, 4)], b0, b1, a1, a2
    taps : ndarray [shape=(12,)], the direct path
    """
    measured = np.array(body.sections).reshape(-1, 4)
    direct = np.array([body.direct_gain])

    def target(frequency_hz: Floats) -> tuple[Floats, Floats]:
        return response_parts(measured, direct, body.radiation_rate, frequency_hz)

    poles = [pole_of(a_1, a_2) for a_1, a_2 in measured[:, 2:].tolist()]
    angle = np.array([angle for _, angle in poles]) * body.radiation_rate / rate
    radius = np.array([elementary.power(radius, body.radiation_rate / rate) for radius, _ in poles])
    below_nyquist = angle < 0.98 * math.pi
    angle, radius = angle[below_nyquist], radius[below_nyquist]
    a_1, a_2 = -2.0 * radius * elementary.elementwise(elementary.cos, angle), radius * radius

    band_edge = min(16e3, 0.45 * rate)
    measured_edge = body.radiation_rate / 2.0
    low = 30.0 * elementary.elementwise(
        elementary.exp, np.arange(500) / 499.0 * elementary.log(2e3 / 30.0)
    )
    audible = np.concatenate([low, np.linspace(2e3, band_edge, 900)[1:]])
    above = np.linspace(band_edge, rate / 2.0, 600)[1:]
    wanted_audible, wanted_above = target(audible), target(np.minimum(above, measured_edge))
    frequency_hz = np.concatenate([audible, above])
    is_measured = np.concatenate([np.full(len(audible), 1.0), above < measured_edge])
    wanted = np.concatenate([wanted_audible, wanted_above], axis=1) * is_measured
    reference = np.concatenate([magnitude(wanted_audible), magnitude(wanted_above)])
    is_above = frequency_hz > band_edge
    weight = np.where(is_above, 0.2, 1.0) / reference

    z_1 = unit_delay(frequency_hz, rate)
    signals = [
        over_poles(b_0, b_1, *section, z_1)
        for b_0, b_1 in ((1.0, 0.0), (0.0, 1.0))
        for section in zip(a_1, a_2, strict=True)
    ]
    columns = np.array([*signals, *delays(z_1, MAX_TAPS)])  # real parts, then imaginary ones
    size = np.sqrt((columns * columns * weight * weight).sum(axis=(1, 2)))
    for _ in range(FIT_ROUNDS):
        weighted = columns * weight / size[:, np.newaxis, np.newaxis]
        rows = 2 * len(frequency_hz)
        solution = least_squares(weighted.reshape(-1, rows), (wanted * weight).reshape(rows)) / size
        fitted = (columns * solution[:, np.newaxis, np.newaxis]).sum(axis=0)
        error_db = 2.0 * elementary.decibels(magnitude(fitted) / reference)
        # Below the band's edge every tenth of a dB counts; above, only what exceeds it.
        excess = np.where(is_above, np.maximum(error_db, 0.0) / 2.0, np.abs(error_db) / 0.1)
        weight = weight * np.sqrt(1.0 + excess)
    n = len(a_1)
    sections = np.stack([solution[:n], solution[n : 2 * n], a_1, a_2], axis=1)
    return sections, solution[2 * n :]


@compiled
def radiate(model: Model, s: Motion, bridge_force: float) -> float:
    """Advance the radiation filter by one sample: bridge force (N) to pressure (Pa).

    Real time: safe; the sections are independent, so they vectorise.
    """
    pressure = 0.0
    for j in range(USUAL_SECTIONS):  # a count known beforehand: the loop over it is straight code
        y = model.b_0[j] * bridge_force + s.s_1[j]
        s.s_1[j] = model.b_1[j] * bridge_force - model.a_1[j] * y + s.s_2[j]
        s.s_2[j] = -model.a_2[j] * y
        pressure += y
    for j in range(USUAL_SECTIONS, model.sections):
        y = model.b_0[j] * bridge_force + s.s_1[j]
        s.s_1[j] = model.b_1[j] * bridge_force - model.a_1[j] * y + s.s_2[j]
        s.s_2[j] = -model.a_2[j] * y
        pressure += y
    for j in range(model.last_tap, 0, -1):
        s.history[j] = s.history[j - 1]
    s.history[0] = bridge_force
    for j in range(model.last_tap + 1):
        pressure += model.taps[j] * s.history[j]
    return pressure
