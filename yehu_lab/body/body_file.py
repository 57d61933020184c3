"""A fitted body with its measurement, and body files: write one, and read it again.

A body file is JSON: what `physics.default_quantities.read_body` reads, and beside it what was
measured and how the fit went, which `yehu-server body show` draws.
"""

import json
import os
import re
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.body.curve import Complexes, Curve, Floats
from yehu_lab.body.measurement import Measurement
from yehu_lab.body.modes import Modes
from yehu_server.core.physics.default_quantities import (
    Body,
    Quantities,
    read_body,
    read_quantities,
)
from yehu_server.core.physics.radiation import response
from yehu_server.errors import MeasurementError, OutputError
from yehu_server.util import __version__
from yehu_server.util.documents import Document, looks_like
from yehu_server.util.files import check_free, check_target, write_bytes

FORMAT = "yehu-server body"  # in the files that `save` writes
DIGITS = 7


@dataclass(frozen=True)
class Differences:
    """How far a fit is from its measurement (dB), over the band by octaves."""

    rms: float
    most: float
    scatter: float  # rms of what the measurement itself is uncertain by


@dataclass(frozen=True)
class Fit:
    """A body that was fitted to a measurement, and how well.

    Parameters
    ----------
    body : Body
        What the model plays: ``Quantities(body=fit.body)``.
    measurement : Measurement
        Over the band of the fit.
    band_hz : tuple of float
        The band of the fit.
    admittance_db, radiation_db : Differences, optional
        Where that was measured.
    warnings : tuple of str
        Of the measurement and of the fit.
    """

    body: Body
    measurement: Measurement
    band_hz: tuple[float, float]
    admittance_db: Differences | None
    radiation_db: Differences | None
    warnings: tuple[str, ...]

    @property
    def modes(self) -> Modes:
        """The bridge modes, as arrays."""
        mass, omega = np.array(self.body.mass), np.array(self.body.omega)
        damping = np.array(self.body.damping) / (2.0 * mass * omega)
        return Modes(np.array(self.body.frequency_hz), damping, 1.0 / mass)

    def admittance(self, frequency_hz: Floats | float) -> Complexes:
        """Velocity per force (s/kg) of the fitted modes at frequencies, in their shape."""
        at_hz = np.asarray(frequency_hz, np.float64)
        return self.modes.admittance(at_hz.reshape(-1)).reshape(at_hz.shape)

    def radiation(self, frequency_hz: Floats | float) -> Complexes:
        """Pressure per force (Pa/N) of the fitted sections at frequencies, in their shape."""
        body, at_hz = self.body, np.asarray(frequency_hz, np.float64)
        sections = np.array(body.sections).reshape(-1, 4)
        gains = np.array([body.direct_gain])
        found = response(sections, gains, body.radiation_rate, at_hz.reshape(-1))
        return np.asarray(found).reshape(at_hz.shape)

    def save(self, target: str | os.PathLike[str], *, overwrite: bool = False) -> tuple[Path, ...]:
        """Write a body file (.json), or an instrument file (.toml) and its body file beside it.

        An instrument file that names the body already is left as it is.

        Returns
        -------
        written : tuple of Path

        Raises
        ------
        OutputError
            Where they cannot be written, or are there and `overwrite` is false.
        """
        target = Path(target)
        check_targets(target, overwrite=overwrite)
        body_file = body_file_of(target)
        write_bytes(body_file, as_text(self).encode(), overwrite=overwrite)
        if target == body_file or names_body(target, body_file):
            return (body_file,)
        write_bytes(target, _instrument(self, body_file).encode(), overwrite=overwrite)
        return (target, body_file)


def body_file_of(target: Path) -> Path:
    """The body file of an instrument file, or itself."""
    is_body = target.suffix.lower() == ".json"
    return target if is_body else target.with_name(f"{target.stem}.body.json")


def check_targets(target: Path, *, overwrite: bool = False) -> None:
    """Check that `Fit.save` may write.

    Raises OutputError where it may not, or the name ends otherwise than an instrument or body
    file's.
    """
    if target.suffix.lower() not in (".toml", ".json"):
        raise OutputError(f"{target}: name an instrument file, .toml, or a body file, .json")
    body_file = body_file_of(target)
    for path in {target, body_file}:
        check_target(path)
    if overwrite:
        return
    check_free(body_file)
    if target != body_file and target.exists() and not names_body(target, body_file):
        raise OutputError(
            f"{target}: exists; write body = {json.dumps(body_file.name)} in it, or --overwrite it"
        )


def names_body(target: Path, body_file: Path) -> bool:
    """Whether an instrument file names a body file."""
    try:
        named = _document(target).toml().data.get("body")
    except MeasurementError:
        return False
    return isinstance(named, str) and (target.parent / named).resolve() == body_file.resolve()


def as_text(fit: Fit) -> str:
    """A fit as the text of its body file."""
    body, measured = fit.body, fit.measurement
    data: dict[str, Any] = {
        "format": FORMAT,
        "about": f"A body fitted by yehu-server {__version__} to {_sources(measured)}.",
        "bridge_modes": [
            {"frequency_hz": hz, "mass_kg": mass, "damping_kg_per_s": damping}
            for hz, mass, damping in zip(body.frequency_hz, body.mass, body.damping, strict=True)
        ],
        "radiation": {
            "sample_rate_hz": body.radiation_rate,
            "sections": [list(section) for section in body.sections],
            "direct_gain": body.direct_gain,
        },
        "fit": quality_of(fit),
        "measured": {
            "admittance": _columns(measured.admittance),
            "radiation": _columns(measured.radiation),
        },
    }
    text = json.dumps(data, indent=1, allow_nan=False)
    # Lists of numbers, each in a line.
    in_a_line = re.compile(r"\[\s+([-+\d.eE,\s]+?)\s+\]")
    return in_a_line.sub(lambda values: f"[{' '.join(values[1].split())}]", text) + "\n"


def quality_of(fit: Fit) -> dict[str, Any]:
    """How a fit went, as JSON values."""
    return {
        "band_hz": list(fit.band_hz),
        "admittance_db": fit.admittance_db and asdict(fit.admittance_db),
        "radiation_db": fit.radiation_db and asdict(fit.radiation_db),
        "warnings": list(fit.warnings),
        "sources": list(fit.measurement.sources),
    }


def read_fit(path: Path) -> Fit:
    """Read a body file, or the body that an instrument file names, with what was measured of it.

    Raises ParameterError where the body cannot be read; MeasurementError where the file cannot, or
    what was measured.
    """
    if path.suffix.lower() == ".toml":
        data = _document(path).toml().data
        kind = looks_like(data, "an instrument file")
        if ("base" not in data or kind) and data.keys().isdisjoint(vars(Quantities())):
            raise MeasurementError(f"{path}: is not an instrument or body file{kind}")
        named = data.get("body")
        if named is None:
            return bare_fit(read_quantities(path).body)
        path = path.parent / str(named)
    data = _document(path).json().data
    fitted = bare_fit(read_body(path))
    if "measured" not in data or "fit" not in data:
        return fitted
    try:
        fit, measured = data["fit"], data["measured"]
        warnings = tuple(str(line) for line in fit["warnings"])
        sources = tuple(str(name) for name in fit["sources"])
        lo, hi = (float(hz) for hz in fit["band_hz"])
        measurement = Measurement(
            _curve(measured["admittance"]), _curve(measured["radiation"]), hi, (), sources
        )
        return replace(
            fitted,
            measurement=measurement,
            band_hz=(lo, hi),
            admittance_db=_differences(fit["admittance_db"]),
            radiation_db=_differences(fit["radiation_db"]),
            warnings=warnings,
        )
    except (KeyError, TypeError, ValueError, OverflowError, AttributeError) as error:
        raise MeasurementError(f"{path}: what was measured cannot be read ({error!r})") from error


def _document(path: Path) -> Document:
    return Document(path, "an instrument or body file", MeasurementError).read(path)


def bare_fit(body: Body) -> Fit:
    """A body of which nothing was measured."""
    band = (100.0, min(8000.0, body.radiation_rate / 2.0))
    return Fit(body, Measurement(None, None), band, None, None, ())


def _instrument(fit: Fit, body_file: Path) -> str:
    sources = _sources(fit.measurement).replace("\n", " ")
    return (
        f"# A yehu with the body of {sources}.\n"
        "# Other quantities of the instrument, such as its strings, may be added here.\n"
        f"body = {json.dumps(body_file.name, ensure_ascii=False)}\n"
    )


def _sources(measured: Measurement) -> str:
    names = [re.sub(r"[^ -~]", "?", name) for name in measured.sources]
    return ", ".join(names[:5]) + (" and others" if names[5:] else "") or "a measurement"


def _columns(curve: Curve | None) -> dict[str, Any] | None:
    """A curve as lists of numbers, lines averaged that lie closer than can be drawn."""
    if curve is None:
        return None
    drawn = curve.grouped()

    def rounded(values: Any) -> list[float]:
        return [float(f"{value:.{DIGITS}g}") for value in values]

    return {
        "taps": drawn.taps,
        "frequency_hz": rounded(drawn.frequency_hz),
        "real": rounded(drawn.values.real),
        "imag": rounded(drawn.values.imag),
        "coherence": None if drawn.coherence is None else rounded(drawn.coherence),
    }


def _curve(data: Any) -> Curve | None:
    if data is None:
        return None
    names = ["frequency_hz", "real", "imag"] + ["coherence"] * (data["coherence"] is not None)
    columns = [np.array(data[name], np.float64) for name in names]
    frequency_hz, real, imag, *coherence = columns
    is_whole = frequency_hz.ndim == 1 and len(frequency_hz) > 5
    if not is_whole or any(column.shape != frequency_hz.shape for column in columns):
        raise ValueError("its curves are damaged")
    if not np.isfinite(columns).all():
        raise ValueError("a number is not finite")
    if np.diff(frequency_hz).min() <= 0.0 or not frequency_hz[0] > 0.0:
        raise ValueError("its frequencies do not rise")
    of_taps = coherence[0] if coherence else None
    return Curve(frequency_hz, real + 1j * imag, of_taps, int(data["taps"]))


def _differences(data: Any) -> Differences | None:
    if data is None:
        return None
    return Differences(*(float(data[each.name]) for each in fields(Differences)))
