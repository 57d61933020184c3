"""What is heard of a recording: its pitch, its level and how much it changes, each 5 ms.

Where there is a pitch, and which of its candidates it is, the cheapest path (Viterbi) over all of a
recording tells: a candidate costs by how little the sound is like itself a period before, and by
how sure the tracker is of another; a leap costs, so that no octave is left for a moment.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.errors import ScoreError
from yehu_server.following.frames import (
    BACK,
    CANDIDATES,
    FLOOR_DB,
    HOP_S,
    SILENCE_DB,
    Frames,
    Listener,
)
from yehu_server.following.recording import Recording, form_of, heard_blocks, need_follow

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
Progress = Callable[[float, float], None]
# Of the loud frames, so many must have a pitch, and be so like themselves a period before.
LEAST_VOICED, LEAST_LIKENESS, DOUBTFUL = 0.08, 0.55, 0.8
LOUD_DB = 25.0  # below the loudest


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


@dataclass(frozen=True)
class Heard:
    """What was heard; all arrays have the shape (frames,)."""

    name: str  # of the recording
    pitch_hz: Array  # NaN where there is no pitch
    level_db: Array  # A-weighted, in dB of full scale
    flux_db: Array  # how much louder the bands of the spectrum are than 20 ms before, on the mean
    # How like the sound is to itself a period before, up to 1; 0 where there is no pitch.
    likeness: Array
    warnings: tuple[str, ...] = ()

    @property
    def times_s(self) -> Array:
        """The middle of each frame."""
        return np.arange(len(self.pitch_hz)) * HOP_S

    @property
    def duration_s(self) -> float:
        """About how long the recording lasts."""
        return len(self.pitch_hz) * HOP_S

    @property
    def is_voiced(self) -> Array:
        """Whether there is a pitch."""
        return np.isfinite(self.pitch_hz)


def hear(recording: Recording, progress: Progress | None = None) -> Heard:
    """Listen to a recording; `progress` is called with the seconds heard and those there are.

    Raises ScoreError, one line: where it cannot be read, or no single voice is heard;
    ParameterError where the libraries of the extra are missing.
    """
    need_follow()
    form = form_of(recording)
    listener = Listener()
    for block in heard_blocks(recording, form):
        listener.push(block)
        if progress is not None:
            progress(listener.time_s, form.duration_s)
    frames = listener.finish()
    path = decoded(frames)
    at = np.arange(len(path)), np.maximum(path, 0)
    is_voiced = path != NOT_VOICED
    pitch = np.where(is_voiced, frames.pitch_hz[at], np.nan)
    likeness = np.where(is_voiced, frames.likeness[at], 0.0)
    level = np.maximum(frames.level_db - form.gain_db, SILENCE_DB)
    flux = _flux(frames.bands_db)
    warnings = (*form.warnings, *_doubts(recording.name, frames.level_db, likeness))
    return Heard(recording.name, pitch, level, flux, likeness, warnings)


def _flux(bands_db: Array) -> Array:
    """How much louder the bands are than BACK frames before, on the mean (dB)."""
    levels = np.maximum(bands_db, FLOOR_DB)
    rise = np.zeros(len(levels))
    rise[BACK:] = np.maximum(levels[BACK:] - levels[:-BACK], 0.0).mean(axis=1)
    # The middle of the rise is between the two.
    return np.concatenate((rise[BACK // 2 :], np.zeros(min(BACK // 2, len(rise)))))


def _doubts(name: str, level_db: Array, likeness: Array) -> list[str]:
    """What speaks against a single voice; raises ScoreError where there is none."""
    loud = level_db > max(level_db.max(initial=SILENCE_DB) - LOUD_DB, gate_of(level_db))
    voiced = likeness[loud] > 0.0
    share = float(voiced.mean()) if len(voiced) else 0.0
    if share < LEAST_VOICED:
        raise ScoreError(f"{name}: no voice is heard: {100.0 * share:.0f} % of it has a pitch")
    typical = float(np.median(likeness[loud][voiced]))
    if typical < LEAST_LIKENESS:
        raise ScoreError(f"{name}: not a single voice: chords or noise cannot be followed")
    if typical < DOUBTFUL:
        return ["several voices or much noise: what is heard is unsure"]
    return []
