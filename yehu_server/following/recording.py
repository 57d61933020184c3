"""Read recordings to follow in blocks, as one channel at the sample rate of the analysis."""

import contextlib
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.errors import ScoreError
from yehu_server.scores.score import MAX_DURATION_H, check_duration
from yehu_server.util.files import error_reason
from yehu_server.util.hints import require_package

Array = Any

RATE = 16000  # Hz, of the analysis
LOWEST_RATE, HIGHEST_RATE = 8000, 768_000
MAX_CHANNELS = 64
SHORTEST_S = 0.05
BLOCK_S = 2.0
QUIETEST = 1e-4  # RMS of full scale, below which there is only silence
WORKING_PEAK = 0.5  # to which sounds are scaled: as the pitch tracker was trained
CLIPPED, CLIPPED_SHARE = 0.999, 1e-3  # of full scale; of all samples, for a warning
# Where the mean of the channels has less than this share of the loudest's power, that one is taken:
# the others are silent, or cancel each other.
MIN_SHARE = 0.3


@dataclass(frozen=True)
class Recording:
    """A sound that can be read more than once."""

    name: str  # for messages
    rate: int  # Hz
    # Returns an iterator over its blocks: ndarrays [shape=(frames, channels), float32].
    blocks: Callable[[], Iterator[Array]]


@dataclass(frozen=True)
class Downmix:
    """The weights that make one channel of a recording, and warnings about it."""

    weights: Array  # [shape=(channels,)] of the channels, with the scale to WORKING_PEAK
    offset: float  # subtracted then: the mean
    gain_db: float  # of the result, over the recording
    duration_s: float
    warnings: tuple[str, ...]


def recording_of_file(path: Path, max_duration_h: float = MAX_DURATION_H) -> Recording:
    """A sound file as a recording.

    Raises ScoreError, one line with the name: where it cannot be read, is no sound, or lasts too
    long.
    """
    with _opened(path) as file:
        rate, frames, channels = file.samplerate, file.frames, file.channels
    if channels > MAX_CHANNELS:
        raise ScoreError(f"{path}: has {channels} channels, more than {MAX_CHANNELS}")
    _check_rate(str(path), rate)
    check_duration(frames / rate, max_duration_h, f"{path}: the recording lasts")

    size = round(BLOCK_S * rate)

    def blocks() -> Iterator[Array]:
        with _opened(path) as file:
            # Not its own blocks(), which needs the length of a sound: some files have none.
            while len(block := file.read(size, dtype="float32", always_2d=True)):
                yield block

    return Recording(str(path), rate, blocks)


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """Open a sound file; raises ScoreError where it cannot be read."""
    import soundfile

    from yehu_server.util.sound_file import opened_sound

    try:
        with opened_sound(path) as file:
            yield file
    except OSError as error:
        raise ScoreError(f"{path}: {error_reason(error)}") from error
    except soundfile.LibsndfileError as error:
        raise ScoreError(f"{path}: not a sound file ({error.error_string})") from error


def recording_of_samples(samples: Array, rate: int, name: str = "the recording") -> Recording:
    """An array [shape=(frames,) or (frames, channels)] as a recording; raises ScoreError."""
    sound = np.asarray(samples)
    sound = sound[:, None] if sound.ndim == 1 else sound
    if sound.ndim != 2 or not 1 <= sound.shape[1] <= MAX_CHANNELS:
        raise ScoreError(f"{name}: expected frames, or frames by channels, not {sound.shape}")
    if not (np.issubdtype(sound.dtype, np.floating) or np.issubdtype(sound.dtype, np.integer)):
        raise ScoreError(f"{name}: expected numbers, not {sound.dtype}")
    scale = 1.0
    if np.issubdtype(sound.dtype, np.integer):
        scale = 1.0 / (np.iinfo(sound.dtype).max + 1.0)
    _check_rate(name, rate)
    size = round(BLOCK_S * rate)

    def blocks() -> Iterator[Array]:
        for start in range(0, len(sound), size):
            yield (sound[start : start + size] * scale).astype(np.float32)

    return Recording(name, rate, blocks)


def _check_rate(name: str, rate: int) -> None:
    if not LOWEST_RATE <= rate <= HIGHEST_RATE:
        raise ScoreError(f"{name}: {rate} Hz is not within {LOWEST_RATE} to {HIGHEST_RATE} Hz")


def downmix_of(recording: Recording) -> Downmix:
    """Read a recording once, to decide how one channel is made of it.

    Raises ScoreError where it cannot be followed: too short, silent, or with samples that are no
    numbers.
    """
    frames, clipped = 0, 0
    total: Array = 0.0
    powers: Array = 0.0
    peaks: Array = 0.0
    mean_power = mean_peak = 0.0
    for block in recording.blocks():
        if not np.isfinite(block).all():
            raise ScoreError(f"{recording.name}: has samples that are not finite numbers")
        mean = block.mean(axis=1)
        frames += len(block)
        total = total + block.sum(axis=0, dtype=np.float64)
        powers = powers + np.square(block, dtype=np.float64).sum(axis=0)
        peaks = np.maximum(peaks, np.abs(block).max(axis=0, initial=0.0))
        mean_power += float(np.square(mean, dtype=np.float64).sum())
        mean_peak = max(mean_peak, float(np.abs(mean).max(initial=0.0)))
        clipped += int((np.abs(block) >= CLIPPED).any(axis=1).sum())
    duration_s = frames / recording.rate
    if duration_s < SHORTEST_S:
        raise ScoreError(f"{recording.name}: too short to be followed ({1e3 * duration_s:.0f} ms)")
    offsets = total / frames
    powers = powers - frames * offsets**2
    mean_power -= frames * float(offsets.mean()) ** 2
    loudest = int(np.argmax(powers))
    weights = np.full(len(powers), 1.0 / len(powers))
    peak = mean_peak
    warnings = []
    if mean_power < MIN_SHARE * powers[loudest]:
        weights = np.eye(len(powers))[loudest]
        peak = float(peaks[loudest])
        warnings.append(f"channel {loudest + 1} of {len(powers)} alone is followed")
    power = max(mean_power, float(weights @ powers)) / frames
    if math.sqrt(max(power, 0.0)) < QUIETEST:
        raise ScoreError(f"{recording.name}: is silent")
    if clipped > CLIPPED_SHARE * frames:
        share = 100.0 * clipped / frames
        warnings.append(f"clipped: {share:.1f} % of it is at full scale, and its loudness unsure")
    scale = WORKING_PEAK / peak
    gain_db = 20.0 * math.log10(scale)
    offset = float(weights @ offsets) * scale
    return Downmix(weights * scale, offset, gain_db, duration_s, tuple(warnings))


def mono_blocks(recording: Recording, downmix: Downmix) -> Iterator[Array]:
    """Yield a recording as one channel at RATE: ndarrays [shape=(frames,), float32]."""
    import soxr

    resampler = soxr.ResampleStream(recording.rate, RATE, 1, dtype="float32")
    weights = downmix.weights.astype(np.float32)
    for block in recording.blocks():
        yield resampler.resample_chunk(block @ weights - np.float32(downmix.offset))
    yield resampler.resample_chunk(np.zeros(0, np.float32), last=True)


def need_follow(what: str = "to follow a recording") -> None:
    """Check that the libraries of the extra are there; raises ParameterError."""
    require_package("swift_f0", what, "follow")
    require_package("soxr", what, "follow")
