"""The laboratory's names in ``yehu`` and ``yehu.plot``, each loaded at its first use.

The one place of this package that knows the laboratory; its commands come by an entry point.
"""

from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from yehu_lab.api import body
    from yehu_lab.api.compared import Comparison, compare
    from yehu_lab.api.sweeps import Sweep, sweep
    from yehu_lab.plot.sweep_maps import guettler, regimes, schelleng
    from yehu_lab.plot.sweep_maps import sweep as sweep_map

__all__ = [
    "Comparison",
    "Sweep",
    "body",
    "compare",
    "guettler",
    "regimes",
    "schelleng",
    "sweep",
    "sweep_map",
]

_PLACES = {
    "Comparison": "yehu_lab.api.compared:Comparison",
    "Sweep": "yehu_lab.api.sweeps:Sweep",
    "body": "yehu_lab.api.body",
    "compare": "yehu_lab.api.compared:compare",
    "guettler": "yehu_lab.plot.sweep_maps:guettler",
    "regimes": "yehu_lab.plot.sweep_maps:regimes",
    "schelleng": "yehu_lab.plot.sweep_maps:schelleng",
    "sweep": "yehu_lab.api.sweeps:sweep",
    "sweep_map": "yehu_lab.plot.sweep_maps:sweep",
}


def __getattr__(name: str) -> Any:
    """Load a name at its first use."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return resolve_name(_PLACES[name])
