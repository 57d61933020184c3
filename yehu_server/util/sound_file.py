"""Write sound files, whole when they appear or valid throughout; open those of others."""

import contextlib
import io
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, BinaryIO, ClassVar

import numpy as np
import soundfile

from yehu_server.errors import OutputError
from yehu_server.util import flac_stream, wav_stream
from yehu_server.util.files import error_reason, open_regular, replace_any, replacing
from yehu_server.util.flac_stream import FlacStream
from yehu_server.util.subtypes import FORMATS, SUBTYPES
from yehu_server.util.wav_stream import WavStream

MAX_CHANNELS = {
    "wav": wav_stream.MAX_CHANNELS,
    "flac": flac_stream.MAX_CHANNELS,
    "raw": wav_stream.MAX_CHANNELS,
}
RENDERED = "yehu-server render"  # software named in a rendered file, which may be replaced

Samples = np.ndarray[Any, np.dtype[np.float32]]


class SoundWriter:
    """Writes a sound file whose header is valid after each write.

    `file`: a new one, unbuffered; it stays open.
    `target`: its name in errors.
    `format_name` ("wav" or "flac").
    `subtype`: one of `SUBTYPES`.
    `software`: named in the file as its maker.
    `channels`: 1 to `MAX_CHANNELS` of the format.

    Raises OutputError, from all methods too; what was written before stays valid.
    """

    STREAMS: ClassVar[dict[str, Any]] = {"wav": WavStream, "flac": FlacStream}

    def __init__(
        self,
        file: io.FileIO,
        target: Path,
        rate: int,
        format_name: str,
        subtype: str,
        software: str = "",
        *,
        channels: int = 1,
    ) -> None:
        check_format(format_name, subtype, channels)
        self._target = target
        self._channels = channels
        self.frames = 0
        self.peak = 0.0
        self._power = 0.0
        with self._converting_errors():
            make = self.STREAMS[format_name]
            self._stream = make(file, rate, subtype, software, channels=channels)

    @property
    def written_frames(self) -> int:
        """Number of frames in the file; an encoder may hold back more."""
        return int(self._stream.frames)

    def write(self, samples: Samples) -> None:
        """Append samples [shape=(frames,) of one channel, or (frames, channels); full scale 1]."""
        self.frames += len(samples)
        if self.frames > self._stream.most_frames:
            instead = "; use FLAC" if self._channels <= flac_stream.MAX_CHANNELS else ""
            raise OutputError(f"{self._target}: too long for a WAV file (4 GiB){instead}")
        highest, lowest = samples.max(initial=0.0), samples.min(initial=0.0)
        self.peak = max(self.peak, float(highest), -float(lowest))
        self._power += float(np.square(samples, dtype=np.float64).sum())
        with self._converting_errors():
            self._stream.write(samples)

    def close(self) -> None:
        """Write what the encoder holds back."""
        with self._converting_errors():
            self._stream.close()

    @contextlib.contextmanager
    def _converting_errors(self) -> Iterator[None]:
        try:
            yield
        except BrokenPipeError:  # whoever reads has had enough
            raise
        except OSError as error:
            raise OutputError(f"{self._target}: cannot write: {error_reason(error)}") from error

    @property
    def rms(self) -> float:
        """Root mean square of all samples of all channels, of full scale."""
        samples = self.frames * self._channels
        return float((self._power / samples) ** 0.5) if samples else 0.0


def format_of(target: Path) -> str:
    """The format of a file by its ending, WAV without one; raises OutputError for another."""
    ending = target.suffix.lower().lstrip(".")
    if ending in ("", "wave"):
        return "wav"
    if ending not in FORMATS:
        raise OutputError(f"{target}: .{ending} is not a format to write; use .wav or .flac")
    return ending


def check_format(format_name: str, subtype: str, channels: int = 1) -> None:
    """Refuse (OutputError) a subtype or a number of channels that a format does not have."""
    if format_name not in SUBTYPES[subtype].files:
        raise OutputError(f"a {format_name} file cannot hold {subtype} samples; use 16 or 24")
    most = MAX_CHANNELS[format_name]
    if not 1 <= channels <= most:
        raise OutputError(f"a {format_name} file holds 1 to {most} channels, not {channels}")


@contextlib.contextmanager
def sound_file(
    target: Path,
    rate: int,
    format_name: str,
    subtype: str,
    may_replace: Callable[[Path], bool] = replace_any,
    *,
    channels: int = 1,
) -> Iterator[SoundWriter]:
    """Open a sound file that appears at `target` only once it is complete.

    Raises OutputError where it cannot be written, or not replaced.

    `format_name` ("wav" or "flac").
    `subtype`: one of `SUBTYPES`.
    `may_replace`: called with the target where a file is there; returns whether to replace it.
    `channels`: 1 to `MAX_CHANNELS` of the format.
    """
    with replacing(target, may_replace) as partial, io.FileIO(partial, "w") as file:
        form = (rate, format_name, subtype, RENDERED)
        writer = SoundWriter(file, target, *form, channels=channels)
        try:
            yield writer
        except BaseException:
            with contextlib.suppress(OutputError):
                writer.close()
            raise
        writer.close()
        if writer.frames == 0:
            raise OutputError(f"{target}: there is nothing to write")


class _Source:
    """A file for libsndfile, whose calls back may raise nothing: Python would print a traceback.

    A hostile header asks for places of 2^63; the first error of the system is kept in `error`.
    It has no name, by whose ending soundfile would take it for raw samples.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self.error: OSError | None = None

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        with contextlib.suppress(OSError, ValueError, OverflowError):  # no such place: it stays
            self._file.seek(offset, whence)
        return self.tell()

    def tell(self) -> int:
        return self._file.tell()

    def readinto(self, buffer: memoryview) -> int:
        try:
            return self._file.readinto(buffer)  # type: ignore[attr-defined, no-any-return]
        except OSError as error:
            self.error = self.error or error
            return 0


@contextlib.contextmanager
def opened_sound(path: Path) -> Iterator[soundfile.SoundFile]:
    """Open a sound file to read, whatever its name and its bytes.

    Raises OSError where it cannot be read, soundfile.LibsndfileError where it is no sound.
    """
    with open_regular(path) as data:
        source = _Source(data)
        with soundfile.SoundFile(source) as file:
            yield file
        if source.error is not None:
            raise source.error


def is_rendered(target: Path) -> bool:
    """Whether a file was made by `sound_file`, or is empty."""
    try:
        if target.stat().st_size == 0:
            return True
        with opened_sound(target) as file:
            return str(file.software).startswith(RENDERED)
    except (OSError, soundfile.LibsndfileError):
        return False
