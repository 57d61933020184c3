"""Decides, over all of a recording, where there is a pitch and which of its candidates it is.

The cheapest path (Viterbi): a candidate costs by how little the sound is like itself a period
before, and by how sure the tracker is of another; a leap costs, so that no octave is left for a
moment.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.following.frames import CANDIDATES, Frames

Array = Any

UNLIKE = 1.2  # cost of a frame that is not like itself at all, a period before
# Cost of a frame for another candidate than the tracker's: in any case, and where that is sure.
OTHER, OTHER_SURE = (0.0, 0.25, 0.15, 0.4, 0.3, 0.15), 0.35
SWITCH = 1.5  # cost of a pitch that begins or ends
# Cost of an octave from frame to frame, beyond what is free, up to the most.
SLOPE, FREE, LEAP = 6.0, 0.02, 3.0
QUIET = 2.0  # cost of a pitch in a frame that is quieter than the gate
GATE_DB, LOUD_SHARE = 45.0, 0.95  # below the level that this part of the frames does not reach
LEAST_DB = -85.0
NOT_VOICED = -1


def gate_of(level_db: Array) -> float:
    """The level (dB) below which nothing is meant to be heard."""
    return max(float(np.quantile(level_db, LOUD_SHARE)) - GATE_DB, LEAST_DB)


def decoded(frames: Frames) -> Array:
    """Which candidate each frame has: ndarray [shape=(frames,), int]; NOT_VOICED for none."""
    count = len(frames.level_db)
    cost = UNLIKE * (1.0 - np.clip(frames.likeness, 0.0, 1.0))
    sure = frames.certainty[:, None]
    cost = cost + np.array(OTHER) + OTHER_SURE * sure * (np.arange(CANDIDATES) > 0)
    cost += (1.0 - sure) + QUIET * (frames.level_db < gate_of(frames.level_db))[:, None]
    cost = np.where(np.isfinite(frames.pitch_hz), cost, 1e6)
    octaves = np.log2(np.where(np.isfinite(frames.pitch_hz), frames.pitch_hz, 1.0))
    unvoiced = frames.certainty
    came = np.zeros((count, CANDIDATES + 1), np.int8)
    best = np.append(cost[0], unvoiced[0]) if count else np.zeros(CANDIDATES + 1)
    steps = np.full((CANDIDATES + 1, CANDIDATES + 1), SWITCH)
    steps[-1, -1] = 0.0
    rows = np.arange(CANDIDATES + 1)
    for at in range(1, count):
        leap = np.abs(octaves[at - 1][:, None] - octaves[at][None, :])
        steps[:-1, :-1] = np.minimum(SLOPE * np.maximum(leap - FREE, 0.0), LEAP)
        total = best[:, None] + steps
        origin = total.argmin(axis=0)
        came[at] = origin
        best = total[origin, rows]
        best[:-1] += cost[at]
        best[-1] += unvoiced[at]
        best -= best.min()
    path = np.full(count, NOT_VOICED)
    state = int(best.argmin()) if count else CANDIDATES
    for at in range(count - 1, -1, -1):
        path[at] = NOT_VOICED if state == CANDIDATES else state
        state = int(came[at, state])
    return path
