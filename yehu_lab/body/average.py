"""Average taps of a hammer to an admittance and a radiation, with their coherence (H1)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_lab.body.curve import Curve, Floats, as_db, running_median, to_mobility
from yehu_lab.body.tap import BEFORE_S, Tap, pulse
from yehu_server.errors import MeasurementError

ENOUGH_TAPS = 3
ROLLED_OFF_DB = 25.0  # below its largest: the hammer excites no more
FADED = 0.1  # of the record, at its end
DRIFTED = 0.02  # of the peak, between the rest before the hit and the end
LOUD_BEFORE_DB = -25.0  # of what is there before the hit, against the hit
RINGS_DB, RINGS_FROM_S = -40.0, 0.4  # a body is silent by then; strings are not
KIND = {"velocity": "mobility", "displacement": "receptance", "acceleration": "accelerance"}


@dataclass(frozen=True)
class Averaged:
    """What taps show together."""

    admittance: Curve | None  # s/kg
    radiation: Curve | None  # Pa/N
    highest_hz: float  # up to where the hammer excites
    warnings: tuple[str, ...]


def average_taps(taps: Sequence[Tap]) -> Averaged:
    """Average taps, leaving out faulty ones while others remain.

    All have the same sample rate and the same responses. It is H1, the cross spectrum of force and
    response over the power spectrum of the force, which noise of the response does not bias. The
    force is taken as zero before and after the hit. Raises MeasurementError where they differ in
    rate or responses, or no tap is without fault.
    """
    if not taps:
        raise MeasurementError("no taps")
    first = taps[0]
    for tap in taps:
        if tap.rate != first.rate or set(tap.responses) != set(first.responses):
            raise MeasurementError(
                f"{tap.name}: has another sample rate or other channels than {first.name}"
            )
    warnings = [f"{tap.name}: left out, {' and '.join(tap.faults)}" for tap in taps if tap.faults]
    good = [tap for tap in taps if not tap.faults]
    if not good:
        raise MeasurementError(
            f"every tap has a fault: {taps[0].name}: {' and '.join(taps[0].faults)}"
        )
    if len(good) < ENOUGH_TAPS:
        count = "one tap" if len(good) == 1 else f"{len(good)} taps"
        warnings.append(f"{count} only: with {ENOUGH_TAPS} or more, noise and mistakes show")
    warnings += _doubts(good)
    length = min(len(tap.force) for tap in good)
    forces = np.array([np.fft.rfft(_hit_alone(tap.force)[:length]) for tap in good])
    frequency_hz = np.fft.rfftfreq(length, 1.0 / first.rate)
    highest = hammer_reach(frequency_hz, np.mean(np.abs(forces) ** 2, axis=0))
    curves: dict[str, Curve] = {}
    for what in first.responses:
        spectra = np.array([_spectrum(tap, what, length) for tap in good])
        curve = _h1(frequency_hz, forces, spectra)
        if what == "pressure":
            curves["radiation"] = curve
        else:
            values = to_mobility(curve.frequency_hz, curve.values, KIND[what])
            curves["admittance"] = Curve(curve.frequency_hz, values, curve.coherence, len(good))
    return Averaged(curves.get("admittance"), curves.get("radiation"), highest, tuple(warnings))


def _h1(frequency_hz: Any, forces: Any, spectra: Any) -> Curve:
    """H1 and coherence, without the line at 0 Hz."""
    cross = np.sum(spectra * forces.conj(), axis=0)[1:]
    power = np.sum(np.abs(forces) ** 2, axis=0)[1:]
    answer = np.sum(np.abs(spectra) ** 2, axis=0)[1:]
    coherence = None
    if len(forces) > 1:
        coherence = np.abs(cross) ** 2 / np.maximum(power * answer, 1e-300)
    return Curve(frequency_hz[1:], cross / np.maximum(power, 1e-300), coherence, len(forces))


def _hit_alone(force: Floats) -> Floats:
    """The force of the hit, and zero where the hammer does not touch."""
    first, end = pulse(force)
    touched, place = end - first, np.arange(len(force))
    return np.where((place >= first - touched) & (place < end + touched), force, 0.0)


def _spectrum(tap: Tap, what: str, length: int) -> Any:
    """Spectrum of a response, its constant removed and its end faded out."""
    values = tap.responses[what]
    before = values[: max(1, pulse(tap.force)[0] - round(1e-3 * tap.rate))]
    rest = values.mean() if len(before) < 0.5 * BEFORE_S * tap.rate else before.mean()
    shown = (values - rest)[:length]
    fade = round(FADED * length)
    window = np.ones(length)
    window[length - fade :] = np.cos(0.5 * np.pi * np.arange(1, fade + 1) / fade) ** 2
    return np.fft.rfft(shown * window)


def hammer_reach(frequency_hz: Any, power: Floats) -> float:
    """The frequency (Hz) up to which the hammer's spectrum is strong enough."""
    level = 0.5 * as_db(running_median(power, 5))
    weak = level < level.max() - ROLLED_OFF_DB
    weak &= frequency_hz > frequency_hz[int(level.argmax())]
    return float(frequency_hz[int(weak.argmax())]) if weak.any() else float(frequency_hz[-1])


def _doubts(taps: Sequence[Tap]) -> list[str]:
    """Warnings of responses that swing before the hit or longer than a body does, or that drift.

    The first tap of each kind is named.
    """
    swings = drifts = ""
    for tap in taps:
        first, _ = pulse(tap.force)
        part, late = round(0.1 * tap.rate), first + round(RINGS_FROM_S * tap.rate)
        for what, values in tap.responses.items():
            quiet = values[: max(0, first - round(1e-3 * tap.rate))]
            if what == "pressure" or len(quiet) < 50:
                continue
            if not swings and late + part <= len(values):
                now, then = (
                    float(np.std(_without_trend(values[start : start + part])))
                    for start in (late, first)
                )
                noise = float(np.std(quiet))
                if as_db(noise / then) > LOUD_BEFORE_DB:
                    fault = "it swings before the hit, too"
                    swings = f"{tap.name}: {fault}: noise, or hum of the mains"
                elif now > 3.0 * noise and as_db(now / then) > RINGS_DB:
                    fault = f"rings on {RINGS_FROM_S:g} s after the hit, as strings do"
                    swings = f"{tap.name}: {fault}: damp them with a strip of felt"
            if not drifts and len(values) >= first + 3 * part:
                rest = values - quiet.mean()
                off = abs(rest[-part:].mean()) / np.abs(rest).max()
                if off > DRIFTED:
                    fault = f"its {what} is {off:.0%} of its peak off at the end"
                    drifts = f"{tap.name}: {fault}: the sensor drifts; a high-pass filter mends it"
    return [line for line in (swings, drifts) if line]


def _without_trend(values: Floats) -> Floats:
    """Values less the parabola through them: what swings, and not what drifts."""
    time = np.linspace(-1.0, 1.0, len(values))
    return np.asarray(values - np.polynomial.Polynomial.fit(time, values, 2)(time))
