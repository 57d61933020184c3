"""The axes that a picture is drawn into."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from yehu_server.errors import ParameterError

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def check_matplotlib(what: str) -> None:
    """Check that pictures can be drawn.

    Parameters
    ----------
    what : str
        What needs them, for the message.

    Raises
    ------
    ParameterError
        Where matplotlib is missing.
    """
    try:
        import matplotlib as mpl  # noqa: F401
    except ImportError:
        raise ParameterError(
            f"{what} needs matplotlib: install yehu-server[plots], the extra for pictures"
        ) from None


def axes_of(ax: Any) -> Axes:
    """Return the axes to draw into: those given, or matplotlib's current ones.

    Raises
    ------
    ParameterError
        Where matplotlib is missing, or `ax` is something else.
    """
    check_matplotlib("yehu.plot")
    from matplotlib.axes import Axes

    if ax is None:
        import matplotlib.pyplot as plt

        return plt.gca()
    if not isinstance(ax, Axes):
        raise ParameterError(f"ax: expected axes of matplotlib, not {type(ax).__name__}")
    return ax
