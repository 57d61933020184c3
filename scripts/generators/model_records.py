"""The module of the types of the model's records, from core/physics/layout.py."""

import numpy as np

from yehu_server.core.physics import layout, modal_string, planes
from yehu_server.core.physics.fixed_power import TABLES as POWER_TABLES

KINDS = {
    "Tables": (POWER_TABLES, "Tables of one power, power.py."),
    "Model": (layout.MODEL, "Coefficients of one sample rate."),
    "Motion": (layout.MOTION, "The state of the instrument."),
    "Contacts": (layout.CONTACTS, "Where bow and fingers touch the strings."),
    "Work": (layout.WORK, "Intermediate results of one step."),
    "State": (layout.STATE, "All that a step changes."),
    "Refined": (layout.REFINED, "What an instrument with torsion, or with wide hair, has besides."),
    "Planes": (planes.PLANES, "What an instrument in two directions has besides."),
    "Modal": (modal_string.MODAL, "What an instrument of modal strings has besides."),
}
HEAD = '''"""Types of the model's records; written by scripts/generate from layout.py.

In compiled code a record of an array of layout.MODEL, layout.STATE, layout.REFINED,
planes.PLANES or modal_string.MODAL has these attributes.
docs/notation.md has their symbols and units.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Records = NDArray[np.void]  # of layout.MODEL or layout.STATE
'''


def annotation(kind: np.dtype[np.void], name: str) -> str:
    field = kind[name]
    for record, (other, _) in KINDS.items():
        if field == other:
            return record
    scalar = field.base.type.__name__
    if field.shape:
        return "Array" if scalar == "float64" else f"NDArray[np.{scalar}]"
    return "float" if scalar == "float64" else "int"


def records() -> str:
    """Return the source text of the module of records."""
    parts = [HEAD]
    for record, (kind, doc) in KINDS.items():
        fields = [f"    {name}: {annotation(kind, name)}\n" for name in kind.names or ()]
        parts.append(f'\n\nclass {record}(Protocol):\n    """{doc}"""\n\n{"".join(fields)}')
    return "".join(parts)
