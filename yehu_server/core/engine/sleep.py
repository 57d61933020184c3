"""Sleep: an instrument at rest is not computed until something is asked of it. Compiled.

Windows of frames begin at fixed frames, whatever the blocks are. An instrument whose controls stood
still, and which was quiet for a whole window, falls asleep as the next one begins. Its model, its
controls and its filters stay as they are then, and its samples are zeros; a command wakes it at the
very frame that it is due, and it goes on from there. The player goes on meanwhile: its random
numbers are the same whether the instrument slept or not.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled
from yehu_server.core.physics.layout import (
    BRIDGE_FORCE_1,
    BRIDGE_FORCE_2,
    FINGER_PROBES,
    MAX_FINGERS,
    PRESSURE,
    PROBES_PER_FINGER,
)
from yehu_server.core.player.ear import EAR_SAMPLES

WINDOW = EAR_SAMPLES  # frames, so that the ear remembers nothing else; a power of two
# The most that each of WATCHED may change in a window, and that may be heard of them: Pa; N of each
# string on the bridge, which all that moves on the string moves; m of each finger. It is 106 dB
# below the threshold of hearing, and where gains of output and body are highest, 48 dB, half a step
# of 24 bits. Rounding alone makes 3e-12. A finger at rest pulls at the bridge, but evenly.
QUIET = 1e-10
WATCHED = np.array(
    [BRIDGE_FORCE_1, BRIDGE_FORCE_2, PRESSURE]
    + [FINGER_PROBES + PROBES_PER_FINGER * finger for finger in range(MAX_FINGERS)]
)

SLEEP = np.dtype(
    [
        ("is_asleep", np.int64),
        ("is_watched", np.int64),  # whether the controls stood still as this window began
        # In this window: the largest sample before its gain (Pa), the least and largest probes.
        ("loudest", np.float64),
        ("least", np.float64, len(WATCHED)),
        ("largest", np.float64, len(WATCHED)),
    ],
    align=True,
)


def wake_up(sleep: Any) -> None:
    """Let a record of dtype SLEEP be awake, in place."""
    sleep["is_asleep"] = sleep["is_watched"] = 0


@compiled
def watch(s: Any, probe: Any, sample: float) -> None:
    """Take a frame into the window: its probes, its sample before the gain. Real time: safe."""
    s.loudest = max(s.loudest, abs(sample))
    for k in range(len(WATCHED)):
        s.least[k] = min(s.least[k], probe[WATCHED[k]])
        s.largest[k] = max(s.largest[k], probe[WATCHED[k]])


@compiled
def begin_window(s: Any, is_still: bool) -> None:
    """Begin a window of an instrument that is awake, which may fall asleep. Real time: safe."""
    is_quiet = s.is_watched != 0 and is_still and s.loudest < QUIET
    for k in range(len(WATCHED)):
        is_quiet = is_quiet and s.largest[k] - s.least[k] < QUIET
        s.least[k], s.largest[k] = math.inf, -math.inf
    s.loudest = 0.0
    s.is_asleep = 1 if is_quiet else 0
    s.is_watched = 1 if is_still and not is_quiet else 0
