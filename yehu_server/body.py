"""The body workshop, for ``yehu.body``: bodies as they are measured, fitted, drawn and played.

`load` gives the measured yehu's body, or that of a file; `read` and `fit` make one of taps or
responses (docs/body.md). It needs the extra ``yehu-server[body]``, and ``[plots]`` for pictures.
"""

from yehu_server.api.bodies import Body, fit, load
from yehu_server.lab.body import Curve, Modes, Tap, made_taps
from yehu_server.lab.body.measurement import Measurement, average, read

__all__ = [
    "Body",
    "Curve",
    "Measurement",
    "Modes",
    "Tap",
    "average",
    "fit",
    "load",
    "made_taps",
    "read",
]
