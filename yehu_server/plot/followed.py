"""The picture of a rendering over the recording that it follows."""

from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.following.heard import Heard
from yehu_server.following.notes import A4_HZ, midi_of
from yehu_server.plot.axes import ABOVE
from yehu_server.plot.sound_panels import ASKED, GRID, HEARD, label_notes, write_picture
from yehu_server.rendering.plot_data import PlotData

MARGIN = 1.5  # semitones
SPAN_DB = 50.0


def draw_pitches(axes: Any, heard: Heard, semitones: float, data: PlotData) -> None:
    """Draw the pitch that was heard, transposed as it is played, and the one that is played."""
    shift = semitones + 12.0 * np.log2(A4_HZ / data.a4)
    wanted = midi_of(heard.pitch_hz) + shift
    axes.plot(heard.times_s, wanted, color=ASKED, lw=2.4, label="heard")
    axes.plot(data.times_s, data.pitches, ".", color=HEARD, ms=2.5, label="played")
    known = wanted[np.isfinite(wanted)]
    label_notes(axes, float(known.min()) - MARGIN, float(known.max()) + MARGIN)
    axes.legend(**ABOVE)


def draw_levels(axes: Any, heard: Heard, data: PlotData) -> None:
    """Draw both levels, each below its highest."""
    for times, levels, colour, label in (
        (heard.times_s, heard.level_db, ASKED, "heard (A-weighted)"),
        (data.times_s, data.levels_db, HEARD, "played"),
    ):
        axes.plot(times, levels - levels.max(initial=-120.0), color=colour, lw=1.0, label=label)
    axes.set(ylim=(-SPAN_DB, 3.0), ylabel="dB below the loudest")
    axes.grid(**GRID)
    axes.legend(**ABOVE)


def write_followed(
    heard: Heard, semitones: float, data: PlotData, target: Path, *, overwrite: bool = False
) -> None:
    """Draw what was heard over what is played into a PNG file; raises OutputError."""
    moved = f", {semitones:+g} semitones" if semitones else ""
    write_picture(
        data,
        target,
        f"{Path(heard.name).name}{moved}",
        lambda axes: draw_levels(axes, heard, data),
        lambda axes: draw_pitches(axes, heard, semitones, data),
        overwrite=overwrite,
    )
