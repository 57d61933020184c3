"""Tables: what files say of playing, as numbers: a mapping, a tuning, a range, presets.

All are float64, so that any program can write them; ``playing.tables`` does for files. Code of
sources and curves are below.
"""

from typing import Annotated, Any

import numpy as np

from yehu_server.core.player.note_range import YEHU
from yehu_server.core.player.parameter_indices import PARAMETER_COUNT
from yehu_server.params.table import TABLE

MAX_BINDS, MAX_POINTS = 256, 2048
KEY_COUNT = 128
PROGRAM_COUNT = 128
TABLE_SLOTS = 3  # tables of a part: those in use, those that are next, those that are written

# Sources: a control change is its number, a pair of 14 bits PAIR + its coarse half, a
# non-registered parameter NRPN + its number, a named control CONTROL + its number.
PAIR, BEND, PRESSURE, POLY_PRESSURE, VELOCITY, NOTE, NRPN, CONTROL = (
    128, 200, 201, 202, 203, 204, 1000, 100_000,
)  # fmt: skip
LINEAR, EXPONENTIAL, S, POINTS = range(4)  # curves
TRANSPOSE, CLAMP, SKIP = range(3)  # what happens to notes out of range

TABLES = np.dtype(
    [
        # Binds, in order.
        ("binds", np.float64),
        ("source", np.float64, MAX_BINDS),
        ("first", np.float64, MAX_BINDS),  # number of the first bind of the same source
        ("target", np.float64, MAX_BINDS),  # index of a parameter
        ("lo", np.float64, MAX_BINDS),  # the target's values at the ends of the span
        ("hi", np.float64, MAX_BINDS),
        ("curve", np.float64, MAX_BINDS),
        ("first_point", np.float64, MAX_BINDS),
        ("points", np.float64, MAX_BINDS),
        ("invert", np.float64, MAX_BINDS),
        ("smoothing_ms", np.float64, MAX_BINDS),
        ("channels", np.float64, MAX_BINDS),  # a bit for each that it receives; 0: all
        ("soft", np.float64, MAX_BINDS),
        ("by_range", np.float64, MAX_BINDS),  # 1: the bend range sets its span
        ("for_all", np.float64, MAX_BINDS),  # 1: it is global
        ("input_lo", np.float64, MAX_BINDS),
        ("input_hi", np.float64, MAX_BINDS),
        ("same", np.float64, MAX_BINDS),  # equal for equal binds, of other tables too
        ("x", np.float64, MAX_POINTS),  # of curves by points
        ("y", np.float64, MAX_POINTS),
        ("mpe", np.float64),  # 1: every port starts as an MPE zone
        ("first_switch", np.float64),  # lowest of the keys that choose an articulation; NaN: none
        # Start values, in order; and by index what the mapping starts with, or the default.
        ("starts", np.float64),
        ("start_row", np.float64, PARAMETER_COUNT),
        ("start_value", np.float64, PARAMETER_COUNT),
        ("usual", np.float64, PARAMETER_COUNT),
        # The tuning: pitches of keys, NaN for none; 1: each sounds its own number.
        ("is_equal", np.float64),
        ("pitch", np.float64, KEY_COUNT),
        # What happens to notes that the instrument does not have, and its lowest and highest.
        ("policy", np.float64),
        ("lowest", np.float64),
        ("highest", np.float64),
        # A bit for each channel that is received; -1: all except percussion.
        ("received", np.float64),
        # Values of presets by program, in order: indices, and NaN for the end.
        ("has_programs", np.float64),
        ("has_program", np.float64, PROGRAM_COUNT),
        ("program_row", np.float64, (PROGRAM_COUNT, PARAMETER_COUNT)),
        ("program_value", np.float64, (PROGRAM_COUNT, PARAMETER_COUNT)),
    ]
)
Tables = Annotated[Any, TABLES]


def plain_tables() -> Any:
    """Tables without binds, tuning or presets: ndarray [shape=(1,), dtype=TABLES]."""
    made = np.zeros(1, TABLES)
    made["usual"] = [param.default for param in TABLE]
    made["is_equal"], made["received"] = 1.0, -1.0
    made["lowest"], made["highest"] = YEHU.ends
    made["program_row"] = made["first_switch"] = np.nan
    return made
