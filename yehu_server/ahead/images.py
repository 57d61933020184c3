"""Images of instruments: the record of one that is ready to play, for each of the usual rates.

Only words that are not zero are kept, as runs: where one begins, how long it is, and its words.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from yehu_server.engine.ensemble import Ensemble
from yehu_server.engine.instrument import Instrument
from yehu_server.engine.rig import memory_bytes
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.style import Style

Array = Any

# A run is worth its two words of heading only beyond a gap as long as that.
SHORTEST_GAP = 3


def image(rate: float) -> Array:
    """Make the image of a calibrated instrument that is ready to play.

    Parameters
    ----------
    rate : float, Hz

    Returns
    -------
    ndarray [dtype=int64]
        First word, number of words, the words; again; to the end.
    """
    memory = bytearray(memory_bytes(1))
    calibration = calibration_for(rate)

    def make(place: Any) -> Instrument:
        return Style().instrument(rate, calibration, memory=place, is_live=True)

    Ensemble([make], memory=memory)
    words = np.frombuffer(memory, np.int64)
    return np.concatenate([np.zeros(0, np.int64), *runs(words)])


def runs(words: Array) -> Iterable[Array]:
    """The runs of words of a record [dtype=int64] that are not zero, each with its heading."""
    places = np.flatnonzero(words)
    for run in np.split(places, np.flatnonzero(np.diff(places) > SHORTEST_GAP) + 1):
        if len(run):
            first, count = int(run[0]), int(run[-1] - run[0] + 1)
            yield np.array([first, count, *words[first : first + count]], np.int64)
