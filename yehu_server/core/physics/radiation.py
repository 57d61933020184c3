"""From bridge force to radiated sound: parallel second-order sections, 25 of the measured body.

[Yehu] section 4.3. The filter was measured at one sample rate; at others its poles are
moved to the same frequencies and its numerators fitted to the same response.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.layout import MAX_SECTIONS, MAX_TAPS, USUAL_SECTIONS
from yehu_server.core.physics.quantities import Body
from yehu_server.core.physics.records import Model, Motion
from yehu_server.errors import ParameterError

ROUNDS = 6  # of the fit; over 22.05 to 192 kHz they bring 1.7 dB of error down to 0.4
Floats = np.ndarray[Any, np.dtype[np.float64]]


def prepare_radiation(model: np.void, body: Body) -> None:
    """Write the filter into `model`, as measured or re-fitted for its sample rate.

    Raises
    ------
    ParameterError
        Where the body has too many sections.
    """
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


def response(sections: Floats, taps: Floats, rate: float, frequency_hz: Floats) -> Any:
    """Complex response [shape=(frequencies,), Pa/N] of sections (b0, b1, a1, a2) and taps."""
    z_1 = np.exp(-2j * np.pi * frequency_hz / rate)[:, np.newaxis]
    b_0, b_1, a_1, a_2 = sections.T
    poles = (b_0 + b_1 * z_1) / (1.0 + a_1 * z_1 + a_2 * z_1**2)
    return poles.sum(axis=1) + (taps * z_1 ** np.arange(len(taps))).sum(axis=1)


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

    def target(frequency_hz: Floats) -> Any:
        return response(measured, direct, body.radiation_rate, frequency_hz)

    pole = np.array([np.roots([1.0, a_1, a_2])[0] for a_1, a_2 in measured[:, 2:]])
    angle = np.abs(np.angle(pole)) * body.radiation_rate / rate
    radius = np.abs(pole) ** (body.radiation_rate / rate)
    below_nyquist = angle < 0.98 * math.pi
    angle, radius = angle[below_nyquist], radius[below_nyquist]
    a_1, a_2 = -2.0 * radius * np.cos(angle), radius**2

    band_edge = min(16e3, 0.45 * rate)
    measured_edge = body.radiation_rate / 2.0
    audible = np.concatenate([np.geomspace(30.0, 2e3, 500), np.linspace(2e3, band_edge, 900)[1:]])
    above = np.linspace(band_edge, rate / 2.0, 600)[1:]
    wanted_above = target(np.minimum(above, measured_edge))
    frequency_hz = np.concatenate([audible, above])
    wanted = np.concatenate([target(audible), np.where(above < measured_edge, wanted_above, 0.0)])
    weight = np.concatenate([1.0 / np.abs(target(audible)), 0.2 / np.abs(wanted_above)])

    z_1 = np.exp(-2j * np.pi * frequency_hz / rate)[:, np.newaxis]
    poles = 1.0 / (1.0 + a_1 * z_1 + a_2 * z_1**2)
    columns = np.concatenate([poles, z_1 * poles, z_1 ** np.arange(MAX_TAPS)], axis=1)
    size = np.linalg.norm(columns * weight[:, np.newaxis], axis=0)
    reference = np.abs(np.concatenate([target(audible), wanted_above]))
    is_above = frequency_hz > band_edge
    for _ in range(ROUNDS):
        weighted = columns * weight[:, np.newaxis] / size
        solution, *_ = np.linalg.lstsq(
            np.concatenate([weighted.real, weighted.imag]),
            np.concatenate([(wanted * weight).real, (wanted * weight).imag]),
            rcond=1e-13,
        )
        solution /= size
        error_db = 20.0 * np.log10(np.abs(columns @ solution) / reference)
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
