"""The axes that a picture is drawn into; colours of the regimes and names of the axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from yehu_server.errors import ParameterError
from yehu_server.util.extras import need

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Told apart by eyes that confuse red and green, too.
COLOURS = {
    "unbowed": "#ffffff",
    "silent": "#e6e6e6",
    "helmholtz": "#2f8f5b",
    "multiple slip": "#a9d18e",
    "octave": "#3b7dd8",
    "anomalous low": "#f0a830",
    "raucous": "#b5402a",
    "aperiodic": "#5a4a6f",
}
ABOVE: Any = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "ncols": 5, "frameon": False}
LABELS = {
    "force": "bow force, N",
    "position": "bow position β",
    "speed": "bow speed, m/s",
    "acceleration": "acceleration of the bow, m/s²",
    "note": "MIDI note",
    "press": "finger force, N",
    "place": "place of the finger, cents above the note",
    "tension": "tension of the string, factor",
    "noise": "noise of the hair",
    "bow_force": "bow force, N",
    "bow_velocity": "bow speed, m/s",
    "bow_position": "bow position, m from the loop",
    "bow_acceleration": "acceleration of the bow, m/s²",
    "press_force": "finger force, N",
    "finger_position": "finger position, m from the loop",
}


def axes_of(ax: Any) -> Axes:
    """Return the axes to draw into: those given, or matplotlib's current ones.

    Raises
    ------
    ParameterError
        Where matplotlib is missing, or `ax` is something else.
    """
    need("matplotlib", "yehu.plot", "plots")
    from matplotlib.axes import Axes

    if ax is None:
        import matplotlib.pyplot as plt

        return plt.gca()
    if not isinstance(ax, Axes):
        raise ParameterError(f"ax: expected axes of matplotlib, not {type(ax).__name__}")
    return ax
