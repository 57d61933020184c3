"""How alike two sounds of one phrase are that differ in their last bits."""

import numpy as np
from ahead.phrases import RATE

from yehu_server.playing.pitch_and_level import a_weighted_db, cents, pitch_hz

FIRST = 2000  # samples in which the model's chaos has not grown yet
PART = 12000  # samples that are compared by pitch and level
NEAR_CENTS, NEAR_DB = 1.0, 0.3  # nearer than this counts as equal


def begins_alike(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether the first samples differ by at most 1e-6 of the peak."""
    peak = np.abs(other).max()
    return bool(np.abs(one[:FIRST] - other[:FIRST]).max() <= 1e-6 * peak)


def apart(one: np.ndarray, other: np.ndarray) -> tuple[float, float]:
    """How far pitch (cents) and level (dB) are apart at most, over parts of a sound.

    Both have the shape (frames, channels); the mean of the channels is compared.
    """
    one, other = one.mean(axis=1), other.mean(axis=1)
    pitches, levels = [0.0], []
    for start in range(PART, len(one) - PART + 1, PART):
        parts = [sound[start : start + PART] for sound in (one, other)]
        found = [pitch_hz(part, RATE) for part in parts]
        if np.isfinite(found).all():
            pitches.append(abs(cents(*found)))
        levels.append(abs(np.subtract(*(a_weighted_db(part, RATE) for part in parts))))
    return max(pitches), max(levels)
