"""Generate yehu_server/core/physics/records.py, the types of the model's records, from layout.py.

.venv/bin/python scripts/records.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from yehu_server.core.physics import layout
from yehu_server.core.physics.power import TABLES

TARGET = Path(__file__).resolve().parent.parent / "yehu_server" / "core" / "physics" / "records.py"
RECORDS = {
    "Tables": (TABLES, "Tables of one power, power.py."),
    "Model": (layout.MODEL, "Coefficients of one sample rate."),
    "Motion": (layout.MOTION, "The state of the instrument."),
    "Contacts": (layout.CONTACTS, "Where bow and fingers touch the strings."),
    "Work": (layout.WORK, "Intermediate results of one step."),
    "State": (layout.STATE, "All that a step changes."),
}
HEAD = '''"""Types of the model's records; written by scripts/records.py from layout.py.

A record of an array of layout.MODEL or layout.STATE has these attributes in compiled code.
docs/notation.md has their symbols and units.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Records = NDArray[np.void]  # of layout.MODEL or layout.STATE
'''


def of(kind: np.dtype[np.void], name: str) -> str:
    """Return the type annotation of one field."""
    field = kind[name]
    for record, (other, _) in RECORDS.items():
        if field == other:
            return record
    scalar = field.base.type.__name__
    if field.shape:
        return "Array" if scalar == "float64" else f"NDArray[np.{scalar}]"
    return "float" if scalar == "float64" else "int"


def module() -> str:
    """Return the source text of the module."""
    parts = [HEAD]
    for record, (kind, doc) in RECORDS.items():
        lines = [f"    {name}: {of(kind, name)}" for name in kind.names or ()]
        parts.append(
            "\n".join([f"\n\nclass {record}(Protocol):", f'    """{doc}"""', "", *lines]) + "\n"
        )
    return "".join(parts)


if __name__ == "__main__":
    TARGET.write_text(module(), encoding="utf-8")
