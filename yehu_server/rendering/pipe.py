"""Write sound to standard output, for another program to read as it comes.

The length is not known at the beginning, and a pipe cannot go back: the sizes in the header of a
WAV stream are the largest there are, by which other programs know that it ends where it ends. Raw
samples have no header; all channels of a frame follow each other, little endian.
"""

import contextlib
import io
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.errors import OutputError
from yehu_server.util.files import write_all
from yehu_server.util.sound_file import RENDERED, SoundWriter, check_format
from yehu_server.util.wav_stream import WavStream, check_shape, encoded

FORMATS = ("wav", "raw")
UNKNOWN = struct.pack("<I", 0xFFFFFFFF)

Samples = np.ndarray[Any, np.dtype[np.float32]]


def _wav_header(rate: int, subtype: str, channels: int) -> bytes:
    file: Any = io.BytesIO()
    WavStream(file, rate, subtype, RENDERED, channels=channels)
    known = file.getvalue()
    return bytes(known[:4] + UNKNOWN + known[8:-4] + UNKNOWN)


class _Stream:
    """Writes a header, and samples one after another."""

    def __init__(self, file: io.FileIO, header: bytes, subtype: str, channels: int) -> None:
        self.frames = 0
        self._file, self._subtype, self._channels = file, subtype, channels
        write_all(file, header)

    def write(self, samples: Samples) -> None:
        check_shape(samples, self._channels)
        write_all(self._file, encoded(samples, self._subtype))
        self.frames += len(samples)


class PipeWriter(SoundWriter):
    """Writes sound to a pipe; raises BrokenPipeError where nobody reads, else OutputError."""

    def __init__(  # the file's own has a limit, and a header that it writes again
        self, file: io.FileIO, rate: int, format_name: str, subtype: str, channels: int
    ) -> None:  # pylint: disable=super-init-not-called
        header = b""
        if format_name == "wav":
            check_format(format_name, subtype, channels)
            header = _wav_header(rate, subtype, channels)
        self._target = Path("standard output")
        self._channels, self._limit = channels, None
        self.frames, self.peak, self._power = 0, 0.0, 0.0
        with self._converting_errors():
            self._stream = _Stream(file, header, subtype, channels)  # type: ignore[assignment]

    def close(self) -> None:
        """Do nothing: each write was complete."""

    @contextlib.contextmanager
    def _converting_errors(self) -> Iterator[None]:
        try:
            with super()._converting_errors():
                yield
        except OutputError as error:
            if isinstance(error.__cause__, BrokenPipeError):
                raise error.__cause__ from None
            raise


def check_pipe(format_name: str) -> None:
    """Raise OutputError where standard output is a terminal, or the format needs a file."""
    if format_name not in FORMATS:
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
        yield PipeWriter(file, rate, format_name, subtype, channels)
