"""The bowing table: bow speed, force and position for each note, so that it speaks. Compiled.

Notes near the body's modes (A4 at 439 Hz above all) and the open F string jump to other
registers under a fast or a heavy bow. The table for each string is found by playing the model
(`yehu_lab.practising.bowing_search`); `default_bowing_table` is what that search starts from.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import log
from yehu_server.core.physics.layout import STRINGS

Array = Any

# Values of /playing/pressure: those for which the table has a share of Schelleng's limit, and where
# notes begin to scratch.
FLAUTANDO, LIGHT, FIRM, SCRATCHY = 0.2, 0.3, 0.55, 1.0
# Fractions of Schelleng's limit at which notes begin to scratch, on each string;
# measured at 0.12 and 0.2 m/s on eight notes: 1 to 2, and 3 to 6.
SCRATCH_FRACTIONS = np.array((1.3, 4.0))

# A bowing is an entry of the table, for one note at one place of the bow: the highest bow speed
# (m/s) at which it speaks; values of /bow/pressure for FLAUTANDO, LIGHT and FIRM; a factor on the
# distance of the bow from the bridge; the least finger force (N).
TOP_SPEED, AT_FLAUTANDO, AT_LIGHT, AT_FIRM, DISTANCE_FACTOR, MIN_PRESS = range(6)
BOWING_SIZE = 6
DEFAULT_BOWING = (0.6, FLAUTANDO, LIGHT, FIRM, 1.0, 0.0)
# The notes of the table, as a yehu's strings have them, up to two octaves above the outer one.
# Beyond them all are bowed as these.
FIRST_NOTE, LAST_NOTE = 64, 96
# The bow positions of the table; beyond them all notes are bowed as at these.
BOW_POSITIONS = (0.06, 0.08, 0.1, 0.13, 0.165, 0.2, 0.25)
LOG_POSITIONS = np.array([log(place) for place in BOW_POSITIONS])
NOTES = LAST_NOTE - FIRST_NOTE + 1
# On the F string the bow is no nearer to the bridge than here: nearer, the body disturbs it more,
# and Schelleng's wedge is narrower.
MIN_POSITION_ON_F = 0.17


def default_bowing_table() -> Array:
    """All notes bowed alike: ndarray [shape=(STRINGS, len(BOW_POSITIONS), NOTES, BOWING_SIZE)]."""
    table = np.tile(np.array(DEFAULT_BOWING), (STRINGS, len(BOW_POSITIONS), NOTES, 1))
    table[0, :, :, DISTANCE_FACTOR] = np.maximum(MIN_POSITION_ON_F / np.array(BOW_POSITIONS), 1.0)[
        :, None
    ]
    return table


@compiled_exactly
def bowing_value(table: Array, string: int, place: float, pitch: float, column: int) -> float:
    """A column of how a pitch (fractional MIDI note) is bowed at a place on a string; interpolated.

    `table` has the shape (STRINGS, len(BOW_POSITIONS), NOTES, BOWING_SIZE); columns are TOP_SPEED,
    AT_FLAUTANDO, AT_LIGHT, AT_FIRM, DISTANCE_FACTOR and MIN_PRESS.
    """
    at = log(place)
    row = 0
    while row < len(LOG_POSITIONS) - 2 and at >= LOG_POSITIONS[row + 1]:
        row += 1
    part = (at - LOG_POSITIONS[row]) / (LOG_POSITIONS[row + 1] - LOG_POSITIONS[row])
    near = at_pitch(table[string, row], pitch, column)
    far = at_pitch(table[string, row + 1], pitch, column)
    return float(near + min(max(part, 0.0), 1.0) * (far - near))


@compiled_exactly
def at_pitch(bowings: Array, pitch: float, column: int) -> float:
    """The same at one of BOW_POSITIONS; `bowings` has shape (NOTES, BOWING_SIZE)."""
    pitch = min(max(pitch, FIRST_NOTE), LAST_NOTE)
    row = min(math.floor(pitch), LAST_NOTE - 1)
    low, high = bowings[row - FIRST_NOTE, column], bowings[row + 1 - FIRST_NOTE, column]
    return float(low + (pitch - row) * (high - low))


@compiled_exactly
def bow_pressure_for(
    flautando: float, light: float, firm: float, command: float, string: int
) -> float:
    """``/bow/pressure`` for a ``/playing/pressure``, by those of FLAUTANDO, LIGHT and FIRM."""
    if command <= FLAUTANDO:
        return flautando * command / FLAUTANDO
    if command <= LIGHT:
        return flautando + (light - flautando) * (command - FLAUTANDO) / (LIGHT - FLAUTANDO)
    if command <= FIRM:
        return light + (firm - light) * (command - LIGHT) / (FIRM - LIGHT)
    return float(firm + (SCRATCH_FRACTIONS[string] - firm) * (command - FIRM) / (SCRATCHY - FIRM))
