"""Where a body radiates so unevenly that a vibrato would swing the level, and what to do there.

A body may radiate several decibels more at a pitch than some cents beside it. A vibrato about such
a pitch is narrower, and its middle a little off, to the side where the body is more even.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from yehu_server.core.physics.quantities import Body
from yehu_server.core.physics.radiation import response

Array = Any

STEPS = 53  # half semitones from the lowest note up
NARROWED, LEANING = range(2)  # columns of the table
# Depths to either side (cents): the usual; the narrowest that people play [Pop]; and what is left
# where even that swings too far.
USUAL, NARROW, LEAST = 30, 20, 15
MOST_OFF = 8  # cents: a middle as near to the note is in tune
MOST_DB = 4.4  # from the loudest to the softest moment of a turn
HARMONICS = 8

# Depth, and how far its middle is above the note (cents), the best first.
_WAYS = (
    *((depth, 0) for depth in range(USUAL, NARROW - 1, -1)),
    *(
        (depth, side * off)
        for depth in range(USUAL, LEAST - 1, -1)
        for off in range(1, MOST_OFF + 1)
        for side in (1, -1)
    ),
)


@lru_cache(maxsize=64)
def vibrato_table(body: Body, a4: float, lowest: float) -> Array:
    """How a vibrato about each pitch is played.

    `a4`: reference pitch (Hz).
    `lowest`: MIDI note of the first row.

    Returns
    -------
    ndarray [shape=(STEPS, 2)]
        NARROWED is the depth, as a share of USUAL, and of a wider one; LEANING how far the middle
        is above the note, as a share of the depth.
    """
    margin = USUAL + MOST_OFF
    first = round(100.0 * lowest) - margin
    level = _level_db(body, a4, np.arange(first, first + 50 * (STEPS - 1) + 2 * margin + 1))

    def swing(row: int, depth: int, off: int) -> float:
        middle = margin + 50 * row + off
        return float(np.ptp(level[middle - depth : middle + depth + 1]))

    table = np.empty((STEPS, 2))
    for row in range(STEPS):
        even = (way for way in _WAYS if swing(row, *way) <= MOST_DB)
        narrowest = (way for way in _WAYS if way[0] == LEAST)
        depth, off = next(even, None) or min(narrowest, key=lambda way: swing(row, *way))
        table[row] = depth / USUAL, off / depth
    table.flags.writeable = False
    return table


def _level_db(body: Body, a4: float, cents: Array) -> Array:
    """Level (dB) of a bowed string at pitches (cents of a MIDI note), by the body's radiation.

    The force of a bowed string on its bridge has harmonics that fall as 1/n.
    """
    n = np.arange(1, HARMONICS + 1)
    frequency_hz = np.outer(a4 * np.exp2((cents - 6900) / 1200.0), n)
    radiated = response(
        np.array(body.sections), np.array([body.direct_gain]), body.radiation_rate,
        frequency_hz.ravel(),
    ).reshape(frequency_hz.shape)  # fmt: skip
    is_measured = frequency_hz < 0.5 * body.radiation_rate
    return 10.0 * np.log10((np.abs(radiated * is_measured / n) ** 2).sum(axis=1) + 1e-30)
