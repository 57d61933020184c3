"""Find an instrument's calibration: shipped, cached in a checksummed file, or measured."""

import json
import logging
import math
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.compile import levels
from yehu_server.compile.cache_folder import data_folder
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.note_tables import (
    GAINS,
    OPEN_NOTES,
    PITCHES,
    ROWS_OF_A_YEHU,
    SPEEDS,
    NoteTables,
    Tables,
)
from yehu_server.errors import ParameterError
from yehu_server.playing import calibration
from yehu_server.playing.pitch_and_level import cents
from yehu_server.util.checksummed import ChecksumError, read_checksummed, write_checksummed
from yehu_server.util.files import error_reason, read_text
from yehu_server.util.values import whole

log = logging.getLogger(__name__)

SHIPPED = Path(__file__).parent / "calibrations.json"
# Bounds of what the rounds of a calibration can reach.
MAX_CENTS = calibration.ROUNDS * calibration.PLAUSIBLE_CENTS
MAX_SHARPENING_CENTS = max(calibration.USUAL_CENTS) + len(SPEEDS) * MAX_CENTS
MAX_LEVEL_DB = 200.0
MAX_CENTROID_HZ, MAX_LOUDER_DB = 1e5, 40.0
MIN_N, MAX_N = 1.0, 500.0
HIGHEST_KEY = 127


_unkept: dict[str, NoteTables] = {}  # what could not be written, by its key


def calibration_for(
    rate: float,
    quantities: Quantities | None = None,
    *,
    a4: float = 440.0,
    bowing: Any = None,
    progress: calibration.Progress | None = None,
) -> NoteTables:
    """Find the calibration of an instrument, or measure it in some seconds; see `calibrate`."""
    quantities = quantities or Quantities()
    key = calibration.calibration_key(
        float(rate), quantities, float(a4), bowing
    )  # 48000 is 48000.0
    if key in _shipped():
        return read_calibration(_shipped()[key], quantities, a4)
    # Another level rounds otherwise, so another's calibration is not what is measured here.
    path = data_folder() / f"calibration-{levels.level()}-{key}.json"
    found = _kept(path, quantities, a4) or _unkept.get(key)
    if found is None:
        found = calibration.calibrate(rate, quantities, a4=a4, bowing=bowing, progress=progress)
        try:
            write_checksummed(path, json.dumps(asdict(found)).encode())
        except OSError as error:
            log.warning(
                "%s: %s; the calibration is not kept for the next start", path, error_reason(error)
            )
            _unkept[key] = found
    return found


def read_calibration(data: Any, quantities: Quantities, a4: float) -> NoteTables:
    """Read the JSON values of a calibration of an instrument.

    Raises ParameterError where they are none, are for another pitch, or beyond what can be
    measured.
    """
    found = read_measured(data)
    if found.a4 != a4:
        raise ParameterError(f"is for another A4, {found.a4:g} Hz")
    for i, tension in enumerate(found.tensions):
        usual = calibration.starting_tension(quantities, a4, i)
        off = cents(tension, usual) / 2.0 if tension > 0.0 else math.inf
        if not abs(off) <= MAX_CENTS:
            raise ParameterError(f"has a tension of {tension:g} N where {usual:.3g} is usual")
    return found


def read_measured(data: Any) -> NoteTables:
    """Read the JSON values of a calibration, of whatever instrument.

    Raises ParameterError where they are none, or beyond what can be measured.
    """
    try:
        first, second = map(float, data["tensions"])
        inner, outer = (whole(note, 0, HIGHEST_KEY) for note in data.get("open_notes", OPEN_NOTES))
        a4 = float(data["a4"])
        most, of_speeds = MAX_SHARPENING_CENTS, len(SPEEDS)
        sharpening = _tables(data["sharpening"], 0, of_speeds, -most, most)
        levels = _tables(data["levels"], 1, of_speeds, -MAX_LEVEL_DB, MAX_LEVEL_DB)
        centroids, louder = data.get("centroids", ()), data.get("louder", ())  # older captures
        if len(centroids) or len(louder):
            centroids = _tables(centroids, 1, len(GAINS), 0.0, MAX_CENTROID_HZ)
            louder = _tables(louder, 1, len(GAINS), -MAX_LOUDER_DB, MAX_LOUDER_DB)
    except (KeyError, TypeError, ValueError, OverflowError, AttributeError) as error:
        raise ParameterError("is not a calibration") from error
    if not MIN_N <= min(first, second) <= max(first, second) <= MAX_N:  # also refuses NaN
        raise ParameterError(f"has tensions of {first:g} and {second:g} N")
    if inner >= outer:
        raise ParameterError(f"open strings of {inner} and {outer}: expected the lower one first")
    tensions, open_notes = (first, second), (inner, outer)
    return NoteTables(a4, tensions, sharpening, levels, open_notes, tuple(centroids), tuple(louder))


def _tables(data: Any, more_rows: int, columns: int, lo: float, hi: float) -> Tables:
    """A table of the notes of each string; raises TypeError or ValueError for no table."""
    tables = []
    for rows, pitches in zip(data, PITCHES, strict=True):
        table = np.array(rows, np.float64)
        if len(table) == ROWS_OF_A_YEHU + more_rows:  # of captures made when tables ended there
            table = np.concatenate(
                [table, table[-1:].repeat(len(pitches) - ROWS_OF_A_YEHU, axis=0)]
            )
        if table.shape != (len(pitches) + more_rows, columns):
            raise ValueError("shape")
        if not np.all((table >= lo) & (table <= hi)):  # also refuses NaN
            raise ValueError("range")
        tables.append(tuple(tuple(row) for row in table.tolist()))
    return tuple(tables)


@lru_cache(maxsize=1)
def _shipped() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(read_text(SHIPPED))
    return found


def _kept(path: Path, quantities: Quantities, a4: float) -> NoteTables | None:
    """The calibration in a file; None where there is none, or it is damaged."""
    try:
        payload = read_checksummed(path)
        return None if payload is None else read_calibration(json.loads(payload), quantities, a4)
    except (ChecksumError, ParameterError, ValueError, RecursionError) as error:
        log.warning("%s: %s; measuring anew", path, error)
        return None
