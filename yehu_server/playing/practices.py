"""Read and write what was practised: shipped for usual sample rates, or the user's own."""

from __future__ import annotations

import json
import math
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.documents import parse_json
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.files import read_text, replacing
from yehu_server.player.bowing import FIRST, LAST, MANNER, PLACES
from yehu_server.player.practice import bowing_table

Array = Any

SHIPPED = Path(__file__).parent / "practices.json"
FORMAT, VERSION = "yehu-server practice", 1
MOST_BYTES = 1 << 20
# Bounds of top speed (m/s), three shares of Schelleng's limit, distance, finger force (N).
LOWEST = (0.02, 0.0, 0.0, 0.0, 0.2, 0.0)
HIGHEST = (2.0, 12.0, 12.0, 12.0, 5.0, 10.0)


def shipped_practice(rate: float) -> Array:
    """The practice that comes with this version, of the nearest sample rate (Hz)."""
    tables = _shipped()
    return tables[min(tables, key=lambda practised: abs(math.log(practised / rate)))].copy()


@lru_cache(maxsize=1)
def _shipped() -> dict[float, Array]:
    data = json.loads(read_text(SHIPPED))
    return {float(entry["rate"]): table_of(entry) for entry in data}


def as_data(table: Array, rate: float) -> dict[str, Any]:
    """A table of bowing as JSON values: the notes that are bowed otherwise than usually."""
    usual = bowing_table()
    bowing = {
        str(place): {
            str(FIRST + row): [round(float(value), 4) for value in table[i, row]]
            for row in range(LAST - FIRST + 1)
            if not np.allclose(table[i, row], usual[i, row], atol=1e-4)
        }
        for i, place in enumerate(PLACES)
    }
    return {"format": FORMAT, "version": VERSION, "rate": rate, "bowing": bowing}


def table_of(data: Any) -> Array:
    """The table of bowing of JSON values that `as_data` made.

    Raises
    ------
    ParameterError
        Where they are none, or a value is out of range.
    """
    table = bowing_table()
    try:
        if data["format"] != FORMAT or data["version"] != VERSION:
            raise ParameterError("is not a practice that this version knows")
        for place, notes in data["bowing"].items():
            for note, values in notes.items():
                row = np.array(values, np.float64)
                if row.shape != (MANNER,) or not FIRST <= int(note) <= LAST:
                    raise ParameterError(f"note {note}: expected {MANNER} numbers")
                if not np.all((row >= LOWEST) & (row <= HIGHEST)):  # also refuses NaN
                    raise ParameterError(f"note {note}: a value is out of range")
                table[PLACES.index(float(place)), int(note) - FIRST] = row
    except (KeyError, TypeError, ValueError, OverflowError, AttributeError) as error:
        raise ParameterError("is not a practice") from error
    return table


def read_practice(path: Path) -> Array:
    """Read the table of a practice file.

    Raises
    ------
    ScoreError
        Where it cannot be read.
    ParameterError
        Where it is no practice.
    """
    try:
        return table_of(parse_json(read_text(path, MOST_BYTES)))
    except OSError as error:
        raise ScoreError(f"{path}: {error.strerror}") from error
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error
    except ValueError as error:  # no UTF-8, or no JSON
        raise ParameterError(f"{path}: is not a practice ({error})") from error


def write_practice(path: Path, table: Array, rate: float) -> None:
    """Write a practice file.

    Raises
    ------
    OutputError
        Where it cannot be written.
    """
    with replacing(path) as partial:
        partial.write_text(json.dumps(as_data(table, rate), indent=1) + "\n", encoding="utf-8")
