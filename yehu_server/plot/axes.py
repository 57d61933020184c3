"""What pictures are drawn into: axes and figures, the caller's or new ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from yehu_server.errors import ParameterError
from yehu_server.util.hints import require_package

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# A legend's place: above the axes, at the right.
ABOVE: Any = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "ncols": 5, "frameon": False}


def axes_of(ax: Any) -> Axes:
    """Return the axes to draw into: those given, or matplotlib's current ones.

    Raises ParameterError where matplotlib is missing, or `ax` is something else.
    """
    require_package("matplotlib", "yehu.plot", "plots")
    from matplotlib.axes import Axes

    if ax is None:
        import matplotlib.pyplot as plt

        if not plt.get_fignums():
            plt.figure(layout="constrained")  # with room for a legend beside the axes
        return plt.gca()
    if not isinstance(ax, Axes):
        raise ParameterError(f"ax: expected axes of matplotlib, not {type(ax).__name__}")
    return ax


def figure_of(figure: Figure | None, width: float, height: float) -> Figure:
    """Return the figure to draw into: that given, or a new one of a size in inches.

    Raises ParameterError where matplotlib is missing.
    """
    require_package("matplotlib", "yehu.plot", "plots")
    if figure is not None:
        return figure
    import matplotlib.pyplot as plt

    return plt.figure(figsize=(width, height), layout="constrained")
