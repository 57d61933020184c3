"""Write FLAC files whose header is valid after every write, for all whole blocks.

libFLAC encodes, but writes the number of samples into the header only at the end. Here it is
rewritten after every block of 4096 samples, so that a crash loses less than a tenth of a second.
"""

import contextlib
import io
import math
from typing import Any

import numpy as np
import soundfile

from yehu_server.util.files import write_all
from yehu_server.util.subtypes import SUBTYPES
from yehu_server.util.wav_stream import check_shape

MAX_CHANNELS = 8
SYNC = b"\xff\xf8"  # first bytes of a block of fixed size
HEADER_BYTES = 42  # of the file up to the end of STREAMINFO
BLOCK_FRAMES = slice(10, 12)  # largest number of frames of a block
TOTAL = slice(18, 26)  # number of frames, in the lowest 36 bits
TOTAL_BITS = 36

Samples = np.ndarray[Any, np.dtype[np.float32]]


class FlacStream:
    """Writes FLAC of 1 to `MAX_CHANNELS` (more than two are around the listener); as WavStream."""

    most_frames = math.inf

    def __init__(
        self, file: io.FileIO, rate: int, subtype: str, software: str = "", *, channels: int = 1
    ) -> None:
        self.frames = 0  # in the file
        self._encoded = 0
        self._output = _CountingFile(file)
        self._encoder = soundfile.SoundFile(
            self._output,
            "w",
            samplerate=rate,
            channels=channels,
            format="FLAC",
            subtype=SUBTYPES[subtype].name,
        )
        if software:
            self._encoder.software = software

    def write(self, samples: Samples) -> None:
        """Append samples; see `wav_stream.WavStream.write`."""
        check_shape(samples, self._encoder.channels)
        # soundfile asserts that all frames were written, which fails on a full disk.
        with contextlib.suppress(AssertionError, soundfile.LibsndfileError):
            self._encoder.write(samples)
        self._encoded += len(samples)
        self._update_header()

    def close(self) -> None:
        """End the stream; the file stays open."""
        with contextlib.suppress(soundfile.LibsndfileError):
            self._encoder.close()
        self._update_header()

    def _update_header(self) -> None:
        self.frames = min(self._encoded, self._output.frames)
        if self._output.error is not None:
            with contextlib.suppress(OSError):
                self._output.cut()
                self._output.write_total(self.frames)
            raise self._output.error
        if not self._encoder.closed:  # at its end it has written the number itself
            self._output.write_total(self.frames)


class _CountingFile(io.RawIOBase):
    """The file for libsndfile, which counts blocks and keeps the first error."""

    def __init__(self, file: io.FileIO) -> None:
        self.error: OSError | None = None
        self._file = file
        self._header = bytearray()
        self._blocks = 0
        self._whole = 0  # bytes up to the end of the last whole block

    @property
    def frames(self) -> int:
        """Number of frames in the file's blocks, as if the last one were as long as the others."""
        return self._blocks * int.from_bytes(self._header[BLOCK_FRAMES], "big")

    def write(self, data: Any) -> int:
        """Write all, or nothing after an error; never raises, since C calls it."""
        data = bytes(data)
        if self.error is not None:
            return 0
        try:
            begin = self._file.tell()
            write_all(self._file, data)
            if begin < HEADER_BYTES:
                self._header[begin : begin + len(data)] = data
            if begin >= self._whole:
                self._whole = begin + len(data)
                self._blocks += data.startswith(SYNC)
        except OSError as error:
            self.error = error
            return 0
        return len(data)

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """See `io.IOBase`."""
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """See `io.IOBase`."""
        return self._file.tell()

    def cut(self) -> None:
        """Remove an incomplete block from the end."""
        self._file.truncate(self._whole)

    def write_total(self, frames: int) -> None:
        """Write the number of frames into the header."""
        if len(self._header) < HEADER_BYTES:
            return  # there is no header yet
        word = int.from_bytes(self._header[TOTAL], "big") >> TOTAL_BITS << TOTAL_BITS
        self._header[TOTAL] = (word | frames).to_bytes(8, "big")
        self._file.seek(TOTAL.start)
        write_all(self._file, bytes(self._header[TOTAL]))
        self._file.seek(0, io.SEEK_END)
