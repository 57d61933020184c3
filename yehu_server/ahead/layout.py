"""The layout of what `look` sees, for programs that have no header: pages."""

from __future__ import annotations

import math
from typing import Any

from yehu_server.engine.look import LOOK

WORD = 8  # bytes


def look_layout() -> dict[str, list[int]]:
    """Tell where each field of a look begins and how long it is, in float64 numbers."""
    fields: Any = LOOK.fields
    return {name: [fields[name][1] // WORD, math.prod(LOOK[name].shape)] for name in fields}


def look_length() -> int:
    """Length of a look, in float64 numbers."""
    return LOOK.itemsize // WORD
