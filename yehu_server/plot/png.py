"""PNG files of pictures: whether they may be written, and the same bytes for the same picture."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

from yehu_server.errors import OutputError, one_line
from yehu_server.util import files
from yehu_server.util.hints import require_package

SOFTWARE = "yehu-server"  # named in a picture, which may therefore be replaced
DPI = 110
BEGINNING = 4096  # bytes of a file in which it is named
MAX_TEXT = 120  # characters


def check_picture(target: Path, what: str, *, overwrite: bool = False) -> None:
    """Check that a picture can be drawn, and may be written.

    `what` needs it, such as ``--plot``, for the message. Raises ParameterError where matplotlib is
    missing; OutputError where it may not, or its name ends otherwise than in .png.
    """
    require_package("matplotlib", what, "plots")
    if target.suffix.lower() != ".png":
        raise OutputError(f"{target}: a picture is a .png file")
    files.check_target(target)
    files.check_free(target, files.replace_any if overwrite else is_ours)


def is_ours(target: Path) -> bool:
    """Whether a file is a picture that `write_picture` made, or is empty."""
    try:
        with files.open_regular(target) as file:
            data = file.read(BEGINNING)
    except OSError:
        return False
    return not data or (data.startswith(b"\x89PNG") and SOFTWARE.encode() in data)


def write_picture(
    target: Path, size: tuple[float, float], fill: Callable[[Any], None], *, overwrite: bool = False
) -> None:
    """Draw a picture and write it to a PNG file. The same picture has the same bytes.

    `fill` draws into a matplotlib Figure of a size in inches. Raises OutputError where it cannot be
    written.
    """
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    settings: Any = {"font.size": 10.0, "text.parse_math": False}
    data = io.BytesIO()
    # Not as the user has set matplotlib up, which would change the picture.
    with mpl.rc_context(mpl.rcParamsDefault), mpl.rc_context(settings):
        figure = Figure(figsize=size, dpi=DPI, layout="constrained")
        FigureCanvasAgg(figure)
        fill(figure)
        figure.savefig(data, format="png", metadata={"Software": SOFTWARE})
    with files.replacing(target, files.replace_any if overwrite else is_ours) as partial:
        partial.write_bytes(data.getvalue())


def plain(text: str, most: int = MAX_TEXT) -> str:
    """Text in characters that the font has: others would warn and be drawn as boxes."""
    return one_line(text).encode("latin-1", "replace").decode("latin-1")[:most]
