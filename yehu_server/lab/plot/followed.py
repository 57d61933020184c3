"""The picture of a recording that was followed: what was heard over what is played."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.following.heard import Heard
from yehu_server.following.notes import A4_HZ, midi_of
from yehu_server.lab.plot import png
from yehu_server.lab.plot.axes import ABOVE
from yehu_server.lab.plot.panels import ASKED, GRID, HEARD, draw_spectrogram, label_notes
from yehu_server.rendering.plot_data import PlotData

SIZE = (14.0, 9.0)  # inches
MARGIN = 1.5  # semitones
SPAN_DB = 50.0


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
    """Draw what was heard over what is played, and write it to a PNG file.

    Raises
    ------
    OutputError
        Where it cannot be written.
    """

    def fill(figure: Any) -> None:
        panels = figure.subplots(3, 1, height_ratios=(1.0, 2.2, 1.8), sharex=True)
        draw_levels(panels[0], heard, watch)
        draw_pitches(panels[1], heard, semitones, watch)
        draw_spectrogram(panels[2], watch)
        moved = f", {semitones:+g} semitones" if semitones else ""
        panels[0].set_title(png.plain(f"{Path(heard.name).name}{moved}"), loc="left")
        panels[2].set(xlim=(0.0, max(watch.duration_s, 0.01)), xlabel="s")

    png.write_picture(target, SIZE, fill, overwrite=overwrite)
