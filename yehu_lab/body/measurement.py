"""A measured body: read from files of any of the known kinds, averaged and checked."""

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from yehu_lab.body import universal
from yehu_lab.body.average import KIND, Averaged, average_taps
from yehu_lab.body.curve import KINDS, RADIATION, Curve, interpolated, to_mobility
from yehu_lab.body.plausible import check_admittance, check_radiation
from yehu_lab.body.tables import Response, read_table
from yehu_lab.body.tap import SOUND_ENDINGS, Tap, parse_channels, read_recording
from yehu_server.errors import MeasurementError

LOWEST_HZ, HIGHEST_HZ = 100.0, 8000.0  # of the band that is used, where no other is given
MIN_COHERENCE, MIN_SHARE = 0.8, 0.9
MAX_SENSOR_KG = 0.05
REACH_HZ = 4000.0  # a hammer that does not excite up to here misses modes that are heard


@dataclass(frozen=True)
class Measurement:
    """What was measured of a body.

    Parameters
    ----------
    admittance : Curve, optional
        Velocity per force at the bridge (s/kg).
    radiation : Curve, optional
        Sound pressure per force at the bridge (Pa/N).
    highest_hz : float
        Up to where the hammer excites (Hz).
    warnings : tuple of str
        What may be wrong with it, a line each.
    sources : tuple of str
        Names of the files.
    """

    admittance: Curve | None
    radiation: Curve | None
    highest_hz: float = HIGHEST_HZ
    warnings: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()


def read(
    paths: Sequence[str | os.PathLike[str]],
    *,
    radiation: Sequence[str | os.PathLike[str]] = (),
    channels: str | None = None,
    radiation_channels: str | None = None,
    kind: str | None = None,
    sensor_mass: float | None = None,
) -> Measurement:
    """Read and average measurements of one body.

    Parameters
    ----------
    paths : sequence of path
        Sound files of taps, tables (CSV) of taps or responses, universal files.
    radiation : sequence of path
        More of them, of which only the sound pressure is used.
    channels, radiation_channels : str, optional
        What the channels of sound files are, and their SI units at full scale, such as
        ``force=100,acceleration=500``. Those of radiation are by default the same.
    kind : str, optional
        What responses are whose files do not say: mobility, receptance, accelerance or radiation.
    sensor_mass : float, optional
        Of an accelerometer on the bridge (kg): its effect is taken off.

    Raises
    ------
    MeasurementError
        Where a file cannot be read, or cannot be what it is said to be.
    """
    if kind is not None and kind not in (*KINDS, RADIATION):
        raise MeasurementError(f"kind: {kind!r} is not one of {', '.join((*KINDS, RADIATION))}")
    if any(isinstance(each, str | os.PathLike) for each in (paths, radiation)):
        raise MeasurementError("give a list of paths, such as ['tap1.wav', 'tap2.wav']")
    try:
        files, others = list(map(Path, paths)), list(map(Path, radiation))
    except TypeError as error:
        raise MeasurementError(f"expected paths of files ({error})") from None
    if not files and not others:
        raise MeasurementError("name at least one file of measurements")
    taps, responses = _read_all(files, channels, kind)
    radiation_kind = RADIATION if radiation else None
    other_taps, other_responses = _read_all(others, radiation_channels or channels, radiation_kind)
    measured = average(taps, responses, sensor_mass=sensor_mass)
    if radiation:
        other = average([_pressure_alone(tap) for tap in other_taps], other_responses)
        measured = replace(
            measured,
            radiation=other.radiation,
            highest_hz=min(measured.highest_hz, other.highest_hz),
            warnings=(*measured.warnings, *(f"radiation: {line}" for line in other.warnings)),
        )
    return replace(measured, sources=tuple(path.name for path in (*files, *others)))


def _read_all(
    paths: Iterable[Path], channels: str | None, kind: str | None
) -> tuple[list[Tap], list[Response]]:
    scales = None if channels is None else parse_channels(channels)
    taps: list[Tap] = []
    responses: list[Response] = []
    for path in paths:
        ending = path.suffix.lower()
        if ending in universal.ENDINGS:
            found = universal.read_universal(path, kind)
        elif ending in SOUND_ENDINGS:
            found = read_recording(path, scales)
        elif ending in (".csv", ".txt", ".tsv"):
            found = read_table(path, scales, kind)
        else:
            raise MeasurementError(f"{path}: not a sound file, .csv or .uff")
        taps += [entry for entry in found if isinstance(entry, Tap)]
        responses += [entry for entry in found if isinstance(entry, Response)]
    return taps, responses


def _pressure_alone(tap: Tap) -> Tap:
    if "pressure" not in tap.responses:
        raise MeasurementError(f"{tap.name}: has no pressure, so no radiation")
    return replace(tap, responses={"pressure": tap.responses["pressure"]})


@np.errstate(over="ignore", invalid="ignore", divide="ignore")  # they are refused later
def average(
    taps: Sequence[Tap], responses: Sequence[Response] = (), *, sensor_mass: float | None = None
) -> Measurement:
    """Average taps and responses that are in memory, and check what they give; see `read`."""
    if sensor_mass is not None and not 0.0 <= sensor_mass <= MAX_SENSOR_KG:
        raise MeasurementError(
            f"sensor_mass: {sensor_mass:g} kg is not within 0 to {MAX_SENSOR_KG:g} kg"
        )
    averaged = average_taps(taps) if taps else Averaged(None, None, HIGHEST_HZ, ())
    warnings = list(averaged.warnings)
    highest = averaged.highest_hz
    kinds = {KIND[what] for tap in taps for what in tap.responses if what in KIND}
    admittance, radiation = averaged.admittance, averaged.radiation
    if len(kinds) > 1:
        raise MeasurementError("taps: give one of velocity, acceleration and displacement")
    for response in responses:
        if response.kind == RADIATION:
            radiation = _mean(radiation, response.curve)
        else:
            curve = response.curve
            values = to_mobility(curve.frequency_hz, curve.values, response.kind)
            admittance = _mean(admittance, replace(curve, values=values))
            kinds.add(response.kind)
    if len(kinds) > 1:
        raise MeasurementError(f"measured as {' and '.join(sorted(kinds))}: give one of them")
    if admittance is not None and sensor_mass:
        admittance, radiation = _unloaded(sensor_mass, admittance, radiation)
    elif "accelerance" in kinds and sensor_mass is None:
        warnings.append(
            "an accelerometer's mass lowers the modes: give it, and its effect is taken off"
        )
    if taps and highest < REACH_HZ:
        warnings.append(
            f"the hammer excites up to {highest:.0f} Hz only: a harder tip reaches higher"
        )
    for found, what in ((admittance, "admittance"), (radiation, "radiation")):
        if found is not None:
            warnings += _checked(found, what, highest, next(iter(kinds), "mobility"))
    return Measurement(admittance, radiation, highest, tuple(warnings))


def _unloaded(
    mass: float, admittance: Curve, radiation: Curve | None
) -> tuple[Curve, Curve | None]:
    """Responses as they would be without a mass (kg) on the bridge.

    The mass takes j omega m Y of each newton: what is left moves the bridge, and radiates.
    """

    def free(curve: Curve) -> Curve:
        loaded = interpolated(curve.frequency_hz, admittance.frequency_hz, admittance.values)
        share = 1.0 - 2j * np.pi * curve.frequency_hz * mass * loaded
        return replace(curve, values=curve.values / share)

    return free(admittance), None if radiation is None else free(radiation)


def _checked(curve: Curve, what: str, highest_hz: float, kind: str) -> list[str]:
    used = curve.within(LOWEST_HZ, min(highest_hz, HIGHEST_HZ))
    if len(used.values) < 20:
        raise MeasurementError(
            f"{what}: {len(used.values)} lines from {LOWEST_HZ:g} Hz up are too few"
        )
    found = check_admittance(used, kind) if what == "admittance" else check_radiation(used)
    if used.coherence is not None:
        share = float(np.mean(used.coherence >= MIN_COHERENCE))
        if share < MIN_SHARE:
            found.append(
                f"{what}: coherence is below {MIN_COHERENCE:g} at {1.0 - share:.0%} of "
                "frequencies: noise, or taps that differ"
            )
    return found


def _mean(one: Curve | None, other: Curve) -> Curve:
    """The mean of two curves, weighted by their taps, at the frequencies of the first."""
    if one is None:
        return other
    inside = one.within(float(other.frequency_hz[0]), float(other.frequency_hz[-1]))
    if len(inside.values) < 20:
        raise MeasurementError("responses of different bands cannot be averaged")
    hz = inside.frequency_hz
    again = interpolated(hz, other.frequency_hz, other.values)
    taps = one.taps + other.taps
    values = (inside.values * one.taps + again * other.taps) / taps
    return Curve(hz, values, inside.coherence, taps)
