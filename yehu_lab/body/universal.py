"""Responses and taps from Universal File Format, data set 58, as measuring systems write it."""

import contextlib
import io
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.body.curve import RADIATION, Curve
from yehu_lab.body.tables import Response, rising
from yehu_lab.body.tap import Tap, cut
from yehu_server.errors import MeasurementError
from yehu_server.util.files import error_reason, read_bytes
from yehu_server.util.hints import require_package

ENDINGS = (".uff", ".unv", ".uf", ".bunv")
MAX_BYTES = 256 * 2**20
RESPONSE, TIME, COHERENCE, UNITS = 4, 1, 6, 164
SMALLEST, LARGEST = 1e-9, 1e9  # units, to the metre and newton
# Specific data types of the format's record 9.
QUANTITY = {8: "displacement", 9: "force", 11: "velocity", 12: "acceleration", 13: "force",
            15: "pressure"}  # fmt: skip
KIND = {8: "receptance", 11: "mobility", 12: "accelerance", 15: RADIATION}
LENGTHS = {"displacement": 1, "velocity": 1, "acceleration": 1, "pressure": -2, "force": 0}


def read_universal(path: Path, kind: str | None) -> list[Tap] | list[Response]:
    """Read the responses of a file, or its taps where it holds signals over time.

    `kind` is that of responses whose type the file leaves open. Raises MeasurementError where it
    cannot be read, or no response in it was measured where the hammer struck.
    """
    sets = _sets(path)
    length, force = _units(sets)
    responses = [entry for entry in sets if entry.get("func_type") == RESPONSE]
    if responses:
        return _responses(path, responses, sets, kind, length, force)
    signals = [entry for entry in sets if entry.get("func_type") == TIME]
    if signals:
        return _taps(path, signals, length, force)
    raise MeasurementError(f"{path}: holds no frequency response and no time signal")


def _sets(path: Path) -> list[dict[str, Any]]:
    require_package("pyuff", "the body workshop", "body")
    import pyuff

    try:
        read_bytes(path, MAX_BYTES)  # the library reads pipes and directories, or tries to
    except OSError as error:
        raise MeasurementError(f"{path}: {error_reason(error)}") from error
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            file = pyuff.UFF(str(path))
            kinds = [int(kind) for kind in file.get_set_types()]
            wanted = [i for i, kind in enumerate(kinds) if kind in (58, UNITS)]
            sets = [file.read_sets(i) for i in wanted]
    except Exception as error:  # the library raises whatever a damaged file leads to
        raise MeasurementError(f"{path}: not a universal file ({str(error)[:80]})") from error
    if not any(int(entry.get("type", 0)) == 58 for entry in sets):
        raise MeasurementError(f"{path}: holds no data set 58")
    for entry in sets:
        _check(entry, path)
    return sets


def _check(entry: dict[str, Any], path: Path) -> None:
    """Refuse a data set that is not whole; the library passes it on as it is."""
    if int(entry.get("type", 0)) == UNITS:
        for name in ("length", "force"):
            if not SMALLEST < float(entry.get(name, 0.0)) < LARGEST:
                raise MeasurementError(f"{path}: its unit of {name} is none")
        return
    stated, found = int(entry.get("num_pts", 0)), len(entry.get("data", ()))
    if found == 0 or not found == stated == len(entry.get("x", ())):
        raise MeasurementError(f"{path}: a data set in it has {found} values, and says {stated}")


def _units(sets: list[dict[str, Any]]) -> tuple[float, float]:
    """Metres and newtons that the file's units of length and force are."""
    for entry in sets:
        if int(entry.get("type", 0)) == UNITS:
            return 1.0 / float(entry["length"]), 1.0 / float(entry["force"])
    return 1.0, 1.0


def _responses(
    path: Path,
    entries: list[dict[str, Any]],
    sets: list[dict[str, Any]],
    kind: str | None,
    length: float,
    force: float,
) -> list[Response]:
    """The response at the driving point, and radiation."""
    found: list[Response] = []
    skipped = 0
    for entry in entries:
        its_kind = KIND.get(int(entry.get("ordinate_spec_data_type", 0)), kind)
        if its_kind is None:
            raise MeasurementError(
                f"{path}: does not say what its responses are; name it by --kind"
            )
        # Units of response over force; those of pressure are force over length squared.
        scale = length ** (-2.0)
        if its_kind != RADIATION:
            to, by = int(entry.get("rsp_dir", 0)), int(entry.get("ref_dir", 0))
            if entry.get("rsp_node") != entry.get("ref_node") or abs(to) != abs(by):
                skipped += 1
                continue
            is_opposed = to * by < 0  # hammer and sensor point against each other
            scale = -length / force if is_opposed else length / force
        values: Any = np.asarray(entry["data"], np.complex128) * scale
        coherence = _coherence(entry, sets)
        curve = Curve(np.asarray(entry["x"], np.float64), values, coherence)
        if not np.isfinite(curve.values).all():
            raise MeasurementError(f"{path}: holds a number that is not finite")
        found.append(Response(rising(curve, str(path)), its_kind))
    if not found:
        raise MeasurementError(
            f"{path}: none of its {skipped} responses was measured where the hammer struck"
        )
    return found


def _coherence(entry: dict[str, Any], sets: list[dict[str, Any]]) -> Any:
    for other in sets:
        if (
            other.get("func_type") == COHERENCE
            and other.get("rsp_node") == entry.get("rsp_node")
            and len(other["data"]) == len(entry["data"])
        ):
            return np.real(other["data"]).clip(0.0, 1.0)
    return None


def _taps(path: Path, signals: list[dict[str, Any]], length: float, force: float) -> list[Tap]:
    """Taps of signals: each force begins another, and the responses after it belong to it."""
    taps: list[Tap] = []
    group: dict[str, Any] = {}
    rate = 0.0
    for entry in [*signals, None]:
        quantity = None
        if entry is not None:
            quantity = QUANTITY.get(int(entry.get("ordinate_spec_data_type", 0)))
            if quantity is None:
                raise MeasurementError(f"{path}: does not say what a signal in it is")
        if group and (quantity == "force" or entry is None):
            shortest = min(len(values) for values in group.values())
            named = {what: values[:shortest] for what, values in group.items()}
            taps += cut(rate, named, f"{path.name}, tap {len(taps) + 1}")
            group = {}
        if entry is not None and quantity is not None:
            scale = force if quantity in ("force", "pressure") else 1.0
            scale *= length ** LENGTHS[quantity]
            group[quantity] = np.real(np.asarray(entry["data"], np.complex128)) * scale
            rate = 1.0 / float(entry["abscissa_inc"])
    return taps
