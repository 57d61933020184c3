"""Render a score to a sound file, faster than real time."""

from __future__ import annotations

import contextlib
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.audio.file import SoundWriter, check_format, sound_file
from yehu_server.errors import OutputError
from yehu_server.files import anything, why
from yehu_server.params.spec import Place
from yehu_server.params.table import find
from yehu_server.physics.quantities import Quantities
from yehu_server.player.calibration import Calibration
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.range_policy import RangePolicy
from yehu_server.playing.style import Style
from yehu_server.score.score_notes import notes_of
from yehu_server.score.smf import Score, ScoreEvent

Samples = np.ndarray[Any, np.dtype[np.float32]]

BLOCK = 4096  # frames; the sound does not depend on it
QUIET = 1e-4  # 80 dB below full scale
QUIET_S = 0.2  # the tail ends after this time of quiet
LONGEST_TAIL_S = 5.0
END: tuple[int, ScoreEvent | None] = (-1, None)  # after the last event
NORMALIZED_PEAK = 10.0 ** (-1.0 / 20.0)


@dataclass(frozen=True)
class Options:
    """How to render; see ``yehu-server render --help``."""

    rate: int = 44100
    format_name: str = "wav"
    subtype: str = "24"
    channels: frozenset[int] | None = None  # counted from 0; None: all but percussion
    tail_s: float | None = None  # None: until it is quiet
    gain_db: float | None = None  # None: that of the preset
    normalize: bool = False
    phrasing: float = 0.0  # of the player; the score is shaped before (score.phrasing)
    style: Style = field(default_factory=Style)
    quantities: Quantities = field(default_factory=Quantities)
    calibration: Calibration | None = None  # None: looked up or measured
    block: int = BLOCK


@dataclass(frozen=True)
class Summary:
    """The result of a rendering; levels are relative to full scale."""

    duration_s: float
    real_time_factor: float
    peak: float
    rms: float
    notes_played: int
    notes_out_of_range: int
    policy: RangePolicy
    unconverged_solves: int
    lost_states: int
    friction_bound: float
    notes_by_channel: dict[int, int]
    percussion_notes: int  # of channel 10, not played
    unknown_programs: tuple[int, ...]  # 1 to 128


class Performance:
    """Plays a score on an instrument, block by block."""

    def __init__(self, score: Score, options: Options) -> None:
        self._score = score
        self._options = options
        calibration = options.calibration or calibration_for(
            float(options.rate), options.quantities, a4=options.style.a4
        )
        style = options.style
        self.instrument = style.instrument(float(options.rate), calibration, options.quantities)
        self.wishes = style.wishes(self.instrument)
        self.midi = style.midi(self.wishes, _set(options.channels))
        self.wishes.write("/playing/phrasing", options.phrasing)
        gain = () if options.gain_db is None else (("/output/gain", options.gain_db),)
        for address, value in (*gain, *style.settings):
            self.wishes.write(address, value, hold=True)
            if find(address).place is Place.ENGINE:  # there from the first sample on
                self.instrument.write(address, value, ramp_ms=0.0)
        self._lengths_s = {note.begins: note.length_s for note in notes_of(score)}
        self.score_frames = self.instrument.frames(score.duration_s * 1e3)

    def blocks(self) -> Iterator[Samples]:
        """Yield the samples of score and tail, relative to full scale."""
        events = enumerate(self._score.events)
        number, event = next(events, END)
        position = 0
        while position < self.score_frames:
            end = min(position + self._options.block, self.score_frames)
            while event is not None:
                frame = self.instrument.frames(event.time_s * 1e3)
                if frame >= end:
                    break
                self._receive(number, event, frame)
                number, event = next(events, END)
            yield self._process(end - position)
            position = end
        while event is not None:  # on the very last frame
            self._receive(number, event, position)
            number, event = next(events, END)
        self.midi.end_all(frame=position)
        yield from self._tail()

    def _receive(self, number: int, event: ScoreEvent, frame: int) -> None:
        if number in self._lengths_s:
            self.wishes.write("/playing/note_length", self._lengths_s[number], frame=frame)
        self.midi.receive(event.message, frame=frame)

    def _tail(self) -> Iterator[Samples]:
        if self._options.tail_s is not None:
            left = self.instrument.frames(self._options.tail_s * 1e3)
            while left > 0:
                yield self._process(min(self._options.block, left))
                left -= self._options.block
            return
        window = self.instrument.frames(10.0)
        quiet = 0.0
        for _ in range(round(LONGEST_TAIL_S / 0.01)):
            samples = self._process(window)
            yield samples
            quiet = quiet + 0.01 if np.abs(samples).max() < QUIET else 0.0
            if quiet >= QUIET_S:
                return

    def _process(self, frames: int) -> Samples:
        out = np.zeros(frames, np.float32)
        self.instrument.process(out)
        return out


def render(
    score: Score,
    target: Path,
    options: Options,
    progress: Callable[[float, float], None] | None = None,
    may_replace: Callable[[Path], bool] = anything,
) -> Summary:
    """Render a score to a sound file.

    Parameters
    ----------
    progress : callable, optional
        Called with the seconds done and those of the score.
    may_replace : callable
        Returns whether an older target may be replaced.

    Raises
    ------
    YehuError
        Where it fails; no partial file is left.
    """
    check_format(options.format_name, options.subtype)
    performance = Performance(score, options)
    start = time.perf_counter()
    form = (options.format_name, options.subtype)
    with sound_file(target, options.rate, *form, may_replace) as file:
        blocks = _with_progress(performance.blocks(), options.rate, score.duration_s, progress)
        if options.normalize:
            _write_normalized(blocks, file, target.parent)
        else:
            for samples in blocks:
                file.write(samples)
    elapsed = time.perf_counter() - start
    duration_s = file.frames / options.rate
    return Summary(
        duration_s=duration_s,
        real_time_factor=duration_s / elapsed,
        peak=file.peak,
        rms=file.rms,
        notes_played=performance.wishes.notes_played,
        notes_out_of_range=performance.wishes.notes_out_of_range,
        policy=options.style.policy,
        unconverged_solves=performance.instrument.unconverged_solves,
        lost_states=performance.instrument.lost_states,
        friction_bound=performance.instrument.friction_bound,
        notes_by_channel=dict(sorted(performance.midi.notes_by_channel.items())),
        percussion_notes=performance.midi.percussion_notes,
        unknown_programs=tuple(sorted(performance.midi.unknown_programs)),
    )


def _write_normalized(blocks: Iterator[Samples], file: SoundWriter, folder: Path) -> None:
    """Write blocks scaled to NORMALIZED_PEAK, in two passes through a temporary file."""
    peak = 0.0
    with contextlib.ExitStack() as stack:
        try:
            scratch = stack.enter_context(tempfile.TemporaryFile(dir=folder))
            for samples in blocks:
                peak = max(peak, float(np.abs(samples).max(initial=0.0)))
                scratch.write(samples.tobytes())
            scratch.seek(0)
        except OSError as error:
            raise OutputError(f"{folder}: cannot write: {why(error)}") from error
        factor = np.float32(NORMALIZED_PEAK / peak if peak > 0.0 else 1.0)
        while data := scratch.read(4 * BLOCK):
            file.write(np.frombuffer(data, np.float32) * factor)


def _with_progress(
    blocks: Iterator[Samples],
    rate: int,
    total: float,
    progress: Callable[[float, float], None] | None,
) -> Iterator[Samples]:
    frames = 0
    for samples in blocks:
        yield samples
        frames += len(samples)
        if progress is not None:
            progress(frames / rate, total)


def _set(channels: Sequence[int] | frozenset[int] | None) -> set[int] | None:
    return None if channels is None else set(channels)
