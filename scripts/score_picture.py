"""Play a score and draw its waveform, level, pitch and spectrogram.

    .venv/bin/python scripts/score_picture.py IN.mid [-o OUT.png] [--mapping NAME] [--rate HZ]
                                              [--from S] [--to S]

The pitch panel shows the pitch heard, the pitch aimed at and the score. The script also prints
how many notes are in tune, the worst notes, and the jumps of the waveform where notes meet.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from figures import BLUE, RED, save

from yehu_server.core.midi.channels import PERCUSSION
from yehu_server.core.player.calibration import frequency_hz
from yehu_server.errors import ScoreError, YehuError
from yehu_server.playing.mapping import DEFAULT, load
from yehu_server.playing.pitch_and_level import a_weighted_db, cents, note_name, pitch_hz
from yehu_server.playing.style import Style
from yehu_server.rendering.options import Options
from yehu_server.rendering.performance import Performance
from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score

Array = Any


# ---------------------------------------------------------------- a score, played

BLOCK = 128  # frames between two readings of the player
WINDOW_S, STEP_S = 0.04, 0.01  # of the pitch analysis
LEVEL_S = 0.03
IN_TUNE_CENTS, ASTRAY_CENTS = 10.0, 50.0
FEWEST = 3  # windows in the middle of a note that are needed to check it
WORST = 8  # notes to list
BEFORE_S, AFTER_S, SETTLED_S = 0.002, 0.015, 0.03  # before and after a border; until a note settles
COLUMNS = 4000  # of the picture, at most
FFT_S, TOP_HZ, RANGE_DB = 0.046, 6000.0, 80.0
PAPER, INK, AIM, WAVE = "#d5dfeb", "#8ea5c0", "#e08a00", "#9db8d6"


@dataclass(frozen=True)
class Span:
    """The time (frames) during which one note sounds."""

    start: int
    end: int


@dataclass(frozen=True)
class Take:
    """A played score: samples, and the pitch aimed at from each of `starts` (frames)."""

    rate: float
    samples: Array
    starts: Array
    aims: Array  # fractional MIDI notes; NaN while none sounds
    spans: tuple[Span, ...]

    def aim(self, start: int, end: int) -> float:
        """Return the mean pitch aimed at between two frames of a note."""
        first, last = np.searchsorted(self.starts, (start, end - 1), side="right")
        return float(np.nanmean(self.aims[first - 1 : last]))


@dataclass(frozen=True)
class Heard:
    """The pitch found in one window of a note."""

    time_s: float
    aim: float
    pitch: float  # fractional MIDI note; NaN if none was found

    @property
    def error(self) -> float:
        """Return the pitch error in cents; positive is sharp."""
        return 100.0 * (self.pitch - self.aim)


@dataclass(frozen=True)
class Verdict:
    """The pitch error (cents) in the middle of a note; NaN if it has no pitch there."""

    time_s: float
    seconds: float
    aim: float
    error: float


def take(score: Score, options: Options, end_s: float) -> Take:
    """Play a score, up to `end_s` at most, and record what the player aims at."""
    performance = Performance(score, options)
    wishes = performance.wishes
    blocks, starts, aims, marks = [], [], [], []
    frame, end = 0, end_s * options.rate
    for samples in performance.blocks():
        blocks.append(samples)
        starts.append(frame)
        aims.append(math.nan if wishes.pitch is None else wishes.pitch)
        marks.append((wishes.notes_played, wishes.sounding))
        frame += len(samples)
        if frame >= end:
            break
    if not blocks:
        raise ScoreError(f"{score.name}: nothing to play")
    borders = [at for at in range(1, len(marks)) if marks[at] != marks[at - 1]]
    places = pairwise([0, *borders, len(marks)])
    spans = tuple(
        Span(starts[first], starts[last] if last < len(starts) else frame)
        for first, last in places
        if marks[first][1] is not None
    )
    sound = np.concatenate(blocks)
    return Take(float(options.rate), sound, np.array(starts), np.array(aims), spans)


def listen(played: Take, span: Span, a4: float) -> list[Heard]:
    """Return the pitch in every window of a note.

    The search begins half an octave below the pitch aimed at. A finger stops both strings, which
    are a fifth apart; if the other string rings too, the sound of both is periodic an octave
    below the note, although nobody hears that pitch.
    """
    window, step = round(WINDOW_S * played.rate), round(STEP_S * played.rate)
    heard = []
    for start in range(span.start, span.end - window + 1, step):
        aim = played.aim(start, start + window)
        wanted = frequency_hz(aim, a4)
        part = played.samples[start : start + window]
        found = pitch_hz(part, played.rate, lo=0.7 * wanted, hi=3.2 * wanted)
        pitch = aim + cents(found, wanted) / 100.0 if math.isfinite(found) else math.nan
        heard.append(Heard((start + 0.5 * window) / played.rate, aim, pitch))
    return heard


def judge(played: Take, span: Span, heard: Sequence[Heard]) -> Verdict | None:
    """Return the pitch error of the middle half of a note; None if it is too short."""
    start, end = span.start / played.rate, span.end / played.rate
    quarter = 0.25 * (end - start)
    middle = [one for one in heard if start + quarter <= one.time_s <= end - quarter]
    if len(middle) < FEWEST:
        return None
    errors = [one.error for one in middle if math.isfinite(one.error)]
    error = float(np.median(errors)) if 2 * len(errors) >= len(middle) else math.nan
    aim = float(np.median([one.aim for one in middle]))
    return Verdict(start, end - start, aim, error)


def jumps(played: Take) -> list[tuple[float, float]]:
    """Return the time (s) of each border of notes and its jump relative to those inside."""
    size = np.abs(np.diff(played.samples))
    before, after, settled = (round(s * played.rate) for s in (BEFORE_S, AFTER_S, SETTLED_S))
    around: dict[int, list[float]] = {}
    for span in played.spans:
        inside = size[span.start + settled : span.end - before]
        largest = [float(inside.max())] if len(inside) else []
        for border in (span.start, span.end):
            around.setdefault(border, []).extend(largest)
    found = []
    for border, largest in around.items():
        here = size[max(border - before, 0) : border + after]
        if len(here) and max(largest, default=0.0) > 0.0:
            found.append((border / played.rate, float(here.max()) / max(largest)))
    return found


def score_bars(score: Score, options: Options) -> list[tuple[float, float, float]]:
    """Return start (s), end (s) and note of each key, fitted into the range, without pedal."""
    held: dict[tuple[int, int], float] = {}
    bars = []

    def let_go(key: tuple[int, int], time_s: float) -> None:
        begin, note = held.pop(key, math.inf), options.style.policy.fit(key[1])
        if begin < time_s and note is not None:
            bars.append((begin, time_s, note))

    for event in score.events:
        message = event.message
        if message.type == "reset":
            for key in list(held):
                let_go(key, event.time_s)
        elif message.type in ("note_on", "note_off") and message.channel != PERCUSSION:
            key = (message.channel, message.note)
            let_go(key, event.time_s)
            if message.type == "note_on" and message.velocity > 0:
                held[key] = event.time_s
    for key in list(held):
        let_go(key, score.duration_s)
    return bars


def draw_wave(axes: Any, played: Take, begin: int, end: int) -> None:
    """Draw the envelope of the waveform, and the level over it."""
    part = played.samples[begin:end]
    size = max(1, len(part) // COLUMNS)
    columns = part[: len(part) // size * size].reshape(-1, size)
    times = (begin + size * np.arange(len(columns))) / played.rate
    axes.fill_between(times, columns.min(axis=1), columns.max(axis=1), color=WAVE, lw=0.3)
    peak = 1.1 * float(np.abs(part).max(initial=1e-3))
    axes.set(ylim=(-peak, peak), ylabel="waveform,\nof full scale")

    window = round(LEVEL_S * played.rate)
    starts = np.arange(begin, max(end - window, begin + 1), max(window // 3, size))
    levels = [a_weighted_db(played.samples[at : at + window], played.rate) for at in starts]
    right = axes.twinx()
    right.plot((starts + 0.5 * window) / played.rate, levels, AIM, lw=1.2)
    right.set(ylim=(-70, 0), yticks=range(-60, 1, 20))
    right.set_ylabel("level, dB(A)\nof full scale", color=AIM)
    right.tick_params(axis="y", colors=AIM)


def draw_pitches(
    axes: Any, played: Take, heard: Sequence[Heard], bars: Sequence[tuple[float, float, float]]
) -> None:
    """Draw the score as bars, the aim as a line and pitches as dots, red if far off."""
    begins, ends, notes = (np.array(column) for column in zip(*bars, strict=True))
    axes.barh(notes, ends - begins, 0.8, begins, color=PAPER, edgecolor=INK, lw=0.5, label="score")
    axes.plot(played.starts / played.rate, played.aims, color=AIM, lw=1.4, label="aim")
    low, high = reach([note for _, _, note in bars] + [one.aim for one in heard])
    times, pitches, errors = (
        np.array([getattr(one, field) for one in heard]) for field in ("time_s", "pitch", "error")
    )
    astray = np.abs(errors) > ASTRAY_CENTS
    close = np.abs(errors) <= ASTRAY_CENTS
    axes.plot(times[close], pitches[close], ".", color=BLUE, ms=3.5, label="heard")
    off = f"more than {ASTRAY_CENTS:g} cents off"
    axes.plot(times[astray], pitches[astray], ".", color=RED, ms=5, label=off)
    for beyond, marker, edge in ((pitches > high, "^", high), (pitches < low, "v", low)):
        inner = edge - math.copysign(0.05 * (high - low), edge - 0.5 * (low + high))
        label = "beyond the picture" if marker == "v" else None
        axes.plot(times[beyond], np.full(beyond.sum(), inner), marker, color=RED, ms=5, label=label)
    mute = np.isnan(pitches)
    bottom = np.full(mute.sum(), low + 0.015 * (high - low))
    axes.plot(times[mute], bottom, "|", color="k", ms=8, label="no clear pitch")
    ticks = [
        note for note in range(math.ceil(low), math.floor(high) + 1) if note_name(note)[1] != "#"
    ]
    axes.set(ylim=(low, high), yticks=ticks, yticklabels=[note_name(note) for note in ticks])
    axes.grid(axis="y", color="0.9", lw=0.6)
    axes.set_axisbelow(True)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=6, frameon=False, fontsize=9)


def reach(pitches: Sequence[float]) -> tuple[float, float]:
    """Return the pitch range of the picture: that of the given pitches, and a margin."""
    return min(pitches) - 2.5, max(pitches) + 2.5


def draw_spectrogram(axes: Any, played: Take, begin: int, end: int) -> None:
    """Draw a spectrogram with a range of RANGE_DB and at most COLUMNS columns."""
    size = round(FFT_S * played.rate)
    part = np.pad(played.samples, size // 2 + 1)[begin:]  # centres each column on its window
    count = max(2, min(COLUMNS, (end - begin) // (size // 8)))
    starts = np.linspace(0, end - begin, count).astype(int)
    rows = int(min(TOP_HZ * size / played.rate + 2, size // 2))
    power = np.empty((rows, count), np.float32)
    window = np.hanning(size)
    for column, start in enumerate(starts):
        power[:, column] = np.abs(np.fft.rfft(part[start : start + size] * window)[:rows]) ** 2
    level = 10.0 * np.log10(power + 1e-20)
    peak = float(level.max())
    extent = (
        begin / played.rate,
        end / played.rate,
        -0.5 * played.rate / size,
        (rows - 0.5) * played.rate / size,
    )
    axes.imshow(
        level, cmap="magma", vmin=peak - RANGE_DB, vmax=peak, extent=extent, aspect="auto",
        origin="lower", interpolation="bilinear",
    )  # fmt: skip
    axes.set(ylim=(0, TOP_HZ), yticks=range(0, 6001, 2000), yticklabels=(0, 2, 4, 6))
    axes.set_ylabel("kHz")


def table(checked: Sequence[Verdict], spans: int, borders: Sequence[tuple[float, float]]) -> str:
    """Return the printed summary of a take."""
    good = [one for one in checked if abs(one.error) <= IN_TUNE_CENTS]
    lines = [
        f"notes that sounded          {spans}",
        f"long enough to be checked   {len(checked)}",
        f"within {IN_TUNE_CENTS:g} cents             {len(good)} ({share(good, checked)})",
        "worst:    at s  lasts s   note   error, cents",
    ]
    worst = sorted(checked, key=lambda one: -size_of(one.error))
    for one in worst[:WORST]:
        off = f"{one.error:+9.1f}" if math.isfinite(one.error) else "no pitch"
        note = f"{note_name(round(one.aim)):>4}{100.0 * (one.aim - round(one.aim)):+4.0f}"
        lines.append(f"      {one.time_s:9.3f} {one.seconds:7.3f} {note}     {off}")
    if borders:
        time_s, ratio = max(borders, key=lambda border: border[1])
        usual = float(np.median([border[1] for border in borders]))
        lines.append(
            f"jumps where notes meet, relative to the largest inside these notes: "
            f"{ratio:.2f} at most (at {time_s:.3f} s), median {usual:.2f}"
        )
    return "\n".join(lines)


def size_of(error: float) -> float:
    """Return the absolute error for sorting; no pitch is the largest error."""
    return abs(error) if math.isfinite(error) else math.inf


def share(some: Sequence[Any], of_all: Sequence[Any]) -> str:
    """Return the share of some items as a percentage text."""
    return f"{100.0 * len(some) / max(len(of_all), 1):.1f} %"


def score_picture(arguments: argparse.Namespace) -> None:
    """Play the score, print the summary and write the picture."""
    options = Options(
        rate=arguments.rate,
        style=Style(mapping=load(arguments.mapping)),
        block=BLOCK,
        is_dry=True,
        is_mono=True,
    )
    score = read_score(arguments.midi)
    if not arguments.begin < arguments.end:
        raise ScoreError(f"{score.name}: --from must be less than --to")
    for warning in score.warnings:
        print(f"{score.name}: {warning}", file=sys.stderr)
    played = take(score, options, arguments.end + FFT_S)
    begin, end = (
        int(min(max(at * played.rate, 0.0), float(len(played.samples))))
        for at in (arguments.begin, arguments.end)
    )
    shown = [span for span in played.spans if span.end > begin and span.start < end]
    bars = [
        (max(first, begin / played.rate), min(last, end / played.rate), note)
        for first, last, note in score_bars(score, options)
        if last * played.rate > begin and first * played.rate < end
    ]
    if not shown or not bars:
        raise ScoreError(f"{score.name}: no note sounds in that time")
    heard = [listen(played, span, options.style.a4) for span in shown]
    verdicts = [judge(played, span, own) for span, own in zip(shown, heard, strict=True)]
    checked = [verdict for verdict in verdicts if verdict is not None]
    borders = [one for one in jumps(played) if begin <= one[0] * played.rate <= end]
    print(table(checked, len(shown), borders))

    seconds = (end - begin) / played.rate
    width = min(max(3.0 + 0.8 * seconds, 14.0), 45.0)
    figure, panels = plt.subplots(
        3, 1, figsize=(width, 9), height_ratios=(1, 2.4, 1.3), sharex=True, layout="constrained"
    )
    draw_wave(panels[0], played, begin, end)
    draw_pitches(panels[1], played, [one for own in heard for one in own], bars)
    draw_spectrogram(panels[2], played, begin, end)
    panels[2].set(xlim=(begin / played.rate, end / played.rate), xlabel="s")
    good = [one for one in checked if abs(one.error) <= IN_TUNE_CENTS]
    panels[0].set_title(
        f"{score.name}, mapping {options.style.mapping.name}, {options.rate / 1000:g} kHz: "
        f"{len(good)} of {len(checked)} notes within {IN_TUNE_CENTS:g} cents",
        loc="left",
    )
    save(figure, arguments.output or Path(f"{arguments.midi.stem}.png"))


# ---------------------------------------------------------------- the command line


def main() -> None:
    """Parse the command line and draw the picture."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("midi", type=Path, metavar="IN.mid")
    parser.add_argument("-o", "--output", type=Path, metavar="OUT.png")
    parser.add_argument("--rate", type=int, default=44100, metavar="HZ")
    parser.add_argument("--mapping", default=DEFAULT, metavar="NAME")
    parser.add_argument("--from", dest="begin", type=float, default=0.0, metavar="S")
    parser.add_argument("--to", dest="end", type=float, default=math.inf, metavar="S")
    try:
        score_picture(parser.parse_args())
    except YehuError as error:
        parser.exit(2, f"{parser.prog}: {error}\n")


if __name__ == "__main__":
    main()
