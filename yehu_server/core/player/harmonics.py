"""Natural harmonics: a finger touches an open string at a node, the bow near the bridge. Compiled.

Those that speak, of a yehu, are in SPEAKING; of the third and fourth of the inner string, and the
fourth of the outer, others come. Measured (tests/scores/test_harmonics.py). A key is where the
finger touches: what a finger that presses there would sound.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import log2
from yehu_server.core.player.fingering import requested_string

# String, where the finger touches (semitones above the open string), and the parts that swing.
SPEAKING = ((0, 12.0, 2.0), (1, 12.0, 2.0), (1, 7.0, 3.0))
NODES = np.array(SPEAKING)
STRING_OF, TOUCHED, PARTS = range(3)
NONE = -1
SAME_PITCH = 0.3  # semitones
SOUNDING_FRACTION = 0.2986 / 0.3  # of the string up to the bridge, what swings
TOUCH_N = 0.02
HARMONIC_BOW_POSITION = 0.05  # of the bow: elsewhere F5 is 40 cents flat
# Those of the outer string are some 14 dB softer than the open string.
GAINS_DB = np.array((0.0, 10.0))


def sounding_above(parts: float) -> float:
    """The interval (semitones) from an open string to the harmonic of a number of parts."""
    return float(round(12.0 * log2(parts)))


@compiled_exactly
def string_of(node: int) -> int:
    """The string of a row of NODES."""
    return int(NODES[node, STRING_OF])


@compiled_exactly
def node_of(p: Any, pitch: float) -> int:
    """The row of NODES that a pitch (fractional MIDI note) is the touched note of, else NONE."""
    command = requested_string(p)
    for i in range(len(NODES)):
        string = string_of(i)
        above = pitch - p.open_note[string]
        if abs(above - NODES[i, TOUCHED]) <= SAME_PITCH and command in (NONE, string):
            return i
    return NONE


@compiled_exactly
def place_of(p: Any, node: int) -> float:
    """Where the finger touches (m)."""
    return float(SOUNDING_FRACTION * p.bridge_x / NODES[node, PARTS])
