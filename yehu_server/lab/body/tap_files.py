"""Taps of a force hammer in sound files: read, and written."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from yehu_server.errors import MeasurementError
from yehu_server.lab.body.channels import Channel, by_quantity
from yehu_server.lab.body.tap import QUANTITIES, Tap, cut
from yehu_server.util.files import anything, make_folder, nothing, open_regular, replacing, why

LONGEST_S = 600.0
MOST_SAMPLES = 2**24  # of all channels, in a file: three minutes of two channels at 48 kHz
LOWEST_RATE, HIGHEST_RATE = 8000, 400_000
ENDINGS = (".wav", ".wave", ".flac", ".aif", ".aiff")


def read_recording(path: Path, channels: Sequence[Channel] | None) -> list[Tap]:
    """Read the taps of a sound file.

    `channels` tells what each is, and how many SI units full scale is. Raises MeasurementError
    where it cannot be read, holds other channels, or no tap.
    """
    import soundfile

    try:
        with open_regular(path) as data, soundfile.SoundFile(data) as file:
            rate = file.samplerate
            if not LOWEST_RATE <= rate <= HIGHEST_RATE or file.frames > LONGEST_S * rate:
                raise MeasurementError(f"{path}: not a recording of taps: {rate} Hz, or too long")
            count = file.channels
            if channels is None:
                raise MeasurementError(
                    f"{path}: say what its {count} channels are, such as "
                    "--channels force=100,velocity=0.5: their SI units at full scale"
                )
            if len(channels) != count:
                raise MeasurementError(f"{path}: has {count} channels, not {len(channels)} as told")
            if file.frames * count > MOST_SAMPLES:
                raise MeasurementError(
                    f"{path}: has {file.frames * count} samples, more than {MOST_SAMPLES}"
                )
            samples = file.read(dtype="float64", always_2d=True)
    except OSError as error:
        raise MeasurementError(f"{path}: {why(error)}") from error
    except soundfile.LibsndfileError as error:
        raise MeasurementError(f"{path}: not a sound file ({error.error_string})") from error
    return cut(float(rate), by_quantity(channels, samples), path.name)


SUBTYPE = "PCM_24"


def write_taps(
    taps: Sequence[Tap], folder: Path, *, overwrite: bool = False
) -> tuple[list[Path], str]:
    """Write a WAV file for each tap.

    Return the files, and what their channels are, as `measurement.read` takes it. Raises
    OutputError where they cannot be written, or are there already.
    """
    import soundfile

    names = [what for what in QUANTITIES if what == "force" or what in taps[0].responses]
    columns = [
        [tap.force if what == "force" else tap.responses[what] for what in names] for tap in taps
    ]
    # Full scale is the next power of two above the largest value: easy to write.
    largest = [max(float(np.abs(row[i]).max()) for row in columns) for i in range(len(names))]
    scales = [2.0 ** math.ceil(math.log2(1.05 * max(peak, 1e-12))) for peak in largest]
    make_folder(folder)
    files = [folder / f"tap{i + 1}.wav" for i in range(len(taps))]
    for file, row, tap in zip(files, columns, taps, strict=True):
        samples = np.stack([values / scale for values, scale in zip(row, scales, strict=True)], 1)
        may_replace = anything if overwrite else nothing
        with replacing(file, may_replace) as partial, partial.open("wb") as stream:
            soundfile.write(stream, samples, round(tap.rate), SUBTYPE, format="WAV")
    told = ",".join(f"{name}={scale:g}" for name, scale in zip(names, scales, strict=True))
    return files, told
