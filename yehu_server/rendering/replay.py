"""Render a captured session to a sound file: the same samples as when it was played."""

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from heapq import merge
from itertools import groupby, pairwise
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.stage.room_geometry import EARS
from yehu_server.scores.capture import Capture
from yehu_server.scores.score import check_duration
from yehu_server.util.files import replace_any
from yehu_server.util.sound_file import sound_file

BLOCK = 1024  # frames; the ring holds all commands that can be applied in one block


@dataclass(frozen=True)
class Replayed:
    """The result of a replay; levels are relative to full scale."""

    duration_s: float
    real_time_factor: float
    peak: float
    rms: float
    events: int
    lost_states: int
    warnings: list[str]


def blocks(capture: Capture, ensemble: Ensemble) -> Iterator[Any]:
    """Yield the samples of a capture in blocks [shape=(frames, 2), float32]."""
    frames = capture.commands["frame"]
    borders = merge(range(0, capture.frames, BLOCK), sorted(capture.gaps), [capture.frames])
    for start, stop in pairwise(border for border, _ in groupby(borders)):
        if start in capture.gaps:
            if capture.version == 1:  # whose notes went on
                ensemble.come_to_rest()
            else:
                ensemble.end_all()
        due = slice(np.searchsorted(frames, start), np.searchsorted(frames, stop))
        commands, players = capture.commands[due].tolist(), capture.players[due].tolist()
        for (frame, kind, index, value, other), player in zip(commands, players, strict=True):
            instrument = ensemble.instruments[player]
            instrument.post(kind, frame=frame, index=index, value=value, other=other)
        samples = np.zeros((stop - start, EARS), np.float32)
        ensemble.process(samples)
        for rest, since in capture.gaps.items():
            if since < stop and rest > start:
                samples[max(since - start, 0) : max(rest - start, 0)] = 0.0
        yield samples


def replay(
    capture: Capture,
    target: Path,
    *,
    format_name: str,
    subtype: str,
    max_duration_h: float = math.inf,
    progress: Callable[[float, float], None] | None = None,
    may_replace: Callable[[Path], bool] = replace_any,
) -> Replayed:
    """Render a capture to a sound file. Raises YehuError; no partial file is left then."""
    check_duration(capture.frames / capture.rate, max_duration_h, "the capture lasts")
    ensemble = capture.beginning.ensemble()
    start = time.perf_counter()
    rate = round(capture.rate)
    with sound_file(target, rate, format_name, subtype, may_replace, channels=EARS) as file:
        for samples in blocks(capture, ensemble):
            file.write(samples)
            if progress is not None:
                progress(file.frames / capture.rate, capture.frames / capture.rate)
    duration_s = file.frames / capture.rate
    return Replayed(
        duration_s=duration_s,
        real_time_factor=duration_s / (time.perf_counter() - start),
        peak=file.peak,
        rms=file.rms,
        events=len(capture.commands),
        lost_states=ensemble.lost_states,
        warnings=capture.warnings,
    )
