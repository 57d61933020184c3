"""A phrase, and how loud it is to be: between -23 and -18 LUFS, with peaks of -1 dB at most."""

import numpy as np
from measures.bs1770 import lufs, true_peak_db

import yehu_server as yehu

# At 120 quarters a minute: of plucked notes, shorter ones are louder together.
NAMES = ["G4", "A4", "B4", "D5", "E5", "D5", "B4", "A4", "G4", "C5", "E5", "G5"]
LENGTHS = [0.5, 0.25, 0.25, 0.5, 0.25, 0.25, 0.5, 0.25, 0.25, 0.5, 0.25, 1.0]
BEGINS = np.cumsum([0.0, *LENGTHS])
VELOCITY = 80


def phrase() -> list[yehu.Note]:
    """The notes of the phrase."""
    notes = zip(NAMES, BEGINS, LENGTHS, strict=False)
    return [yehu.Note(name, at, length, velocity=VELOCITY) for name, at, length in notes]


def check(sound: np.ndarray, rate: float) -> float:
    """Check the loudness of a sound [shape=(frames, channels)]; return it (LUFS)."""
    loudness = lufs(sound, rate)
    assert -23.0 < loudness < -18.0
    assert true_peak_db(sound) <= -1.0
    return loudness
