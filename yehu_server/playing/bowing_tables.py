"""Read bowing tables, shipped or the user's own ("practices", of `practise`)."""

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.physics.elementary import log
from yehu_server.core.player.bowing import (
    BOW_POSITIONS,
    BOWING_SIZE,
    FIRST_NOTE,
    LAST_NOTE,
    default_bowing_table,
)
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.params.table import STRING_NAMES
from yehu_server.util.files import error_reason, read_text
from yehu_server.util.parsing import parse_json

Array = Any

SHIPPED = Path(__file__).parent / "practices.json"
ENDING = ".practice.json"
FORMAT, VERSION = "yehu-server practice", 2
MAX_BYTES = 1 << 20
# Bounds of top speed (m/s), three shares of Schelleng's limit, distance, finger force (N).
LOWEST = (0.02, 0.0, 0.0, 0.0, 0.2, 0.0)
HIGHEST = (2.0, 12.0, 12.0, 12.0, 5.0, 10.0)


def shipped_bowing_table(rate: float) -> Array:
    """The bowing table that comes with this version, of the nearest sample rate (Hz)."""
    tables = _shipped()
    return tables[min(tables, key=lambda practised: abs(log(practised / rate)))].copy()


@lru_cache(maxsize=1)
def _shipped() -> dict[float, Array]:
    data = json.loads(read_text(SHIPPED))
    return {float(entry["rate"]): table_of(entry) for entry in data}


def table_of(data: Any) -> Array:
    """The bowing table of a practice file's JSON values; raises ParameterError."""
    table = default_bowing_table()
    try:
        if data["format"] != FORMAT or data["version"] != VERSION:
            raise ParameterError("is not a practice that this version knows; practise anew")
        for name, places in data["bowing"].items():
            for place, notes in places.items():
                own = table[STRING_NAMES.index(name), BOW_POSITIONS.index(float(place))]
                for note, values in notes.items():
                    own[int(note) - FIRST_NOTE] = _bowing_of(note, values)
    except (KeyError, TypeError, ValueError, OverflowError, AttributeError) as error:
        raise ParameterError("is not a practice") from error
    return table


def _bowing_of(note: str, values: Any) -> Array:
    bowing = np.array(values, np.float64)
    if bowing.shape != (BOWING_SIZE,) or not FIRST_NOTE <= int(note) <= LAST_NOTE:
        raise ParameterError(f"note {note}: expected {BOWING_SIZE} numbers")
    if not np.all((bowing >= LOWEST) & (bowing <= HIGHEST)):  # also refuses NaN
        raise ParameterError(f"note {note}: a value is out of range")
    return bowing


def read_bowing_table(path: Path) -> Array:
    """Read a practice file; raises ScoreError if not readable, ParameterError if it is none."""
    try:
        return table_of(parse_json(read_text(path, MAX_BYTES)))
    except OSError as error:
        raise ScoreError(f"{path}: {error_reason(error)}") from error
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error
    except ValueError as error:  # no UTF-8, or no JSON
        raise ParameterError(f"{path}: is not a practice ({error})") from error


def bowing_table_beside(instrument: Path | None) -> Path | None:
    """The bowing table beside an instrument file, of the same name and `ENDING`, if it is there."""
    path = instrument.with_suffix(ENDING) if instrument is not None and instrument.name else None
    return path if path is not None and path.is_file() else None
