"""Folders of sounds that are compared: read, cut and brought to one loudness."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import soundfile
from measures.bs1770 import lufs, true_peak_db

LOUDNESS_LUFS, PEAK_DB = -23.0, -1.0  # EBU R 128
LEAST_S = 1.0
ENDINGS = {".wav", ".flac", ".ogg", ".mp3", ".aif", ".aiff"}

Array = Any


class UnfitSoundsError(Exception):
    """Sounds that cannot be compared."""


class Group(NamedTuple):
    """Sounds of one kind: an instrument, or a state of one."""

    name: str
    folder: Path

    def files(self) -> list[Path]:
        """Its sounds, by name."""
        found = [each for each in self.folder.iterdir() if each.suffix.lower() in ENDINGS]
        if not found:
            raise UnfitSoundsError(f"{self.folder} has no sounds ({', '.join(sorted(ENDINGS))})")
        return sorted(found)


def read(file: Path, seconds: float | None = None) -> tuple[Array, int]:
    """The samples [shape=(frames, channels)] and the rate (Hz), without silence at the beginning.

    `seconds`: where to cut it, with a fade of 50 ms.
    """
    try:
        sound, rate = soundfile.read(file, always_2d=True)
    except soundfile.LibsndfileError as error:
        raise UnfitSoundsError(f"{file}: {error.error_string}") from None
    level = np.abs(sound).max(axis=1)
    if len(sound) < LEAST_S * rate or not np.isfinite(level).all() or not level.any():
        raise UnfitSoundsError(f"{file} has no second of sound")
    sound = sound[int(np.argmax(level > 1e-3 * level.max())) :]
    if seconds is not None and len(sound) > seconds * rate:
        sound = sound[: round(seconds * rate)]
        fade = np.linspace(1.0, 0.0, round(0.05 * rate))
        sound[-len(fade) :] *= fade[:, None]
    return sound, rate


def matched(sounds: list[tuple[Array, int]]) -> list[Array]:
    """Sounds at one loudness: the standard one, or as loud as the peaks of all allow."""
    gains = np.array([LOUDNESS_LUFS - lufs(sound, rate) for sound, rate in sounds])
    if not np.isfinite(gains).all():
        raise UnfitSoundsError("a sound is too quiet or too short for its loudness to be measured")
    peaks = np.array([true_peak_db(sound) for sound, _ in sounds]) + gains
    gains -= max(0.0, peaks.max() - PEAK_DB)
    return [sound * 10.0 ** (gain / 20.0) for gain, (sound, _) in zip(gains, sounds, strict=True)]
