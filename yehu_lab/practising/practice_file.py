"""Write bowing tables, which ``yehu_server.playing.bowing_tables`` reads, as practice files."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.player.bowing import (
    BOW_POSITIONS,
    FIRST_NOTE,
    LAST_NOTE,
    default_bowing_table,
)
from yehu_server.params.table import STRING_NAMES
from yehu_server.playing.bowing_tables import FORMAT, VERSION
from yehu_server.util.files import write_bytes

Array = Any


def as_text(data: Any) -> str:
    """What `as_data` made as JSON, with a line for each note."""
    text = json.dumps(data, indent=1)
    row = re.compile(r"\[\s+([-\d.,\s]+?)\s+\]")
    return row.sub(lambda values: f"[{' '.join(values[1].split())}]", text) + "\n"


def as_data(table: Array, rate: float) -> dict[str, Any]:
    """A bowing table as JSON values: what is bowed otherwise than in `default_bowing_table`."""
    ordinary = default_bowing_table()
    bowing = {
        name: {
            str(place): {
                str(FIRST_NOTE + row): [round(float(value), 4) for value in table[string, i, row]]
                for row in range(LAST_NOTE - FIRST_NOTE + 1)
                if not np.allclose(table[string, i, row], ordinary[string, i, row], atol=1e-4)
            }
            for i, place in enumerate(BOW_POSITIONS)
        }
        for string, name in enumerate(STRING_NAMES)
    }
    return {"format": FORMAT, "version": VERSION, "rate": rate, "bowing": bowing}


def write_bowing_table(path: Path, table: Array, rate: float, *, overwrite: bool = True) -> None:
    """Write a practice file; raises OutputError where it cannot be written."""
    write_bytes(path, as_text(as_data(table, rate)).encode(), overwrite=overwrite)
