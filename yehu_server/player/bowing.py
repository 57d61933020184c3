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

# Values of /playing/pressure: those for which a manner has a share of Schelleng's limit, and where
# notes begin to scratch.
FLAUTANDO, LIGHT, FIRM, SCRATCHY = 0.2, 0.3, 0.55, 1.0
# Fractions of Schelleng's limit at which notes begin to scratch, on the F and on the C string;
# measured at 0.12 and 0.2 m/s on eight notes: 1 to 2, and 3 to 6.
EDGE_ON_F, EDGE_ON_C, FIRST_ON_C = 1.3, 4.0, 71.5

# A manner is how a note is bowed: the highest bow speed (m/s) at which it speaks; the values of
# /bow/pressure for FLAUTANDO, LIGHT and FIRM; a factor on the distance of the bow from the bridge;
# the least finger force (N).
TOP_SPEED, AT_FLAUTANDO, AT_LIGHT, AT_FIRM, FARTHER, LEAST_PRESS = range(6)
MANNER = 6
ORDINARY = (0.6, FLAUTANDO, LIGHT, FIRM, 1.0, 0.0)
FIRST, LAST = 64, 91  # the notes of the table; beyond them all are bowed as these
# The bow positions of the table; beyond them all notes are bowed as at these.
PLACES = (0.06, 0.08, 0.1, 0.13, 0.165, 0.2, 0.25)
LOG_PLACES = np.array([math.log(place) for place in PLACES])
NOTES = LAST - FIRST + 1


@compiled_exactly
def manner(table: Array, place: float, pitch: float, column: int) -> float:
    """One value of how a pitch (fractional MIDI note) is bowed; interpolated.

    Parameters
    ----------
    table : ndarray [shape=(len(PLACES), NOTES, MANNER)]
    place : float
        The bow position wished for.
    column : int
        TOP_SPEED, AT_FLAUTANDO, AT_LIGHT, AT_FIRM, FARTHER or LEAST_PRESS.
    """
    at = math.log(place)
    row = 0
    while row < len(LOG_PLACES) - 2 and at >= LOG_PLACES[row + 1]:
        row += 1
    part = (at - LOG_PLACES[row]) / (LOG_PLACES[row + 1] - LOG_PLACES[row])
    near = at_pitch(table[row], pitch, column)
    far = at_pitch(table[row + 1], pitch, column)
    return float(near + min(max(part, 0.0), 1.0) * (far - near))


@compiled_exactly
def at_pitch(manners: Array, pitch: float, column: int) -> float:
    """The same at one of PLACES; `manners` has shape (NOTES, MANNER)."""
    pitch = min(max(pitch, FIRST), LAST)
    row = min(math.floor(pitch), LAST - 1)
    low, high = manners[row - FIRST, column], manners[row + 1 - FIRST, column]
    return float(low + (pitch - row) * (high - low))


@compiled_exactly
def share(flautando: float, light: float, firm: float, wish: float, pitch: float) -> float:
    """The value of ``/bow/pressure`` for one of ``/playing/pressure``, at a pitch.

    Parameters
    ----------
    flautando, light, firm : float
        The values for FLAUTANDO, LIGHT and FIRM.
    """
    edge = EDGE_ON_C if pitch >= FIRST_ON_C else EDGE_ON_F
    if wish <= FLAUTANDO:
        return flautando * wish / FLAUTANDO
    if wish <= LIGHT:
        return flautando + (light - flautando) * (wish - FLAUTANDO) / (LIGHT - FLAUTANDO)
    if wish <= FIRM:
        return light + (firm - light) * (wish - LIGHT) / (FIRM - LIGHT)
    return firm + (edge - firm) * (wish - FIRM) / (SCRATCHY - FIRM)
