"""Render parts: to sound files and stems, scaled to a true peak or a loudness; or to a capture."""

import contextlib
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.errors import OutputError, ScoreError
from yehu_server.rendering import PIPE
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance, ProgressCallback, Samples
from yehu_server.rendering.pipe import sound_pipe
from yehu_server.rendering.plot_data import PlotData
from yehu_server.rendering.summary import Summary, summary_of
from yehu_server.scores.capture_writer import LiveCapture
from yehu_server.util.files import error_reason, replace_any
from yehu_server.util.loudness import IntegratedLoudness
from yehu_server.util.sound_file import SoundWriter, sound_file

Array = Any

# The standard's interpolating filter: three values between each two samples.
_QUARTER = (
    0.0017089843750, 0.0109863281250, -0.0196533203125, 0.0332031250000, -0.0594482421875,
    0.1373291015625, 0.9721679687500, -0.1022949218750, 0.0476074218750, -0.0266113281250,
    0.0148925781250, -0.0083007812500,
)  # fmt: skip
_HALF = (
    -0.0291748046875, 0.0292968750000, -0.0517578125000, 0.0891113281250, -0.1665039062500,
    0.4650878906250, 0.7797851562500, -0.2003173828125, 0.1015625000000, -0.0582275390625,
    0.0330810546875, -0.0189208984375,
)  # fmt: skip
PHASES = (_QUARTER, _HALF, _HALF[::-1], _QUARTER[::-1])
TAPS = len(_QUARTER)
WORST_GAIN = max(sum(map(abs, phase)) for phase in PHASES)


class TruePeak:
    """Finds the largest true peak of a recording that comes in blocks. Source: [BS1770], annex 2.

    It is that of the samples and of three values between each two. Of a block that cannot come up
    to the largest so far, they are not computed.
    """

    def __init__(self) -> None:
        self.peak = 0.0
        self._before: Array = None

    def add(self, block: Array) -> None:
        """Take up the next block [shape=(frames,) or (frames, channels)]."""
        x = np.asarray(block, np.float64).reshape(len(block), -1)
        if self._before is None:
            self._before = np.zeros((TAPS - 1, x.shape[1]))
        x = np.concatenate((self._before, x))
        self._before = x[len(x) - TAPS + 1 :]
        for channel in x.T:
            self._hear(channel)

    def finish(self) -> float:
        """Return the peak, once all is taken up."""
        if self._before is not None:
            self.add(np.zeros((TAPS, self._before.shape[1])))
        return self.peak

    def _hear(self, x: Array) -> None:
        highest = float(np.abs(x).max(initial=0.0))
        self.peak = max(self.peak, highest)
        if len(x) >= TAPS and highest * WORST_GAIN > self.peak:
            for phase in PHASES:
                between = np.convolve(x, phase, "valid")
                self.peak = max(self.peak, float(np.abs(between).max()))


CHUNK = 1 << 18  # bytes that are read again at a time: whole frames


def stem_files(folder: Path, parts: Sequence[Part], ending: str, *, is_dry: bool) -> list[Path]:
    """The files of stems: one for each part, numbered, and one for the room."""
    names = [f"{number:02}-{_plain(part.name)}" for number, part in enumerate(parts, start=1)]
    return [folder / f"{name}.{ending}" for name in (*names, *(() if is_dry else ("room",)))]


def _plain(name: str) -> str:
    """A name as part of a file's name: letters, digits, dots and hyphens."""
    plain = "".join(each if each.isalnum() or each in "._-" else "-" for each in name)
    return plain[:60].strip("-.") or "part"


def write_scaled(
    takes: Iterable[Sequence[Samples]],
    files: Sequence[SoundWriter],
    folder: Path | None,
    factor_of: Callable[[float], float],
) -> float:
    """Write blocks, scaled by what `factor_of` returns for the true peak of the loudest file.

    `takes` has of each block the samples for each of the files; all are scaled alike, by what is
    returned. Temporary files are in `folder`; None: where the system has its own. Raises
    OutputError where the disk is full or cannot be written.
    """
    meters: list[TruePeak] = [TruePeak() for _ in files]
    shape: tuple[int, ...] = (-1,)
    with contextlib.ExitStack() as stack:
        try:
            scratches = [stack.enter_context(tempfile.TemporaryFile(dir=folder)) for _ in files]
            for take in takes:
                shape = (-1, *take[0].shape[1:])
                for meter, scratch, samples in zip(meters, scratches, take, strict=True):
                    meter.add(samples)
                    scratch.write(np.ascontiguousarray(samples).tobytes())
            for scratch in scratches:
                scratch.seek(0)
        except OSError as error:
            raise OutputError(
                f"{folder or tempfile.gettempdir()}: cannot write: {error_reason(error)}"
            ) from error
        peak = max(meter.finish() for meter in meters)
        factor = np.float32(factor_of(peak))
        for scratch, file in zip(scratches, files, strict=True):
            while data := scratch.read(CHUNK):
                file.write(np.frombuffer(data, np.float32).reshape(shape) * factor)
        return float(factor)


def render(
    parts: Sequence[Part],
    target: Path,
    options: Options,
    progress: ProgressCallback | None = None,
    may_replace: Callable[[Path], bool] = replace_any,
    stems: Sequence[Path] = (),
    watch: PlotData | None = None,
) -> Summary:
    """Render parts, each on an instrument of its own, to a sound file.

    `progress` is called with the seconds done and those of the score; `may_replace` says whether
    an older file may be replaced. The target is `PIPE` for standard output. Stems are a file for
    each part, and one for the room unless it is dry; their sum is the mix. `watch` gathers what a
    picture shows. Raises YehuError where it fails; no partial file is left.
    """
    channels = options.sound_channels
    performance = Performance(parts, options, has_stems=bool(stems))
    start = time.perf_counter()
    form = (options.rate, options.format_name, options.subtype)

    def opened(path: Path) -> contextlib.AbstractContextManager[SoundWriter]:
        if path is PIPE:
            return sound_pipe(*form, channels)
        wav_or_flac = "wav" if options.format_name == "raw" else options.format_name
        return sound_file(
            path, form[0], wav_or_flac, options.subtype, may_replace, channels=channels
        )

    with contextlib.ExitStack() as stack:
        files = [stack.enter_context(opened(path)) for path in (target, *stems)]
        loudness = IntegratedLoudness(options.rate)
        takes = _takes(performance, len(files), progress, watch, loudness)
        factor = 1.0
        if options.is_scaled:
            folder = None if target is PIPE else target.parent
            factor = write_scaled(
                takes, files, folder, lambda peak: options.factor(peak, loudness.lufs())
            )
        else:
            for take in takes:
                for file, samples in zip(files, take, strict=True):
                    file.write(samples)
        is_silent = not any(one.player.notes_played for one in performance.players)
        if is_silent and any(part.score.notes for part in parts):
            raise ScoreError(f"{parts[0].score.name}: none of its notes is played")
    elapsed_s, file = time.perf_counter() - start, files[0]
    ends = options.subtype != "float"
    clipped = [path.name for path, one in zip(stems, files[1:], strict=True) if one.peak > 1.0]
    return summary_of(
        performance,
        file.frames / options.rate,
        elapsed_s,
        file.peak,
        file.rms,
        loudness.lufs(factor),
        asked_lufs=options.loudness_lufs,
        factor=factor,
        clipped=clipped if ends else (),
    )


def _takes(
    performance: Performance,
    files: int,
    progress: ProgressCallback | None,
    watch: PlotData | None,
    loudness: IntegratedLoudness,
) -> Iterator[list[Samples]]:
    """Yield what goes to each of the files, block by block."""
    for samples in performance.blocks(progress):
        loudness.add(samples)
        yield [samples, *performance.stems][:files]
        if watch is not None:
            watch.take(samples, performance.target_pitches)


def render_capture(
    parts: Sequence[Part],
    target: Path,
    options: Options,
    progress: ProgressCallback | None = None,
    *,
    overwrite: bool = False,
) -> Performance:
    """Play parts, and write their capture: replayed, it gives the same samples as a rendering.

    Returns the performance, which has been played. Raises YehuError where it fails; no partial file
    is left.
    """
    performance = Performance(parts, replace(options, jobs=1, is_mono=False), reports=True)
    said: list[str] = []
    capture = LiveCapture(
        performance.ensemble, target, said.append, has_room=not options.is_dry, overwrite=overwrite
    )
    try:
        for _ in performance.blocks(progress):
            capture.keep_up()
            _check(capture, said)
    except BaseException:
        capture.discard()
        raise
    capture.close()
    _check(capture, said)
    return performance


def _check(capture: LiveCapture, said: list[str]) -> None:
    if not capture.is_whole:
        raise OutputError(said[-1])
