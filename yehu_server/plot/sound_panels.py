"""The picture of a rendering: its level, pitch and spectrogram."""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.playing.pitch_and_level import note_name
from yehu_server.plot import png
from yehu_server.plot.axes import ABOVE
from yehu_server.rendering.plot_data import PlotData

RANGE_DB = 80.0
LEVELS_DB = (-70.0, 0.0)
LEVEL, PEAK, HEARD, ASKED = "#1f5fa8", "#9db8d6", "#1f5fa8", "#e08a00"
MANY = 16  # notes, of which not all names have room
OVER_SPECTRUM = "#5ad1ff"
GRID: Any = {"axis": "y", "color": "0.9", "lw": 0.6}
SIZE = (14.0, 9.0)  # inches
Draw = Callable[[Any], None]  # into axes


def draw_level(axes: Any, data: PlotData) -> None:
    """Draw root mean square and peak over time."""
    times = data.times_s
    axes.fill_between(times, LEVELS_DB[0], data.peaks_db, color=PEAK, lw=0.0, label="peak")
    axes.plot(times, data.levels_db, color=LEVEL, lw=1.0, label="level (rms)")
    axes.set(ylim=LEVELS_DB, ylabel="dB of full scale")
    axes.grid(**GRID)
    axes.legend(**ABOVE)


def draw_pitch(axes: Any, data: PlotData) -> None:
    """Draw the pitches that were asked for and, of a single voice, that was heard."""
    times, asked = data.asked
    is_asked = bool(np.isfinite(asked).any())
    for voice in range(data.voices if is_asked else 0):
        label = "asked" if voice == 0 else None
        axes.plot(times, asked[:, voice], color=ASKED, lw=1.6, label=label)
    if data.voices == 1:
        axes.plot(data.times_s, data.pitches, ".", color=HEARD, ms=2.5, label="played")
    wanted = (asked if is_asked else data.pitches).ravel()
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


def draw_spectrogram(axes: Any, data: PlotData, *, has_pitch: bool = False) -> None:
    """Draw the spectrum over time with its colour bar, and the pitch that was heard over it."""
    levels = data.spectra_db
    axes.set_ylabel("kHz")
    if levels.size == 0:
        return
    step_s = data.step / data.rate
    extent = (
        -0.5 * step_s,
        (levels.shape[1] - 0.5) * step_s,
        -0.5e-3 * data.row_hz,
        1e-3 * (levels.shape[0] - 0.5) * data.row_hz,
    )
    top = float(levels.max())
    image = axes.imshow(
        levels, cmap="magma", vmin=top - RANGE_DB, vmax=top, extent=extent, aspect="auto",
        origin="lower", interpolation="nearest",
    )  # fmt: skip
    if has_pitch:
        heard_khz = 1e-3 * data.a4 * 2.0 ** ((data.pitches - 69.0) / 12.0)
        axes.plot(data.times_s, heard_khz, ".", color=OVER_SPECTRUM, ms=2.5, label="pitch")
        axes.legend(**ABOVE)
    axes.set_ylim(0.0, extent[3])
    axes.figure.colorbar(image, ax=axes, label="dB of a full sine", pad=0.01)


def write_picture(
    data: PlotData,
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
        (level or partial(draw_level, data=data))(panels[0])
        (pitch or partial(draw_pitch, data=data))(panels[1])
        draw_spectrogram(panels[2], data)
        panels[0].set_title(png.plain(title), loc="left")
        panels[2].set(xlim=(0.0, max(data.duration_s, 0.01)), xlabel="s")

    png.write_picture(target, SIZE, fill, overwrite=overwrite)
