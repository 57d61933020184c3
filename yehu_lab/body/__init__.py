"""The body workshop: from a force hammer's taps on a fiddle to a body that the model plays.

`read` takes measurements from files and `fit` makes a body of them. The libraries that this needs
come with the extra ``yehu-server[body]``, and are loaded when they are used.
"""

from yehu_lab.body.body_file import Fit
from yehu_lab.body.curve import Curve
from yehu_lab.body.fitting import fit
from yehu_lab.body.measurement import Measurement, average, read
from yehu_lab.body.modes import Modes
from yehu_lab.body.synthetic import made_taps
from yehu_lab.body.tap import Tap

__all__ = ["Curve", "Fit", "Measurement", "Modes", "Tap", "average", "fit", "made_taps", "read"]
