"""Voices made by rule, of which pitch and level are known at each sample."""

import numpy as np


def voice(pitches, rate, *, level=0.2, partials=8):
    """A sound with harmonics, at a pitch (fractional MIDI note) for each sample; NaN is silence."""
    hz = 440.0 * 2.0 ** ((np.nan_to_num(pitches, nan=69.0) - 69.0) / 12.0)
    phase = 2.0 * np.pi * np.cumsum(hz) / rate
    sound = np.zeros(len(hz))
    for n in range(1, partials + 1):
        sound += np.where(n * hz < 0.45 * rate, np.sin(n * phase) / n, 0.0)
    smooth = np.hanning(max(round(0.02 * rate), 3))
    heard = np.convolve(np.isfinite(pitches).astype(float), smooth / smooth.sum(), "same")
    return level * heard * sound


def tune(notes, rate):
    """Pitches of notes, rows of pitch (NaN for a rest) and seconds: ndarray [shape=(samples,)]."""
    return np.concatenate([np.full(round(seconds * rate), pitch) for pitch, seconds in notes])


def vibrato(pitches, rate, *, cents, hz=5.5):
    """The same pitches, swinging so far to either side."""
    time = np.arange(len(pitches)) / rate
    return pitches + cents / 100.0 * np.sin(2.0 * np.pi * hz * time)
