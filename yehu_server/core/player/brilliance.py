"""The brightness that a heavier or a nearer bow adds to a note, beyond the model's. Compiled.

A fiddle sounds brighter when it is bowed harder or nearer to the bridge: force sharpens the corner
of the Helmholtz motion [Schoonderwaldt]. The model's corner stays as round at any force, by its
losses, its hair and its friction (docs/playing.md lists what was tried). What is missing is added
by a law: the spectral centroid of a note follows speed and pressure of the bow, and its place. A
shelf at the output raises what lies above the centroid, as far as the calibration found that it
has to.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, uncompiled
from yehu_server.core.physics.elementary import exp2, log2
from yehu_server.core.player.intonation import ALL, in_tables, place_in
from yehu_server.core.player.note_tables import ABOVE, GAINS, PLAIN
from yehu_server.core.player.ownership import DEFAULT_RAMP_MS, move_parameter
from yehu_server.core.player.parameter_indices import BODY, PLAYING
from yehu_server.params.table import find

# The bow whose sound is the model's own: speed times share of Schelleng's limit (m/s), and place.
PLAIN_EFFORT, PLAIN_PLACE = 0.026, 0.13
USUAL_EFFORT = find("/playing/speed").default * find("/playing/pressure").default
USUAL_PLACE = find("/playing/bow_position").default
# Octaves of the centroid for each doubling of the effort, and for each halving of the distance
# from the bridge. From soft to loud that is 0.2 octaves for 10 dB, in recordings of a cello 0.14.
HARDER, NEARER = 0.2, 0.6
# A frequency that falls slowly does not raise what still rings of a higher note.
LOWERING_MS = 90.0


@compiled_exactly
def octaves_brighter(effort: float, place: float) -> float:
    """How far (octaves) a note's centroid is to lie above that of the model.

    `effort` (m/s) is the bow's speed times its share of Schelleng's limit, above 0; `place` its
    distance from the bridge, as a share of the sounding length.
    """
    harder = HARDER * log2(effort / PLAIN_EFFORT)
    return float(harder - NEARER * log2(place / PLAIN_PLACE))


@compiled_exactly
def set_brilliance(p: Any, c: Any, string: int, pitch: float, effort: float) -> None:
    """Set ``/body/brilliance`` and its frequency for a pitch and an effort of the bow (m/s).

    `p.louder_by` becomes the decibels (A-weighted) that they add.
    """
    row, part = place_in(ALL[string], in_tables(p, string, pitch))
    plain = measured(p.centroids[string], row, part, PLAIN)
    if not (effort > 0.0 and plain > 0.0):  # no bow, or no calibration
        return
    aim = plain * exp2(octaves_brighter(effort, p.value[PLAYING.bow_position]))
    gain_db, below = GAINS[0], 0.0
    for column in range(len(GAINS)):
        above = measured(p.centroids[string], row, part, column)
        if column > 0:
            share = min((aim - below) / max(above - below, 1e-9), 1.0)
            gain_db = GAINS[column - 1] + share * (GAINS[column] - GAINS[column - 1])
        if above >= aim:
            break
        below = above
    gain_db *= p.value[PLAYING.brilliance]
    p.louder_by = louder_by(p.louder[string], row, part, gain_db)
    more_db = p.contours.bright_db
    move_parameter(p, c, BODY.brilliance, gain_db + more_db, DEFAULT_RAMP_MS)
    frequency = ABOVE * plain
    ramp_ms = LOWERING_MS if frequency < p.sent[BODY.brilliance_frequency] else DEFAULT_RAMP_MS
    move_parameter(p, c, BODY.brilliance_frequency, frequency, ramp_ms)


def usual_shelf(centroids: Any, string: int, pitch: float) -> tuple[float, float]:
    """Gain (dB) and frequency (Hz) that a pitch of a yehu's string has, as the usual bow draws it.

    `centroids`: of the notes of that string, as of a `NoteTables`.
    """
    rows = np.array(centroids)
    own = [np.interp(pitch, ALL[string], column) for column in rows.T]
    brighter = uncompiled(octaves_brighter)(USUAL_EFFORT, USUAL_PLACE)
    aim = own[PLAIN] * exp2(brighter)
    return float(np.interp(aim, np.maximum.accumulate(own), GAINS)), float(ABOVE * own[PLAIN])


@compiled_exactly
def measured(table: Any, row: int, part: float, column: int) -> float:
    """A column of a table between two of its rows."""
    return float(table[row, column] + part * (table[row + 1, column] - table[row, column]))


@compiled_exactly
def louder_by(table: Any, row: int, part: float, gain_db: float) -> float:
    """How much louder (dB) a gain makes a note; beyond GAINS, as at their ends."""
    column = 0
    while column < len(GAINS) - 2 and gain_db >= GAINS[column + 1]:
        column += 1
    share = (gain_db - GAINS[column]) / (GAINS[column + 1] - GAINS[column])
    low, high = measured(table, row, part, column), measured(table, row, part, column + 1)
    return float(low + min(max(share, 0.0), 1.0) * (high - low))
