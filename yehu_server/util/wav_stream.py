"""Write WAV files whose header is valid after every write.

A crash at any moment leaves a file that any program opens. The format is Microsoft's of 1994:
samples that are not PCM have an extended ``fmt`` chunk and a ``fact`` chunk. More than two channels
need the format of 2001 (``WAVE_FORMAT_EXTENSIBLE``). There is no time stamp, so that the same
samples give the same bytes.
"""

import contextlib
import io
import struct
from typing import Any

import numpy as np

from yehu_server.util.files import write_all
from yehu_server.util.subtypes import SUBTYPES

MAX_CHANNELS = 64
PCM, IEEE_FLOAT, EXTENSIBLE = 1, 3, 0xFFFE
SUBFORMAT = bytes.fromhex("000000001000800000aa00389b71")  # of a format's number: the GUID's rest
NO_SPEAKERS = 0  # the channels belong to no particular speakers
WAV_LIMIT = 2**32 - 4096  # RIFF sizes have 32 bits

Samples = np.ndarray[Any, np.dtype[np.float32]]


class WavStream:
    """Writes a WAV file.

    `file`: a new one, unbuffered.
    `subtype`: one of `SUBTYPES`.
    `software`: named in the file as its maker; nothing by default.
    `channels`: 1 to `MAX_CHANNELS`.

    Raises OSError, from all methods too; what was written before stays valid.
    """

    def __init__(
        self, file: io.FileIO, rate: int, subtype: str, software: str = "", *, channels: int = 1
    ) -> None:
        self.frames = 0  # in the file
        self._file = file
        self._rate = rate
        self._subtype = subtype
        self._channels = channels
        self._frame_bytes = channels * SUBTYPES[subtype].size
        self.most_frames: float = WAV_LIMIT // self._frame_bytes
        self._about = _about(software)
        self._header_bytes = len(self._header())
        write_all(file, self._header())

    def write(self, samples: Samples) -> None:
        """Append samples [shape=(frames,) of one channel, or (frames, channels); full scale 1].

        Raises ValueError where they have another number of channels; nothing is written then.
        """
        check_shape(samples, self._channels)
        try:
            write_all(self._file, encoded(samples, self._subtype))
            self.frames += len(samples)
            self._update_header()
        except OSError:
            with contextlib.suppress(OSError):
                self._cut()
            raise

    def close(self) -> None:
        """End the stream; the file stays open."""
        if self.frames * self._frame_bytes % 2:
            write_all(self._file, b"\0")  # chunks have even lengths

    def _cut(self) -> None:
        """Remove an incomplete frame from the end."""
        each = self._frame_bytes
        self.frames = (self._file.seek(0, io.SEEK_END) - self._header_bytes) // each
        self._file.truncate(self._header_bytes + self.frames * each)
        self._update_header()

    def _update_header(self) -> None:
        self._file.seek(0)
        write_all(self._file, self._header())
        self._file.seek(0, io.SEEK_END)

    def _header(self) -> bytes:
        is_pcm = self._subtype != "float"
        size = self.frames * self._frame_bytes
        chunks = _chunk(b"fmt ", self._fmt(PCM if is_pcm else IEEE_FLOAT))
        if not is_pcm:
            chunks += _chunk(b"fact", struct.pack("<I", self.frames))
        chunks += self._about + b"data" + struct.pack("<I", size)
        return b"RIFF" + struct.pack("<I", 4 + len(chunks) + size + size % 2) + b"WAVE" + chunks

    def _fmt(self, form: int) -> bytes:
        """The chunk with the format of the samples, `form`: PCM or IEEE_FLOAT."""
        each, bits = self._frame_bytes, 8 * SUBTYPES[self._subtype].size
        tag = form if self._channels <= 2 else EXTENSIBLE
        fmt = struct.pack("<HHIIHH", tag, self._channels, self._rate, self._rate * each, each, bits)
        if tag == PCM:
            return fmt
        if tag == IEEE_FLOAT:
            return fmt + struct.pack("<H", 0)
        rest = struct.pack("<HIH", bits, NO_SPEAKERS, form) + SUBFORMAT
        return fmt + struct.pack("<H", len(rest)) + rest


def check_shape(samples: Samples, channels: int) -> None:
    """Check that samples are [shape=(frames, channels)], or (frames,) of one; raises ValueError."""
    if samples.shape[1:] != (channels,) and (samples.ndim, channels) != (1, 1):
        raise ValueError(f"samples of shape {samples.shape} for {channels} channels")


def encoded(samples: Samples, subtype: str) -> bytes:
    """Encode samples as bytes of a WAV file, frame by frame; beyond full scale they are clipped."""
    if subtype == "float":
        return samples.astype("<f4").tobytes()
    scaled = np.multiply(samples, 2.0**31, dtype=np.float64)
    np.rint(scaled, out=scaled)
    np.clip(scaled, -(2.0**31), 2.0**31 - 1.0, out=scaled)
    size = SUBTYPES[subtype].size
    highest = scaled.astype("<i4").reshape(-1, 1).view(np.uint8)[:, -size:]
    packed = np.empty(highest.shape, np.uint8)
    for place in range(size):  # four times as fast as copying all bytes in order
        packed[:, place] = highest[:, place]
    return packed.tobytes()


def _chunk(name: bytes, data: bytes) -> bytes:
    return name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def _about(software: str) -> bytes:
    if not software:
        return b""
    return _chunk(b"LIST", b"INFO" + _chunk(b"ISFT", software.encode("ascii") + b"\0"))
