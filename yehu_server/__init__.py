"""A virtual yehu: its strings, bow, finger and body simulated; played by MIDI, OSC and Python.

``import yehu_server as yehu`` gives the public names in `__all__`; docs/python.md describes them.
They are stable under semantic versioning. All else is internal. Nothing is loaded before it is
used: neither numba nor numpy nor matplotlib.

Examples
--------
>>> import yehu_server as yehu
>>> tune = yehu.render([("F4", 0.0, 0.5), ("A4", 0.5, 0.5)])
>>> tune.sound.shape[1], tune.sample_rate
(2, 44100)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from yehu_server.util import __version__

if TYPE_CHECKING:
    from yehu_server import plot
    from yehu_server.api.followed import Followed, follow
    from yehu_server.api.instrument import Instrument
    from yehu_server.api.notes import Note
    from yehu_server.api.playback import AudioWidget, play
    from yehu_server.api.rendered import Rendering, render
    from yehu_server.api.simulated import Simulation, simulate
    from yehu_server.errors import YehuError
    from yehu_server.laboratory import Comparison, Sweep, body, compare, sweep

__all__ = [
    "AudioWidget",
    "Comparison",
    "Followed",
    "Instrument",
    "Note",
    "Rendering",
    "Simulation",
    "Sweep",
    "YehuError",
    "__version__",
    "body",
    "compare",
    "follow",
    "play",
    "plot",
    "render",
    "simulate",
    "sweep",
]

_MODULES = {
    "AudioWidget": "api.playback",
    "Comparison": "laboratory",
    "Followed": "api.followed",
    "Instrument": "api.instrument",
    "Note": "api.notes",
    "Player": "api.playback",  # what AudioWidget was called before
    "Rendering": "api.rendered",
    "Simulation": "api.simulated",
    "Sweep": "laboratory",
    "YehuError": "errors",
    "body": "laboratory",
    "compare": "laboratory",
    "follow": "api.followed",
    "play": "api.playback",
    "plot": "plot",
    "render": "api.rendered",
    "simulate": "api.simulated",
    "sweep": "laboratory",
}


def __getattr__(name: str) -> Any:
    """Load a public name at its first use."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"{__name__}.{_MODULES[name]}")
    value = module if name == "plot" else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names."""
    return sorted(__all__)
