"""Draws what was gathered of a rendering, and writes it to a PNG file."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from yehu_server.errors import OutputError
from yehu_server.files import anything, check_free, check_target, replacing, why
from yehu_server.lines import one_line
from yehu_server.plot.panels import draw_level, draw_pitch, draw_spectrogram
from yehu_server.plot.watch import Watch

SOFTWARE = "yehu-server render"  # named in a picture, which may therefore be replaced
BEGINNING = 4096  # bytes of a file in which it is named
INCHES, DPI = (14.0, 9.0), 110


def check_picture(target: Path, *, overwrite: bool = False) -> None:
    """Check that a picture may be written.

    Raises
    ------
    OutputError
        Where it may not, or its name ends otherwise than in .png.
    """
    if target.suffix.lower() != ".png":
        raise OutputError(f"{target}: a picture is a .png file")
    check_target(target)
    check_free(target, anything if overwrite else is_ours)


def is_ours(target: Path) -> bool:
    """Whether a file is a picture that `write_picture` made, or is empty."""
    try:
        with target.open("rb") as file:
            data = file.read(BEGINNING)
    except OSError:
        return False
    return not data or (data.startswith(b"\x89PNG") and SOFTWARE.encode() in data)


def write_picture(watch: Watch, target: Path, title: str, *, overwrite: bool = False) -> None:
    """Draw level, pitch and spectrogram, and write them to a PNG file.

    The same rendering gives the same bytes.

    Raises
    ------
    OutputError
        Where it cannot be written.
    """
    data = drawn(watch, title)
    may_replace = anything if overwrite else is_ours
    with replacing(target, may_replace) as partial:
        try:
            partial.write_bytes(data)
        except OSError as error:
            raise OutputError(f"{target}: cannot write: {why(error)}") from error


def drawn(watch: Watch, title: str) -> bytes:
    """Draw a picture; return the bytes of its PNG file."""
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    settings: Any = {"font.size": 10.0, "text.parse_math": False}
    # Not as the user has set matplotlib up: the same rendering has the same picture.
    with mpl.rc_context(mpl.rcParamsDefault), mpl.rc_context(settings):
        figure = Figure(figsize=INCHES, dpi=DPI, layout="constrained")
        FigureCanvasAgg(figure)
        panels = figure.subplots(3, 1, height_ratios=(1.0, 2.2, 1.8), sharex=True)
        draw_level(panels[0], watch)
        draw_pitch(panels[1], watch)
        draw_spectrogram(panels[2], watch)
        panels[0].set_title(_title(title), loc="left")
        panels[2].set(xlim=(0.0, max(watch.duration_s, 0.01)), xlabel="s")
        file = io.BytesIO()
        figure.savefig(file, format="png", metadata={"Software": SOFTWARE})
    return file.getvalue()


def _title(text: str) -> str:
    """A title in characters that the font has: others would warn and be drawn as boxes."""
    plain = one_line(text)
    return plain.encode("latin-1", "replace").decode("latin-1")[:120]
