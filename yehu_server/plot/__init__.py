"""Pictures of sounds, simulations and sweeps, for ``yehu.plot``.

Each function draws into the matplotlib axes `ax`, by default the current ones, and returns them;
`signals` makes a figure.
It needs matplotlib: ``pip install yehu-server[plots]``.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yehu_server.laboratory import guettler, regimes, schelleng
    from yehu_server.laboratory import sweep_map as sweep
    from yehu_server.plot.shapes import energy, signals, strings
    from yehu_server.plot.sounds import level, pitch, spectrogram

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

_MODULES = {
    "energy": "plot.shapes",
    "level": "plot.sounds",
    "pitch": "plot.sounds",
    "signals": "plot.shapes",
    "spectrogram": "plot.sounds",
    "strings": "plot.shapes",
}


def __getattr__(name: str) -> Any:
    """Load a function at its first use; the rest of the package needs none of them."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"yehu_server.{_MODULES.get(name, 'laboratory')}")
    return getattr(module, "sweep_map" if name == "sweep" else name)


def __dir__() -> list[str]:
    """The public names."""
    return sorted(__all__)
