"""Taps to sound files, each channel scaled to its full scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from yehu_server.files import anything, make_folder, nothing, replacing
from yehu_server.workshop.tap import QUANTITIES, Tap

SUBTYPE = "PCM_24"


def write_taps(
    taps: Sequence[Tap], folder: Path, *, overwrite: bool = False
) -> tuple[list[Path], str]:
    """Write a WAV file for each tap.

    Returns
    -------
    files : list of Path
    channels : str
        What their channels are, as `measurement.read` takes it.

    Raises
    ------
    OutputError
        Where they cannot be written, or are there already.
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
