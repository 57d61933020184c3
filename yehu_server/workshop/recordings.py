"""Taps from sound files: one channel is the hammer's force, the others are responses."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from yehu_server.errors import MeasurementError
from yehu_server.files import why
from yehu_server.workshop.channels import SKIPPED, Channel
from yehu_server.workshop.tap import Tap, cut

LONGEST_S = 600.0
LOWEST_RATE, HIGHEST_RATE = 8000, 400_000
ENDINGS = (".wav", ".wave", ".flac", ".aif", ".aiff")


def read_recording(path: Path, channels: Sequence[Channel] | None) -> list[Tap]:
    """Read the taps of a sound file.

    Parameters
    ----------
    channels : sequence of Channel
        What each channel is, and how many SI units full scale is.

    Raises
    ------
    MeasurementError
        Where it cannot be read, holds other channels, or no tap.
    """
    import soundfile

    try:
        with path.open("rb") as data, soundfile.SoundFile(data) as file:
            rate = file.samplerate
            if not LOWEST_RATE <= rate <= HIGHEST_RATE or file.frames > LONGEST_S * rate:
                raise MeasurementError(f"{path}: not a recording of taps: {rate} Hz, or too long")
            samples = file.read(dtype="float64", always_2d=True)
    except OSError as error:
        raise MeasurementError(f"{path}: {why(error)}") from error
    except soundfile.LibsndfileError as error:
        raise MeasurementError(f"{path}: not a sound file ({error.error_string})") from error
    count = samples.shape[1]
    if channels is None:
        raise MeasurementError(
            f"{path}: say what its {count} channels are, such as "
            "--channels force=100,velocity=0.5: their SI units at full scale"
        )
    if len(channels) != count:
        raise MeasurementError(f"{path}: has {count} channels, not {len(channels)} as told")
    named = {
        channel.quantity: np.ascontiguousarray(samples[:, i]) * channel.scale
        for i, channel in enumerate(channels)
        if channel.quantity != SKIPPED
    }
    return cut(float(rate), named, path.name)
