"""Whether an admittance can be one: its kind, its sign and its size.

Where hammer and sensor are at the same point and in the same direction, masses on springs and
dashpots can make what was measured, with amounts that are not below zero. What they cannot make
is of another kind, the wrong way round, or was measured at two points.
"""

from itertools import product
from typing import Any

import numpy as np

from yehu_lab.body.curve import KINDS, Curve, Floats, to_mobility
from yehu_lab.body.modes import mode_columns, stacked
from yehu_server.errors import MeasurementError
from yehu_server.util.hints import require_package

DOUBTFUL = 0.97  # share of the real part that is above zero
LINES = 300  # of the measurement, that are checked
LATTICE = (0.004, 0.02, 0.08, 0.3)  # damping ratios of the masses on springs
STEP, BEYOND = 3.0, 3.0  # half-widths between two of them; how far beyond the band they reach
MATTERS = 0.05  # relative error
PLAIN, SURE, TOO_FAR = 1.2, 2.0, 5.0  # errors: of the right kind; of another; of none at all
SMALLER = 0.8  # another kind's error against the stated one's
SMALLEST, LARGEST = 1e-50, 1e50  # in any units
FAINTEST = 1e-9  # of the largest: below, nothing was measured
USUAL, POSSIBLE = (2e-3, 20.0), (1e-4, 100.0)  # s/kg, at the highest peak of a small body
LOUD, LOUDEST = (1e-2, 50.0), (1e-4, 500.0)  # Pa/N, at the highest peak


def check_admittance(curve: Curve, kind: str) -> list[str]:
    """Check a mobility (s/kg) that was measured as `kind`; return warnings.

    Raises MeasurementError where it is none: of another kind, of the wrong sign, in other units.
    """
    require_package("scipy", "the body workshop", "body")
    _check_numbers(curve, "admittance")
    misfit, other, sign = _likeliest(curve, kind)
    if (other, sign) != (kind, 1.0):
        raise MeasurementError(_explained(kind, other, sign))
    share = positive_share(curve.values)
    if misfit > TOO_FAR:
        raise MeasurementError(
            f"as {kind} this is not the admittance of one point, made by masses on springs: hammer "
            "and sensor belong at the same point, in the same direction, without a delay"
        )
    peak = float(np.abs(curve.values).max())
    _check_size(peak, POSSIBLE, "admittance", "s/kg", "mm, or of full scale")
    found = []
    if share < DOUBTFUL:
        found.append(
            f"the real part of the mobility is below zero for {1.0 - share:.0%} of it: hammer and "
            "sensor are apart, or one of them is late"
        )
    if not USUAL[0] <= peak <= USUAL[1]:
        found.append(f"the highest peak is {peak:.3g} s/kg, unusual for a fiddle: are units right?")
    return found


def _check_numbers(curve: Curve, what: str) -> None:
    """Refuse what no unit makes of a measurement: its squares would not be numbers."""
    sizes = np.abs(curve.values)
    if not SMALLEST < sizes.max() < LARGEST:  # also where one is not a number
        raise MeasurementError(f"{what}: its numbers are too large or too small for a measurement")
    if sizes.min() < FAINTEST * sizes.max():
        hz = curve.frequency_hz[sizes.argmin()]
        raise MeasurementError(
            f"{what}: is zero at {hz:g} Hz, where nothing can have been measured"
        )


def check_radiation(curve: Curve) -> list[str]:
    """Check a radiation (Pa/N); return warnings. Raises MeasurementError where units are others."""
    _check_numbers(curve, "radiation")
    peak = float(np.abs(curve.values).max())
    _check_size(peak, LOUDEST, "radiation", "Pa/N", "mPa, or of full scale")
    if not LOUD[0] <= peak <= LOUD[1]:
        return [f"the loudest peak is {peak:.3g} Pa/N, unusual for a fiddle: are units right?"]
    return []


def positive_share(values: Any) -> float:
    """How much of the real part's area is above zero, 0 to 1."""
    real = np.real(values)
    return float(real.clip(0.0).sum() / max(np.abs(real).sum(), 1e-300))


def _check_size(peak: float, bounds: tuple[float, float], what: str, unit: str, units: str) -> None:
    if not bounds[0] <= peak <= bounds[1]:
        raise MeasurementError(
            f"{what}: a peak of {peak:.3g} {unit} is not a fiddle's; is something given in {units}?"
        )


def _likeliest(curve: Curve, kind: str) -> tuple[float, str, float]:
    """The error of the stated kind, and the likeliest kind and sign.

    Another than the stated one only where its error is much smaller.
    """
    chosen = np.geomspace(curve.frequency_hz[0], curve.frequency_hz[-1], LINES)
    at = np.unique(np.searchsorted(curve.frequency_hz, chosen).clip(None, len(curve.values) - 1))
    hz, values = curve.frequency_hz[at], curve.values[at]
    relative = np.hypot(curve.deviation[at] / np.abs(values), MATTERS)
    columns = mode_columns(hz, *_lattice(hz))
    measured = to_mobility(hz, values, kind, back=True)

    def error(name: str, sign: float) -> float:
        return _misfit(columns, sign * to_mobility(hz, measured, name), relative)

    own = error(kind, 1.0)
    if own <= PLAIN:
        return own, kind, 1.0
    errors = {other: error(*other) for other in product(KINDS, (1.0, -1.0)) if other != (kind, 1.0)}
    name, sign = min(errors, key=lambda other: errors[other])
    is_other = errors[name, sign] < min(SURE, SMALLER * own)
    return (own, name, sign) if is_other else (own, kind, 1.0)


def _lattice(hz: Floats) -> tuple[Floats, Floats]:
    """Frequencies and dampings of masses on springs, close enough to make any admittance."""
    places = [
        np.exp(np.arange(np.log(hz[0] / BEYOND), np.log(hz[-1] * BEYOND), STEP * ratio))
        for ratio in LATTICE
    ]
    ratios = [np.full(len(row), ratio) for row, ratio in zip(places, LATTICE, strict=True)]
    return np.concatenate(places), np.concatenate(ratios)


def _misfit(columns: Any, mobility: Any, relative: Floats) -> float:
    """Error (rms, in what matters) of the best that masses on springs can make."""
    from scipy.optimize import nnls

    weight = 1.0 / (np.abs(mobility) * relative)
    matrix, wanted = stacked(columns * weight[:, np.newaxis]), stacked(mobility * weight)
    size = np.linalg.norm(matrix, axis=0)
    try:
        _, norm = nnls(matrix / size, wanted, maxiter=10 * len(size))
    except RuntimeError:  # too many turns: it is none
        return float(np.inf)
    return float(norm / np.sqrt(len(mobility)))


def _explained(kind: str, other: str, sign: float) -> str:
    """What a measurement is that was given as of a kind."""
    if other == kind:
        return "hammer or sensor is the wrong way round: masses and springs would be below zero"
    turned = "" if sign > 0.0 else ", the wrong way round"
    return f"this is {_article(other)}{turned}, and not {_article(kind)}: by its phase"


def _article(kind: str) -> str:
    return f"an {kind}" if kind[0] in "aeiou" else f"a {kind}"
