"""FLAC, written so that the header is right after every write, as far as blocks are whole.

libFLAC encodes; its stream header tells how many samples there are only once it is closed. We
tell it all along: a block is 4096 samples, so a kill costs less than a tenth of a second.
"""

from __future__ import annotations

import contextlib
import io
from typing import Any

import numpy as np
import soundfile

from yehu_server.files import write_all

SUBTYPES = {"16": "PCM_16", "24": "PCM_24"}
SYNC = b"\xff\xf8"  # what a block of a fixed size begins with
HEADER_BYTES = 42  # of the file, as far as the stream's own header goes
BLOCK_FRAMES = slice(10, 12)  # the most frames of a block
TOTAL = slice(18, 26)  # how many frames there are, in the lowest 36 bits
TOTAL_BITS = 36

Samples = np.ndarray[Any, np.dtype[np.float32]]


class FlacStream:
    """A mono FLAC file being written; see `wav.WavStream`."""

    def __init__(self, file: io.FileIO, rate: int, subtype: str, software: str = "") -> None:
        self.frames = 0  # in the file for sure
        self._given = 0
        self._spy = _Spy(file)
        self._encoder = soundfile.SoundFile(
            self._spy,
            "w",
            samplerate=rate,
            channels=1,
            format="FLAC",
            subtype=SUBTYPES[subtype],
        )
        if software:
            self._encoder.software = software

    def write(self, samples: Samples) -> None:
        """Append samples [shape=(frames,), full scale]."""
        # soundfile asserts that all frames were written: they are not where the disk is full.
        with contextlib.suppress(AssertionError, soundfile.LibsndfileError):
            self._encoder.write(samples)
        self._given += len(samples)
        self._tell()

    def close(self) -> None:
        """End the stream; the file stays open."""
        with contextlib.suppress(soundfile.LibsndfileError):
            self._encoder.close()
        self._tell()

    def _tell(self) -> None:
        self.frames = min(self._given, self._spy.frames)
        if self._spy.error is not None:
            with contextlib.suppress(OSError):
                self._spy.cut()
                self._spy.tell_total(self.frames)
            raise self._spy.error
        if not self._encoder.closed:  # or it has told it itself
            self._spy.tell_total(self.frames)


class _Spy(io.RawIOBase):
    """The file as libsndfile sees it: counts the blocks, and keeps the first error."""

    def __init__(self, file: io.FileIO) -> None:
        self.error: OSError | None = None
        self._file = file
        self._header = bytearray()
        self._blocks = 0
        self._whole = 0  # bytes, up to the last whole block

    @property
    def frames(self) -> int:
        """As many as are in the blocks of the file, were the last as long as the others."""
        return self._blocks * int.from_bytes(self._header[BLOCK_FRAMES], "big")

    def write(self, data: Any) -> int:
        """Write all, or nothing more after an error; never raises, as C calls us."""
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
        """Move, as of a file."""
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        """Tell the place, as of a file."""
        return self._file.tell()

    def cut(self) -> None:
        """Take back what is no whole block."""
        self._file.truncate(self._whole)

    def tell_total(self, frames: int) -> None:
        """Write how many frames there are into the stream's header, and come back."""
        if len(self._header) < HEADER_BYTES:
            return  # nothing is written yet
        word = int.from_bytes(self._header[TOTAL], "big") >> TOTAL_BITS << TOTAL_BITS
        self._header[TOTAL] = (word | frames).to_bytes(8, "big")
        self._file.seek(TOTAL.start)
        write_all(self._file, bytes(self._header[TOTAL]))
        self._file.seek(0, io.SEEK_END)
