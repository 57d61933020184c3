"""The table of how notes are bowed that comes with this version."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.player.bowing import FIRST, FLAUTANDO, LAST, LIGHT, ORDINARY, PLACES
from yehu_server.player.fingering import LOWEST_NOTE

Array = Any

MANNERS = {
    65: (0.2, 0.4, 0.5, 1.7, 0.0),
    66: (0.2, 0.25, 0.35, 1.7, 3.0),
    67: (0.2, 0.3, 0.4, 1.7, 0.0),
    68: (0.2, 0.3, 0.4, 1.3, 0.0),
    69: (0.1, 0.5, 0.6, 1.3, 0.0),
    70: (0.2, 0.3, 0.55, 1.0, 0.0),
    71: (0.17, 0.3, 0.4, 1.0, 0.0),
    76: (0.22, 0.3, 0.55, 1.0, 0.0),
    78: (0.25, 0.33, 0.55, 1.0, 0.0),
    79: (0.25, 0.33, 0.55, 1.0, 0.0),
    80: (0.25, 0.33, 0.55, 1.0, 0.0),
    83: (0.2, 0.3, 0.55, 1.15, 3.0),
    85: (0.26, 0.3, 0.55, 1.0, 0.0),
    89: (0.25, 0.3, 0.55, 1.0, 0.0),
}


def bowing_table() -> Array:
    """How each note is bowed: ndarray [shape=(len(PLACES), ROWS, MANNER)]; see `manner`."""
    rows = []
    for note in range(FIRST, LAST + 1):
        known = max(note, LOWEST_NOTE)  # what is bent below the open string sounds as that
        if known in MANNERS:
            top, light, firm, farther, press = MANNERS[known]
            rows.append((top, light * FLAUTANDO / LIGHT, light, firm, farther, press))
        else:
            rows.append(ORDINARY)
    return np.array([rows] * len(PLACES))
