"""Pictures of sounds, simulations and sweeps, for ``yehu.plot``.

Each function draws into the matplotlib axes `ax`, by default the current ones, and returns them;
`signals` makes a figure.
It needs matplotlib: ``pip install yehu-server[plots]``.
"""

from yehu_server.lab.plot.shapes import energy, signals, strings
from yehu_server.lab.plot.sounds import level, pitch, spectrogram
from yehu_server.lab.plot.sweep_maps import guettler, regimes, schelleng, sweep

__all__ = [
    "energy",
    "guettler",
    "level",
    "pitch",
    "regimes",
    "schelleng",
    "signals",
    "spectrogram",
    "strings",
    "sweep",
]
