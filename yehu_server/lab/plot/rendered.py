"""The picture of a rendering: its level, pitch and spectrogram; or over a recording it follows."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.following.heard import Heard
from yehu_server.following.notes import A4_HZ, midi_of
from yehu_server.lab.plot import png
from yehu_server.lab.plot.cells import ABOVE
from yehu_server.playing.pitch_and_level import note_name
from yehu_server.rendering.plot_data import PlotData

RANGE_DB = 80.0
LEVELS_DB = (-70.0, 0.0)
LEVEL, PEAK, HEARD, ASKED = "#1f5fa8", "#9db8d6", "#1f5fa8", "#e08a00"
MANY = 16  # notes, of which not all names have room
OVER_SPECTRUM = "#5ad1ff"
GRID: Any = {"axis": "y", "color": "0.9", "lw": 0.6}
SIZE = (14.0, 9.0)  # inches
Draw = Callable[[Any], None]  # into axes
MARGIN = 1.5  # semitones
SPAN_DB = 50.0


def draw_level(axes: Any, watch: PlotData) -> None:
    """Draw root mean square and peak over time."""
    times = watch.times_s
    axes.fill_between(times, LEVELS_DB[0], watch.peaks_db, color=PEAK, lw=0.0, label="peak")
    axes.plot(times, watch.levels_db, color=LEVEL, lw=1.0, label="level (rms)")
    axes.set(ylim=LEVELS_DB, ylabel="dB of full scale")
    axes.grid(**GRID)
    axes.legend(**ABOVE)


def draw_pitch(axes: Any, watch: PlotData) -> None:
    """Draw the pitches that were asked for and, of a single voice, that was heard."""
    times, asked = watch.asked
    is_asked = bool(np.isfinite(asked).any())
    for voice in range(watch.voices if is_asked else 0):
        label = "asked" if voice == 0 else None
        axes.plot(times, asked[:, voice], color=ASKED, lw=1.6, label=label)
    if watch.voices == 1:
        axes.plot(watch.times_s, watch.pitches, ".", color=HEARD, ms=2.5, label="played")
    wanted = (asked if is_asked else watch.pitches).ravel()
    wanted = wanted[np.isfinite(wanted)]
    low, high = (wanted.min() - 2.5, wanted.max() + 2.5) if len(wanted) else (64.0, 90.0)
    label_notes(axes, low, high)
    axes.legend(**ABOVE)


def label_notes(axes: Any, low: float, high: float) -> None:
    """Show pitches (fractional MIDI notes) from one to another, by the names of notes."""
    notes = range(math.ceil(low), math.floor(high) + 1)
    letters = "ABCDEFG" if len(notes) < MANY else "CEGA"
    ticks = [note for note in notes if note_name(note)[0] in letters and "#" not in note_name(note)]
    axes.set(ylim=(low, high), yticks=ticks, yticklabels=[note_name(note) for note in ticks])
    axes.set_ylabel("pitch")
    axes.grid(**GRID)


def draw_spectrogram(axes: Any, watch: PlotData, *, has_pitch: bool = False) -> None:
    """Draw the spectrum over time with its colour bar, and the pitch that was heard over it."""
    levels = watch.spectra_db
    axes.set_ylabel("kHz")
    if levels.size == 0:
        return
    step_s = watch.step / watch.rate
    extent = (
        -0.5 * step_s,
        (levels.shape[1] - 0.5) * step_s,
        -0.5e-3 * watch.row_hz,
        1e-3 * (levels.shape[0] - 0.5) * watch.row_hz,
    )
    top = float(levels.max())
    image = axes.imshow(
        levels, cmap="magma", vmin=top - RANGE_DB, vmax=top, extent=extent, aspect="auto",
        origin="lower", interpolation="nearest",
    )  # fmt: skip
    if has_pitch:
        heard_khz = 1e-3 * watch.a4 * 2.0 ** ((watch.pitches - 69.0) / 12.0)
        axes.plot(watch.times_s, heard_khz, ".", color=OVER_SPECTRUM, ms=2.5, label="pitch")
        axes.legend(**ABOVE)
    axes.set_ylim(0.0, extent[3])
    axes.figure.colorbar(image, ax=axes, label="dB of a full sine", pad=0.01)


def write_picture(
    watch: PlotData,
    target: Path,
    title: str,
    level: Draw | None = None,
    pitch: Draw | None = None,
    *,
    overwrite: bool = False,
) -> None:
    """Draw what was gathered of a rendering, and write it to a PNG file.

    `level` and `pitch` draw these panels; by default `draw_level` and `draw_pitch`. Raises
    OutputError where it cannot be written.
    """

    def fill(figure: Any) -> None:
        panels = figure.subplots(3, 1, height_ratios=(1.0, 2.2, 1.8), sharex=True)
        (level or partial(draw_level, watch=watch))(panels[0])
        (pitch or partial(draw_pitch, watch=watch))(panels[1])
        draw_spectrogram(panels[2], watch)
        panels[0].set_title(png.plain(title), loc="left")
        panels[2].set(xlim=(0.0, max(watch.duration_s, 0.01)), xlabel="s")

    png.write_picture(target, SIZE, fill, overwrite=overwrite)


def draw_pitches(axes: Any, heard: Heard, semitones: float, watch: PlotData) -> None:
    """Draw the pitch that was heard, transposed as it is played, and the one that is played."""
    shift = semitones + 12.0 * np.log2(A4_HZ / watch.a4)
    wanted = midi_of(heard.pitch_hz) + shift
    axes.plot(heard.times_s, wanted, color=ASKED, lw=2.4, label="heard")
    axes.plot(watch.times_s, watch.pitches, ".", color=HEARD, ms=2.5, label="played")
    known = wanted[np.isfinite(wanted)]
    label_notes(axes, float(known.min()) - MARGIN, float(known.max()) + MARGIN)
    axes.legend(**ABOVE)


def draw_levels(axes: Any, heard: Heard, watch: PlotData) -> None:
    """Draw both levels, each below its highest."""
    for times, levels, colour, label in (
        (heard.times_s, heard.level_db, ASKED, "heard (A-weighted)"),
        (watch.times_s, watch.levels_db, HEARD, "played"),
    ):
        axes.plot(times, levels - levels.max(initial=-120.0), color=colour, lw=1.0, label=label)
    axes.set(ylim=(-SPAN_DB, 3.0), ylabel="dB below the loudest")
    axes.grid(**GRID)
    axes.legend(**ABOVE)


def write_followed(
    heard: Heard, semitones: float, watch: PlotData, target: Path, *, overwrite: bool = False
) -> None:
    """Draw what was heard over what is played into a PNG file; raises OutputError."""
    moved = f", {semitones:+g} semitones" if semitones else ""
    write_picture(
        watch,
        target,
        f"{Path(heard.name).name}{moved}",
        lambda axes: draw_levels(axes, heard, watch),
        lambda axes: draw_pitches(axes, heard, semitones, watch),
        overwrite=overwrite,
    )
