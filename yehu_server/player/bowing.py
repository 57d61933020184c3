"""Bow speed, force and position for each note, so that it speaks in its own register. Compiled.

Notes near the body's modes (A4 at 439 Hz above all) and the open F string jump to other
registers under a fast or a heavy bow. The values were chosen by bowing each note at 44.1 kHz,
separate and slurred from its neighbours, at several speeds, positions and fractions of Schelleng's
limit, for the soonest and most stable onset; scripts/playability.py measures the result. On the F
string the bow is farther from the bridge: there the body disturbs less, and Schelleng's wedge is
wider.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.jit import compiled_exactly

Array = Any

# Values of /playing/pressure: the two for which a manner has a share of Schelleng's limit, and
# where notes begin to scratch.
LIGHT, FIRM, SCRATCHY = 0.3, 0.55, 1.0
# Fractions of Schelleng's limit at which notes begin to scratch, on the F and on the C string;
# measured at 0.12 and 0.2 m/s on eight notes: 1 to 2, and 3 to 6.
EDGE_ON_F, EDGE_ON_C, FIRST_ON_C = 1.3, 4.0, 71.5

# A manner is how a note is bowed: the highest bow speed (m/s) at which it speaks; the values of
# /bow/pressure for LIGHT and FIRM; a factor on the distance of the bow from the bridge; the least
# finger force (N).
TOP_SPEED, AT_LIGHT, AT_FIRM, FARTHER, LEAST_PRESS = range(5)
MANNER = 5
ORDINARY = (0.6, LIGHT, FIRM, 1.0, 0.0)
MANNERS = {
    65: (0.2, 0.4, 0.5, 1.7, 0.0),
    66: (0.2, 0.25, 0.35, 1.7, 3.0),
    67: (0.2, 0.3, 0.4, 1.7, 0.0),
    68: (0.2, 0.3, 0.4, 1.3, 0.0),
    69: (0.1, 0.5, 0.6, 1.3, 0.0),
    70: (0.2, LIGHT, FIRM, 1.0, 0.0),
    71: (0.17, 0.3, 0.4, 1.0, 0.0),
    76: (0.22, LIGHT, FIRM, 1.0, 0.0),
    78: (0.25, 0.33, FIRM, 1.0, 0.0),
    79: (0.25, 0.33, FIRM, 1.0, 0.0),
    80: (0.25, 0.33, FIRM, 1.0, 0.0),
    83: (0.2, LIGHT, FIRM, 1.15, 3.0),
    85: (0.26, LIGHT, FIRM, 1.0, 0.0),
    89: (0.25, LIGHT, FIRM, 1.0, 0.0),
}
FIRST, LAST = 64, 91  # the notes of the table; beyond them all are ordinary


def bowing_table() -> Array:
    """The manners of the notes FIRST to LAST: ndarray [shape=(notes, MANNER)]."""
    return np.array([MANNERS.get(note, ORDINARY) for note in range(FIRST, LAST + 1)])


@compiled_exactly
def manner(table: Array, pitch: float, column: int) -> float:
    """One value of how a pitch (fractional MIDI note) is bowed; interpolated between notes.

    Parameters
    ----------
    table : ndarray
        See `bowing_table`.
    column : int
        TOP_SPEED, AT_LIGHT, AT_FIRM, FARTHER or LEAST_PRESS.
    """
    pitch = min(max(pitch, FIRST), LAST)
    row = min(math.floor(pitch), LAST - 1)
    low, high = table[row - FIRST, column], table[row + 1 - FIRST, column]
    return float(low + (pitch - row) * (high - low))


@compiled_exactly
def share(light: float, firm: float, wish: float, pitch: float) -> float:
    """The value of ``/bow/pressure`` for one of ``/playing/pressure``, at a pitch.

    Parameters
    ----------
    light, firm : float
        The values for LIGHT and FIRM.
    """
    edge = EDGE_ON_C if pitch >= FIRST_ON_C else EDGE_ON_F
    if wish <= LIGHT:
        return light * wish / LIGHT
    if wish <= FIRM:
        return light + (firm - light) * (wish - LIGHT) / (FIRM - LIGHT)
    return firm + (edge - firm) * (wish - FIRM) / (SCRATCHY - FIRM)
