"""The table of vibratos: narrower, and off the note's middle, where the level would swing.

A body may radiate several decibels more at a pitch than some cents beside it. A vibrato about such
a pitch is narrower, and its middle a little off, to the side where the body is more even.
"""

from functools import lru_cache
from typing import Any

import numpy as np

from yehu_server.core.physics.default_quantities import Body
from yehu_server.core.physics.elementary import decibels, elementwise, exp2
from yehu_server.core.physics.radiation import magnitude, response_parts
from yehu_server.core.physics.shelf import shelf_gain
from yehu_server.core.player.brilliance import usual_shelf
from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.note_tables import OPEN_NOTES, Tables
from yehu_server.util.loudness import a_weighting

Array = Any

STEPS = 53  # half semitones from the lowest note up
DEPTH_SHARE, CENTRE = range(2)  # columns of the table
# Depths to either side (cents): the usual; the narrowest that people play [Pop]; and what is left
# where even that swings too far.
DEFAULT_DEPTH_CENTS, NARROW_DEPTH_CENTS, MIN_DEPTH_CENTS = 30, 20, 15
MAX_OFF_CENTS = 8  # cents: a middle as near to the note is in tune
# From the loudest to the softest moment of a turn, of the usual vibrato and of a narrow one, where
# the pitch strays: near a mode of the body it goes farther than the finger.
MAX_DB, MAX_NARROW_DB, STRAY = 5.0, 6.0, 8
HARMONICS = 8


@lru_cache(maxsize=64)
def vibrato_table(
    body: Body, a4: float, open_notes: tuple[float, float], centroids: Tables = ()
) -> Array:
    """How a vibrato about each pitch is played.

    `a4`: reference pitch (Hz).
    `open_notes`: MIDI notes; the lower one is of the first row.
    `centroids`: as of a `NoteTables`; without them no note is made brighter.

    Returns
    -------
    ndarray [shape=(STEPS, 2)]
        DEPTH_SHARE is the depth, as a share of DEFAULT_DEPTH_CENTS, and of a wider one; CENTRE
        how far the middle is above the note, as a share of the depth.
    """
    margin = DEFAULT_DEPTH_CENTS + STRAY + MAX_OFF_CENTS
    pitches = open_notes[0] + 0.01 * np.arange(-margin, 50 * (STEPS - 1) + margin + 1)
    frequency_hz = np.outer(
        a4 * elementwise(exp2, (pitches - 69.0) / 12.0), np.arange(1, HARMONICS + 1)
    )
    heard = _plain(body, frequency_hz)
    table = np.empty((STEPS, 2))
    for row in range(STEPS):
        near = slice(50 * row, 50 * row + 2 * margin + 1)
        own = heard[near]
        if centroids:
            pitch = open_notes[0] + 0.5 * row
            string = int(pitch >= open_notes[1] + OPEN_WITHIN)
            on_a_yehu = pitch - open_notes[string] + OPEN_NOTES[string]
            gain_db, shelf_hz = usual_shelf(centroids[string], string, on_a_yehu)
            own = own * shelf_gain(frequency_hz[near], body.radiation_rate, gain_db, shelf_hz)
        depth, off = _way(decibels((own * own).sum(axis=1) + 1e-30), margin)
        table[row] = depth / DEFAULT_DEPTH_CENTS, off / depth
    table.flags.writeable = False
    return table


def _way(level: Array, note: int) -> tuple[int, int]:
    """Depth, and how far its middle is above the note (cents).

    `level`: in dB, at each cent about the note, which is at index `note`.
    """

    def swing(depth: int, off: int) -> float:
        reach = depth + STRAY
        return float(np.ptp(level[note + off - reach : note + off + reach + 1]))

    def evenest(depth: int) -> int:
        offs = sorted(range(-MAX_OFF_CENTS, MAX_OFF_CENTS + 1), key=abs)
        return min(offs, key=lambda off: swing(depth, off))

    if swing(DEFAULT_DEPTH_CENTS, 0) <= MAX_DB:
        return DEFAULT_DEPTH_CENTS, 0
    depth = (
        NARROW_DEPTH_CENTS
        if swing(NARROW_DEPTH_CENTS, evenest(NARROW_DEPTH_CENTS)) <= MAX_NARROW_DB
        else MIN_DEPTH_CENTS
    )
    return depth, evenest(depth)


def _plain(body: Body, frequency_hz: Array) -> Array:
    """How strong a bowed string's harmonics are heard, the lowest first, without brilliance.

    Their force on the bridge falls as 1/n; the body radiates them, and the ear hears them
    (A-weighted). `frequency_hz`: of the harmonics, in columns. Returns amplitudes in that shape.
    """
    n = np.arange(1, frequency_hz.shape[1] + 1)
    is_measured = frequency_hz < 0.5 * body.radiation_rate
    radiated = response_parts(
        np.array(body.sections), np.array([body.direct_gain]), body.radiation_rate,
        np.where(is_measured, frequency_hz, 0.0),
    )  # fmt: skip
    return magnitude(radiated) * is_measured * a_weighting(frequency_hz) / n
