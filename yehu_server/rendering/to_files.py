"""Render a score, or the parts of an ensemble, to sound files: the mix, and its stems."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from yehu_server.audio.file import SoundWriter, check_format, sound_file
from yehu_server.audio.pipe import PIPE, sound_pipe
from yehu_server.files import anything
from yehu_server.rendering.asked import asked_pitch
from yehu_server.rendering.levelled import write_normalized
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance, Samples
from yehu_server.rendering.summary import Summary, summary_of
from yehu_server.rendering.watch import Watch
from yehu_server.score.score import Score


def render(
    played: Score | Sequence[Part],
    target: Path,
    options: Options,
    progress: Callable[[float, float], None] | None = None,
    may_replace: Callable[[Path], bool] = anything,
    stems: Sequence[Path] = (),
    watch: Watch | None = None,
) -> Summary:
    """Render a score on one instrument, or parts on one each, to a sound file.

    Parameters
    ----------
    progress : callable, optional
        Called with the seconds done and those of the score.
    may_replace : callable
        Returns whether an older file may be replaced.
    target : Path
        `PIPE` for standard output.
    stems : sequence of Path
        A file for each part, and one for the room unless it is dry; none: no stems. Their sum is
        the mix.
    watch : Watch, optional
        Gathers what a picture shows.

    Raises
    ------
    YehuError
        Where it fails; no partial file is left.
    """
    channels = options.sound_channels
    if target is not PIPE:
        check_format(options.format_name, options.subtype, channels)
    performance = Performance(played, options, has_stems=bool(stems))
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
        takes = _takes(performance, len(files), options.rate, progress, watch)
        if options.normalize:
            write_normalized(takes, files, None if target is PIPE else target.parent)
        else:
            for take in takes:
                for file, samples in zip(files, take, strict=True):
                    file.write(samples)
    return summary_of(performance, files[0], options.rate, time.perf_counter() - start)


def _takes(
    performance: Performance,
    files: int,
    rate: int,
    progress: Callable[[float, float], None] | None,
    watch: Watch | None,
) -> Iterator[list[Samples]]:
    """Yield what goes to each of the files, block by block."""
    frames, total = 0, performance.score_frames / rate
    for samples in performance.blocks():
        yield [samples, *performance.stems][:files]
        frames += len(samples)
        if watch is not None:
            asked = [asked_pitch(player.instruments[0]) for player in performance.players]
            watch.take(samples, asked)
        if progress is not None:
            progress(frames / rate, total)
