"""Write sound scaled to a peak, in two passes through temporary files."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from yehu_server.audio.file import SoundWriter
from yehu_server.errors import OutputError
from yehu_server.files import why
from yehu_server.rendering.performance import Samples

NORMALIZED_PEAK = 10.0 ** (-1.0 / 20.0)
CHUNK = 1 << 18  # bytes that are read again at a time: whole frames


def write_normalized(
    takes: Iterable[Sequence[Samples]], files: Sequence[SoundWriter], folder: Path | None
) -> None:
    """Write blocks, scaled so that the first file has a peak of NORMALIZED_PEAK.

    Parameters
    ----------
    takes : iterable
        Of each block, the samples for each of the files; all are scaled alike.
    folder : Path
        Where the temporary files are; None: where the system has its own.

    Raises
    ------
    OutputError
        Where the disk is full or cannot be written.
    """
    peak, shape = 0.0, (-1,)
    with contextlib.ExitStack() as stack:
        try:
            scratches = [stack.enter_context(tempfile.TemporaryFile(dir=folder)) for _ in files]
            for take in takes:
                peak = max(peak, float(np.abs(take[0]).max(initial=0.0)))
                shape = (-1, *take[0].shape[1:])
                for scratch, samples in zip(scratches, take, strict=True):
                    scratch.write(np.ascontiguousarray(samples).tobytes())
            for scratch in scratches:
                scratch.seek(0)
        except OSError as error:
            raise OutputError(
                f"{folder or tempfile.gettempdir()}: cannot write: {why(error)}"
            ) from error
        factor = np.float32(NORMALIZED_PEAK / peak if peak > 0.0 else 1.0)
        for scratch, file in zip(scratches, files, strict=True):
            while data := scratch.read(CHUNK):
                file.write(np.frombuffer(data, np.float32).reshape(shape) * factor)
