"""Write sound to standard output, for another program to read as it comes.

The length is not known at the beginning, and a pipe cannot go back: the sizes in the header of a
WAV stream are the largest there are, by which other programs know that it ends where it ends. Raw
samples have no header; all channels of a frame follow each other, little endian.
"""

import contextlib
import io
import math
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from yehu_server.errors import OutputError
from yehu_server.util.files import write_all
from yehu_server.util.sound_file import RENDERED, SoundWriter
from yehu_server.util.wav_stream import WavStream, check_shape, encoded

UNKNOWN = struct.pack("<I", 0xFFFFFFFF)

Samples = np.ndarray[Any, np.dtype[np.float32]]


class _RawStream:
    """Writes samples one after another, and nothing else; as WavStream."""

    most_frames = math.inf

    def __init__(
        self, file: io.FileIO, _rate: int, subtype: str, _software: str, *, channels: int
    ) -> None:
        self.frames = 0
        self._file, self._subtype, self._channels = file, subtype, channels

    def write(self, samples: Samples) -> None:
        check_shape(samples, self._channels)
        write_all(self._file, encoded(samples, self._subtype))
        self.frames += len(samples)

    def close(self) -> None:
        """Do nothing: each write was complete."""


class _EndlessWavStream(_RawStream):
    """The same behind a header of unknown sizes."""

    def __init__(self, file: io.FileIO, *form: Any, channels: int) -> None:
        super().__init__(file, *form, channels=channels)
        known: Any = io.BytesIO()
        WavStream(known, *form, channels=channels)
        header = known.getvalue()
        write_all(file, header[:4] + UNKNOWN + header[8:-4] + UNKNOWN)


class _PipeWriter(SoundWriter):
    """Writes sound to a pipe; raises BrokenPipeError where nobody reads, else OutputError."""

    STREAMS: ClassVar = {"wav": _EndlessWavStream, "raw": _RawStream}


def check_pipe(format_name: str) -> None:
    """Raise OutputError where standard output is a terminal, or the format needs a file."""
    if format_name not in _PipeWriter.STREAMS:
        raise OutputError(f"a {format_name} file cannot be piped; use --format wav or raw")
    if sys.stdout is not None and sys.stdout.isatty():
        raise OutputError("standard output is a terminal; redirect it to a file or a program")


@contextlib.contextmanager
def sound_pipe(rate: int, format_name: str, subtype: str, channels: int) -> Iterator[SoundWriter]:
    """Open standard output for sound.

    Raises OutputError as `check_pipe` does, or where it is closed; BrokenPipeError in writing,
    where the reader has gone.
    """
    check_pipe(format_name)
    try:
        file = io.FileIO(1, "wb", closefd=False)
    except OSError as error:
        raise OutputError("standard output is closed") from error
    with file:
        form = (rate, format_name, subtype, RENDERED)
        yield _PipeWriter(file, Path("standard output"), *form, channels=channels)
