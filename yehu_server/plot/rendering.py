"""The picture of a rendering: level, pitch and spectrogram."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from yehu_server.plot import png
from yehu_server.plot.panels import draw_level, draw_pitch, draw_spectrogram
from yehu_server.rendering.watch import Watch

SIZE = (14.0, 9.0)  # inches


def write_picture(watch: Watch, target: Path, title: str, *, overwrite: bool = False) -> None:
    """Draw what was gathered of a rendering, and write it to a PNG file.

    Raises
    ------
    OutputError
        Where it cannot be written.
    """

    def fill(figure: Any) -> None:
        panels = figure.subplots(3, 1, height_ratios=(1.0, 2.2, 1.8), sharex=True)
        draw_level(panels[0], watch)
        draw_pitch(panels[1], watch)
        draw_spectrogram(panels[2], watch)
        panels[0].set_title(png.plain(title), loc="left")
        panels[2].set(xlim=(0.0, max(watch.duration_s, 0.01)), xlabel="s")

    png.write_picture(target, SIZE, fill, overwrite=overwrite)
