"""Play a score, and write what the players were asked for as a capture instead of the sound."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from yehu_server.errors import OutputError
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.scores.capture_writer import LiveCapture
from yehu_server.scores.score import Score


def render_capture(
    played: Score | Sequence[Part],
    target: Path,
    options: Options,
    progress: Callable[[float, float], None] | None = None,
    *,
    overwrite: bool = False,
) -> Performance:
    """Play a score, and write its capture: replayed, it gives the same samples as a rendering.

    Returns the performance, which has been played. Raises YehuError where it fails; no partial file
    is left.
    """
    performance = Performance(played, replace(options, jobs=1, is_mono=False), reports=True)
    wrong: list[str] = []
    capture = LiveCapture(
        performance.ensemble,
        target,
        wrong.append,
        has_room=not options.is_dry,
        overwrite=overwrite,
    )
    total, frames = performance.score_frames / options.rate, 0
    try:
        for samples in performance.blocks():
            frames += len(samples)
            capture.keep_up()
            _check(wrong)
            if progress is not None:
                progress(frames / options.rate, total)
    except BaseException:
        capture.discard()
        raise
    capture.close()
    _check(wrong)
    return performance


def _check(wrong: list[str]) -> None:
    if wrong:
        raise OutputError(wrong[0])
