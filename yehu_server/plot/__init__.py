"""Pictures of sounds, simulations and sweeps, for ``yehu.plot``.

Each function draws into the matplotlib axes `ax`, by default the current ones, and returns them;
`signals` makes a figure.
It needs matplotlib: ``pip install yehu-server[plots]``.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yehu_server.laboratory import sweep_maps
    from yehu_server.plot.shapes import energy, signals, strings
    from yehu_server.plot.sounds import level, pitch, spectrogram

    guettler = sweep_maps.guettler
    regimes = sweep_maps.regimes
    schelleng = sweep_maps.schelleng
    sweep = sweep_maps.sweep

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

_OF_SIMULATIONS, _OF_SOUNDS = ("energy", "signals", "strings"), ("level", "pitch", "spectrogram")


def __getattr__(name: str) -> Any:
    """Load a function at its first use; the rest of the package needs none of them."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name in _OF_SIMULATIONS:
        module = import_module("yehu_server.plot.shapes")
    elif name in _OF_SOUNDS:
        module = import_module("yehu_server.plot.sounds")
    else:
        module = import_module("yehu_server.laboratory").sweep_maps
    return getattr(module, name)


def __dir__() -> list[str]:
    """The public names."""
    return sorted(__all__)
