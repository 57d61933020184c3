"""Sound files, written as they come, whole or not at all."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import soundfile

from yehu_server.errors import OutputError
from yehu_server.files import replacing

FORMATS = ("wav", "flac")
SUBTYPES = {"16": "PCM_16", "24": "PCM_24", "float": "FLOAT"}
BYTES = {"16": 2, "24": 3, "float": 4}
WAV_LIMIT = 2**32 - 4096  # RIFF sizes have 32 bits

Samples = np.ndarray[Any, np.dtype[np.float32]]


class SoundWriter:
    """A sound file being written; see `sound_file`."""

    def __init__(self, file: soundfile.SoundFile, target: Path, limit: int | None) -> None:
        self._file = file
        self._target = target
        self._limit = limit
        self.frames = 0
        self.peak = 0.0
        self._power = 0.0

    def write(self, samples: Samples) -> None:
        """Append samples [shape=(frames,), full scale]. Errors: OutputError."""
        self.frames += len(samples)
        if self._limit is not None and self.frames > self._limit:
            raise OutputError(f"{self._target}: too long for a WAV file (4 GiB); use FLAC")
        self.peak = max(self.peak, float(np.abs(samples).max(initial=0.0)))
        self._power += float(np.square(samples, dtype=np.float64).sum())
        try:
            self._file.write(samples)
        # soundfile asserts that all frames were written: they are not on a full disk.
        except (AssertionError, soundfile.LibsndfileError) as error:
            raise OutputError(f"{self._target}: cannot write: is the disk full?") from error

    @property
    def rms(self) -> float:
        """Root mean square of what was written, of full scale."""
        return float((self._power / self.frames) ** 0.5) if self.frames else 0.0


def format_of(target: Path) -> str:
    """The format that a file's ending names; WAV without one. Errors: OutputError."""
    ending = target.suffix.lower().lstrip(".")
    if ending in ("", "wave"):
        return "wav"
    if ending not in FORMATS:
        raise OutputError(f"{target}: .{ending} is not a format to write; use .wav or .flac")
    return ending


def check_format(format_name: str, subtype: str) -> None:
    """Refuse what a format cannot hold. Errors: OutputError."""
    if not soundfile.check_format(format_name.upper(), SUBTYPES[subtype]):
        raise OutputError(f"a {format_name} file cannot hold {subtype} samples; use 16 or 24")


@contextlib.contextmanager
def sound_file(target: Path, rate: int, format_name: str, subtype: str) -> Iterator[SoundWriter]:
    """Open a mono sound file that appears at `target` only once it is complete.

    Parameters
    ----------
    format_name : "wav" or "flac"
    subtype : "16", "24" or "float"

    Errors: OutputError.
    """
    check_format(format_name, subtype)
    limit = WAV_LIMIT // BYTES[subtype] if format_name == "wav" else None
    with replacing(target) as partial:
        try:
            file = soundfile.SoundFile(
                partial,
                "w",
                samplerate=rate,
                channels=1,
                format=format_name.upper(),
                subtype=SUBTYPES[subtype],
            )
        except soundfile.LibsndfileError as error:
            raise OutputError(f"{target}: cannot write: {error}") from error
        with file:
            writer = SoundWriter(file, target, limit)
            yield writer
            if writer.frames == 0:
                raise OutputError(f"{target}: there is nothing to write")
        # What libsndfile still buffered is written on closing, where it cannot complain.
        try:
            whole = soundfile.info(partial).frames == writer.frames
        except soundfile.LibsndfileError:
            whole = False
        if not whole:
            raise OutputError(f"{target}: cannot write: is the disk full?")
