"""The pitch, level and spectral flux of a recording, each 5 ms.

The cheapest path (Viterbi) over all of a recording decides where there is a pitch, and which of its
candidates it is: a candidate costs more the less clear it is, and the surer the tracker is of
another; a leap costs, so that the octave is not wrong for a moment.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.errors import ScoreError
from yehu_server.following.frames import (
    CANDIDATES,
    FLOOR_DB,
    FLUX_FRAMES,
    HOP_S,
    SILENCE_DB,
    Analyser,
    Frames,
)
from yehu_server.following.recording import Recording, downmix_of, mono_blocks, need_follow

Array = Any

UNCLEAR = 1.2  # cost of a candidate whose clarity is 0
# Cost of another candidate than the tracker's: in any case, and where the tracker is certain.
OTHER, OTHER_CERTAIN = (0.0, 0.25, 0.15, 0.4, 0.3, 0.15), 0.35
SWITCH = 1.5  # cost of a pitch that begins or ends
# Cost of an octave from frame to frame, beyond what is free, up to the most.
SLOPE, FREE, LEAP = 6.0, 0.02, 3.0
QUIET = 2.0  # cost of a pitch in a frame that is quieter than the gate
GATE_DB, LOUD_SHARE = 45.0, 0.95  # below the level that this part of the frames does not reach
MIN_DB = -85.0
UNVOICED = -1
Progress = Callable[[float, float], None]
# Of the loud frames: the least share with a pitch, the least median of their clarity, and that from
# which there is no warning.
MIN_VOICED, MIN_CLARITY, CLEAR = 0.08, 0.55, 0.8
LOUD_DB = 25.0  # below the loudest


def gate_of(level_db: Array) -> float:
    """The level (dB) below which a sound is taken for silence."""
    return max(float(np.quantile(level_db, LOUD_SHARE)) - GATE_DB, MIN_DB)


def chosen_candidates(frames: Frames) -> Array:
    """The candidate of each frame: ndarray [shape=(frames,), int]; UNVOICED for none."""
    count = len(frames.level_db)
    cost = UNCLEAR * (1.0 - np.clip(frames.clarity, 0.0, 1.0))
    certainty = frames.certainty[:, None]
    cost = cost + np.array(OTHER) + OTHER_CERTAIN * certainty * (np.arange(CANDIDATES) > 0)
    cost += (1.0 - certainty) + QUIET * (frames.level_db < gate_of(frames.level_db))[:, None]
    cost = np.where(np.isfinite(frames.pitch_hz), cost, 1e6)
    octaves = np.log2(np.where(np.isfinite(frames.pitch_hz), frames.pitch_hz, 1.0))
    unvoiced = frames.certainty
    previous = np.zeros((count, CANDIDATES + 1), np.int8)
    best = np.append(cost[0], unvoiced[0]) if count else np.zeros(CANDIDATES + 1)
    steps = np.full((CANDIDATES + 1, CANDIDATES + 1), SWITCH)
    steps[-1, -1] = 0.0
    rows = np.arange(CANDIDATES + 1)
    for at in range(1, count):
        leap = np.abs(octaves[at - 1][:, None] - octaves[at][None, :])
        steps[:-1, :-1] = np.minimum(SLOPE * np.maximum(leap - FREE, 0.0), LEAP)
        total = best[:, None] + steps
        origin = total.argmin(axis=0)
        previous[at] = origin
        best = total[origin, rows]
        best[:-1] += cost[at]
        best[-1] += unvoiced[at]
        best -= best.min()
    path = np.full(count, UNVOICED)
    state = int(best.argmin()) if count else CANDIDATES
    for at in range(count - 1, -1, -1):
        path[at] = UNVOICED if state == CANDIDATES else state
        state = int(previous[at, state])
    return path


@dataclass(frozen=True)
class Heard:
    """The analysis of a recording; all arrays have the shape (frames,)."""

    name: str  # of the recording
    pitch_hz: Array  # NaN where there is no pitch
    level_db: Array  # A-weighted, in dB of full scale
    flux_db: Array  # spectral flux: mean rise of the bands over the last 20 ms
    clarity: Array  # how periodic the sound is, up to 1; 0 where there is no pitch
    warnings: tuple[str, ...] = ()

    @property
    def times_s(self) -> Array:
        """The middle of each frame."""
        return np.arange(len(self.pitch_hz)) * HOP_S

    @property
    def duration_s(self) -> float:
        """Duration of the recording, about."""
        return len(self.pitch_hz) * HOP_S

    @property
    def is_voiced(self) -> Array:
        """Whether there is a pitch."""
        return np.isfinite(self.pitch_hz)


def hear(recording: Recording, progress: Progress | None = None) -> Heard:
    """Analyse a recording; `progress` is called with the seconds done and those of all.

    Raises ScoreError, one line: where it cannot be read, or no single voice is heard;
    ParameterError where the libraries of the extra are missing.
    """
    need_follow()
    downmix = downmix_of(recording)
    analyser = Analyser()
    for block in mono_blocks(recording, downmix):
        analyser.push(block)
        if progress is not None:
            progress(analyser.time_s, downmix.duration_s)
    frames = analyser.finish()
    path = chosen_candidates(frames)
    at = np.arange(len(path)), np.maximum(path, 0)
    is_voiced = path != UNVOICED
    pitch = np.where(is_voiced, frames.pitch_hz[at], np.nan)
    clarity = np.where(is_voiced, frames.clarity[at], 0.0)
    level = np.maximum(frames.level_db - downmix.gain_db, SILENCE_DB)
    flux = _flux(frames.bands_db)
    warnings = (*downmix.warnings, *_warnings(recording.name, frames.level_db, clarity))
    return Heard(recording.name, pitch, level, flux, clarity, warnings)


def _flux(bands_db: Array) -> Array:
    """The mean rise (dB) of the bands over FLUX_FRAMES frames."""
    levels = np.maximum(bands_db, FLOOR_DB)
    rise = np.zeros(len(levels))
    rise[FLUX_FRAMES:] = np.maximum(levels[FLUX_FRAMES:] - levels[:-FLUX_FRAMES], 0.0).mean(axis=1)
    # The middle of the rise is between the two.
    return np.concatenate((rise[FLUX_FRAMES // 2 :], np.zeros(min(FLUX_FRAMES // 2, len(rise)))))


def _warnings(name: str, level_db: Array, clarity: Array) -> list[str]:
    """Warnings where it may be no single voice; raises ScoreError where it is none."""
    loud = level_db > max(level_db.max(initial=SILENCE_DB) - LOUD_DB, gate_of(level_db))
    voiced = clarity[loud] > 0.0
    share = float(voiced.mean()) if len(voiced) else 0.0
    if share < MIN_VOICED:
        raise ScoreError(f"{name}: no voice is heard: {100.0 * share:.0f} % of it has a pitch")
    typical = float(np.median(clarity[loud][voiced]))
    if typical < MIN_CLARITY:
        raise ScoreError(f"{name}: not a single voice: chords or noise cannot be followed")
    if typical < CLEAR:
        return ["several voices or much noise: what is heard is unsure"]
    return []
