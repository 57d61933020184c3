"""Finger positions for pitches, and gains for even loudness, from a calibration. Compiled."""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import exp2, log
from yehu_server.core.physics.layout import STRINGS
from yehu_server.core.player.note_tables import OPEN_NOTES, PITCHES, ROWS_OF_A_YEHU, SPEEDS
from yehu_server.core.player.parameter_indices import ENGINE

Array = Any

OPEN_OF_TABLES = np.array(OPEN_NOTES, np.float64)
STOPPED = np.array(PITCHES)
ALL = np.array([(float(note), *row) for note, row in zip(OPEN_NOTES, PITCHES, strict=True)])
LOG_SPEEDS = np.array([log(speed) for speed in SPEEDS])


@compiled_exactly
def in_tables(p: Any, string: int, pitch: float) -> float:
    """The pitch of a yehu's string, for which tables are, that is stopped where this one is."""
    return float(pitch - (p.open_note[string] - OPEN_OF_TABLES[string]))


@compiled_exactly
def position_of(p: Any, string: int, pitch: float, speed: float, sharper: float) -> float:
    """Finger position (m) for a pitch (fractional MIDI note) on string 0 or 1.

    A faster bow changes the pitch: `speed` (m/s) is the one that is asked for. Notes
    that are bowed more slowly were measured so. `sharper` (cents) is what the ear adds to the
    measured sharpening.
    """
    stopped = in_tables(p, string, pitch)
    sharp = sharper + p.value[ENGINE.calibration] * read(
        p.sharpening[string], STOPPED[string], stopped, speed
    )
    frequency = p.a4 * exp2((pitch - sharp / 100.0 - 69.0) / 12.0)
    return float(p.bridge_x - p.wave_speed[string] / (2.0 * frequency))


@compiled_exactly
def balance_db(p: Any, string: int, pitch: float, speed: float) -> float:
    """Gain (dB) that makes a note as loud as the average note, at a requested `speed` (m/s).

    The pitch of an open string is that of its note. The average is of the notes of a yehu.
    """
    total = 0.0
    for on in range(STRINGS):
        for row in range(ROWS_OF_A_YEHU + 1):
            total += at_speed(p.levels[on, row], speed)
    own = read(p.levels[string], ALL[string], in_tables(p, string, pitch), speed)
    return float(total / (STRINGS * (ROWS_OF_A_YEHU + 1)) - own)


@compiled_exactly
def read(table: Array, pitches: Array, pitch: float, speed: float) -> float:
    """Interpolate a table of pitches and SPEEDS; beyond its ends, the end values apply."""
    row, part = place_in(pitches, pitch)
    low, high = at_speed(table[row], speed), at_speed(table[row + 1], speed)
    return float(low + part * (high - low))


@compiled_exactly
def place_in(pitches: Array, pitch: float) -> tuple[int, float]:
    """The row of a table at or below a pitch, and how far (0 to 1) it is to the next."""
    row = 0
    while row < len(pitches) - 2 and pitches[row + 1] <= pitch:
        row += 1
    part = (pitch - pitches[row]) / (pitches[row + 1] - pitches[row])
    return row, min(max(part, 0.0), 1.0)


@compiled_exactly
def at_speed(row: Array, speed: float) -> float:
    """Interpolate a value for each of SPEEDS, over the logarithm of the speed (m/s)."""
    logarithm = log(max(speed, 1e-3))
    column = 0
    while column < len(LOG_SPEEDS) - 2 and logarithm >= LOG_SPEEDS[column + 1]:
        column += 1
    part = (logarithm - LOG_SPEEDS[column]) / (LOG_SPEEDS[column + 1] - LOG_SPEEDS[column])
    return float(row[column] + min(max(part, 0.0), 1.0) * (row[column + 1] - row[column]))
