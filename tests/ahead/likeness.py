"""How alike two sounds of one phrase are that differ in their last bits."""

import numpy as np
from ahead.phrases import RATE

from yehu_server.playing.pitch_and_level import a_weighted_db, cents, pitch_hz

FIRST = 2000  # samples in which the model's chaos has not grown yet
PART = 12000  # samples that are compared by pitch and level
NEAR = np.array([1.0, 0.3])  # cents and dB; nearer than this counts as equal


def begins_alike(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether the first samples differ by at most 1e-6 of the peak."""
    peak = np.abs(other).max()
    return bool(np.abs(one[:FIRST] - other[:FIRST]).max() <= 1e-6 * peak)


def apart(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """How far pitch (cents; 0 where there is none) and level (dB) are apart in parts of a sound.

    Both have the shape (frames, channels); the mean of the channels is compared.

    Returns
    -------
    ndarray [shape=(parts, 2)]
    """
    one, other = one.mean(axis=1), other.mean(axis=1)
    found = []
    for start in range(PART, len(one) - PART + 1, PART):
        parts = [sound[start : start + PART] for sound in (one, other)]
        pitches = [pitch_hz(part, RATE) for part in parts]
        off = abs(cents(*pitches)) if np.isfinite(pitches).all() else 0.0
        levels = [a_weighted_db(part, RATE) for part in parts]
        found.append((off, abs(levels[0] - levels[1])))
    return np.array(found)


def are_near(found: np.ndarray, farthest: np.ndarray = NEAR) -> bool:
    """Whether nine parts of ten are as near as counts as equal: chaos may bring one elsewhere."""
    return bool(np.mean((found <= farthest).all(axis=1)) >= 0.9)
