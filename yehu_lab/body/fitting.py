"""From a measurement to a body that the model plays."""

from dataclasses import replace
from typing import Any

import numpy as np

from yehu_lab.body.body_file import Differences, Fit
from yehu_lab.body.curve import Curve, as_db
from yehu_lab.body.measurement import HIGHEST_HZ, LOWEST_HZ, Measurement
from yehu_lab.body.modes import Modes, Problem
from yehu_lab.body.search import Search
from yehu_lab.body.sections import fit_sections
from yehu_server.core.physics.default_quantities import check_body, measured_body
from yehu_server.core.physics.layout import MAX_MODES, MAX_SECTIONS, USUAL_SECTIONS
from yehu_server.errors import MeasurementError

RATE = 44100.0  # of the radiation's sections; at others the model moves them
FLOOR = 0.005  # relative error of an admittance that does not matter: 0.04 dB
LONGEST_S = 0.8  # for 60 dB: what rings longer is a string,
SHARPEST_S = 10.0  # and longer than that a line of the mains
POOR_DB = 1.0


def fit(
    measurement: Measurement,
    *,
    band_hz: tuple[float, float] | None = None,
    modes: int | None = None,
    sections: int = USUAL_SECTIONS,
) -> Fit:
    """Fit a body: bridge modes to the admittance, sections to the radiation.

    What was not measured is kept of the body that comes with the package.

    Parameters
    ----------
    band_hz : tuple of float, optional
        Lowest and highest frequency to be met; by default from 100 Hz to where the hammer stops
        to excite, at most 8 kHz.
    modes : int, optional
        Number of bridge modes; by default as many as the measurement shows, at most 64.
    sections : int
        Number of sections of the radiation, at most 64; by default at most 32.

    Raises
    ------
    MeasurementError
        Where nothing was measured, or too little in the band.
    """
    if modes is not None and not 1 <= modes <= MAX_MODES:
        raise MeasurementError(f"{modes} modes: a body has 1 to {MAX_MODES}")
    if not 1 <= sections <= MAX_SECTIONS:
        raise MeasurementError(f"{sections} sections: a body has 1 to {MAX_SECTIONS}")
    band = band_hz or (LOWEST_HZ, min(measurement.highest_hz, HIGHEST_HZ))
    within = replace(
        measurement,
        admittance=_in_band(measurement.admittance, band, "admittance"),
        radiation=_in_band(measurement.radiation, band, "radiation"),
    )
    body = measured_body()
    warnings = list(measurement.warnings)
    admittance_db = radiation_db = None
    if within.admittance is not None:
        found = fit_modes(within.admittance, modes)
        body = replace(
            body,
            frequency_hz=tuple(found.frequency_hz.tolist()),
            mass=tuple(found.mass.tolist()),
            damping=tuple(found.resistance.tolist()),
        )
        admittance_db = differences(within.admittance, found.admittance)
        warnings += _doubts(found, admittance_db, band)
        if modes is None and len(found.mass) == MAX_MODES:
            warnings.append(
                f"admittance: it shows more than {MAX_MODES} modes, the most that a body has; the "
                f"strongest are fitted, {admittance_db.most:.1f} dB off at most"
            )
    else:
        warnings.append("no admittance was measured: the bridge is the shipped yehu's")
    if within.radiation is not None:
        fitted = fit_sections(within.radiation, sections, RATE)
        sections_of = tuple(tuple(row) for row in fitted.coefficients.tolist())
        body = replace(
            body, radiation_rate=fitted.rate, sections=sections_of, direct_gain=fitted.direct_gain
        )
        # As if the microphone had been nearer.
        sooner = np.exp(2j * np.pi * within.radiation.frequency_hz * fitted.delay_s)
        radiation = replace(within.radiation, values=within.radiation.values * sooner)
        within = replace(within, radiation=radiation)
        radiation_db = differences(radiation, fitted.response)
        warnings += _poor(radiation_db, "radiation")
    else:
        warnings.append("no radiation was measured: the sound is radiated as by the shipped yehu")
    if within.admittance is None and within.radiation is None:
        raise MeasurementError("nothing was measured: neither admittance nor radiation")
    check_body(body)
    return Fit(body, within, band, admittance_db, radiation_db, tuple(warnings))


def fit_modes(curve: Curve, count: int | None = None) -> Modes:
    """Fit `count` modes, or as many as it shows, to an admittance; raises MeasurementError."""
    weight = 1.0 / np.hypot(curve.deviation, FLOOR * np.abs(curve.values))
    found = Search(Problem(curve.frequency_hz, curve.values, weight)).find(MAX_MODES, count)
    if not len(found.mass):
        raise MeasurementError("admittance: no mode stands out of the noise")
    return found


def differences(curve: Curve, response_at: Any) -> Differences:
    """How far a fitted response is from a curve in level."""
    octaves = np.gradient(np.log2(curve.frequency_hz))
    octaves = octaves / octaves.sum()
    off = as_db(response_at(curve.frequency_hz)) - as_db(curve.values)
    uncertain = curve.deviation / np.abs(curve.values) / np.sqrt(2.0) * 20.0 / np.log(10.0)
    return Differences(
        float(np.sqrt(octaves @ off**2)),
        float(np.abs(off).max()),
        float(np.sqrt(octaves @ np.minimum(uncertain, 20.0) ** 2)),
    )


def _in_band(curve: Curve | None, band: tuple[float, float], what: str) -> Curve | None:
    if curve is None:
        return None
    lo, hi = band
    if not 0.0 < lo < hi:
        raise MeasurementError(
            f"band: expected a lower and a higher frequency, got {lo:g} to {hi:g} Hz"
        )
    found = curve.within(lo, hi)
    if len(found.values) < 50:
        raise MeasurementError(
            f"{what}: {len(found.values)} lines from {lo:g} to {hi:g} Hz are too few to fit"
        )
    return found


def _doubts(modes: Modes, off: Differences, band: tuple[float, float]) -> list[str]:
    """Warnings about fitted modes; those outside the band stand for what is there."""
    found = []
    ring_s = 3.0 * np.log(10.0) / (2.0 * np.pi * modes.frequency_hz * modes.damping)
    strong = modes.inverse_mass / modes.damping / modes.frequency_hz
    inside = (modes.frequency_hz >= band[0]) & (modes.frequency_hz <= band[1])
    long = inside & (ring_s > LONGEST_S) & (strong > 0.01 * strong.max())
    lines = long & (ring_s > SHARPEST_S)
    if lines.any():
        found.append(
            f"modes at {_places(modes, lines)} Hz have no width: hum of the mains, or a fan"
        )
    if (strings := long & ~lines).any():
        rings = f"modes at {_places(modes, strings)} Hz ring for {ring_s[strings].max():.1f} s"
        found.append(f"{rings}, as strings that are not damped do")
    return found + _poor(off, "admittance")


def _places(modes: Modes, which: Any) -> str:
    return ", ".join(f"{hz:.0f}" for hz in modes.frequency_hz[which])


def _poor(off: Differences, what: str) -> list[str]:
    if off.rms > POOR_DB and off.rms > 2.0 * off.scatter:
        is_off = f"{what}: the fit is {off.rms:.1f} dB off the measurement (rms)"
        return [f"{is_off}, which itself scatters by {off.scatter:.1f} dB"]
    return []
