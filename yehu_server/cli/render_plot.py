"""``yehu-server render --plot PNG``: a picture of a rendering."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from yehu_server.rendering.options import Options, Part
    from yehu_server.rendering.plot_data import PlotData

PLOTTED_BLOCK = 512  # frames between two readings of the pitch that is asked for


def check_plot(target: Path, *, overwrite: bool) -> None:
    """Check that a picture can be drawn and written.

    Raises
    ------
    YehuError
        Where it cannot.
    """
    from yehu_server.lab.plot.png import check_picture

    check_picture(target, "--plot", overwrite=overwrite)


def plot_data_of(parts: Sequence[Part], options: Options) -> PlotData:
    """What gathers the picture of a rendering."""
    from yehu_server.rendering.plot_data import PlotData

    duration_s = max(part.score.duration_s for part in parts)
    return PlotData(float(options.rate), duration_s, len(parts), options.style.a4)


def write_plot(
    watch: PlotData, target: Path, parts: Sequence[Part], options: Options, *, overwrite: bool
) -> None:
    """Draw and write the picture of a rendering.

    Raises
    ------
    OutputError
        Where it cannot be written.
    """
    from yehu_server.lab.plot.panels import write_picture

    watch.finish()
    voices = "" if len(parts) == 1 else f"{len(parts)} parts, "
    title = f"{parts[0].score.name}: {voices}{options.rate / 1000.0:g} kHz"
    write_picture(watch, target, title, overwrite=overwrite)
