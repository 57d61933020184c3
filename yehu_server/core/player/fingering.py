"""The string and finger position for a pitch. Compiled."""

from __future__ import annotations

from enum import Enum
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.calibration import OPEN_NOTES
from yehu_server.core.player.ear import learnt_cents
from yehu_server.core.player.intonation import position_of
from yehu_server.core.player.rows import STRING

LOWEST_NOTE, HIGHEST_NOTE = 65, 89  # F4 to F6
# Semitones around an open string that are played without a finger: no finger fits nearer to the
# loop than 8 mm, which is this interval.
OPEN_WITHIN = 0.45
ON_PITCH_WITHIN = 0.05
# Above this pitch notes on the F string jump and scratch: bowed at four speeds and three pressures,
# F5 and G5 hold in at most a third of the cases, notes up to E5 in at least four fifths.
HIGHEST_ON_F = 76.5
FIRST_OPEN, SECOND_OPEN = (float(note) for note in OPEN_NOTES)
OPEN = -1.0  # the position of a finger that is up


class OpenStrings(Enum):
    """When the C string is played open; the F string is, wherever no finger fits."""

    ALWAYS = "always"  # wherever no finger fits on the C string
    ON_PITCH = "on-pitch"
    NEVER = "never"


OPEN_FOR = np.array([OPEN_WITHIN, ON_PITCH_WITHIN, 0.0])  # semitones, for each of OpenStrings


@compiled_exactly
def wished_string(p: Any) -> int:
    """The string wished for, 0 or 1; -1 for either."""
    return int(np.rint(p.value[STRING])) - 1


@compiled_exactly
def choose(p: Any, pitch: float, speed: float) -> tuple[int, float]:
    """Choose the fingering of a pitch (fractional MIDI note) at a bow speed (m/s).

    Below C5 it is on the F string; from C5 up on the C string, unless the finger is on the F
    string and nearer to the pitch there, up to HIGHEST_ON_F. A string that is wished for is
    taken wherever it has the pitch.

    Returns
    -------
    string : int
        0 (F4) or 1 (C5).
    position : float
        Of the finger (m), or OPEN.
    """
    wish = wished_string(p)
    if pitch < FIRST_OPEN + OPEN_WITHIN:
        return 0, OPEN  # the lowest note of the instrument
    if wish == 0:
        return 0, learnt_position(p, 0, pitch, speed)
    if abs(pitch - SECOND_OPEN) < OPEN_FOR[p.open_strings]:
        return 1, OPEN
    if pitch < SECOND_OPEN + OPEN_WITHIN:
        return 0, learnt_position(p, 0, pitch, speed)
    near = learnt_position(p, 1, pitch, speed)
    if wish == 1 or p.string != 0 or p.position == OPEN or pitch > HIGHEST_ON_F:
        return 1, near
    far = learnt_position(p, 0, pitch, speed)
    if abs(far - p.position) < abs(near - p.position):
        return 0, far
    return 1, near


@compiled_exactly
def stay(p: Any, pitch: float, speed: float) -> tuple[int, float]:
    """Follow a bent pitch on the string that sounds, as far as that has it.

    Below the open C string it changes to the F string, and above HIGHEST_ON_F to the C string,
    unless the F string is wished for. Returns as `choose` does.
    """
    wish = wished_string(p)
    string = p.string if wish < 0 else wish
    open_note = SECOND_OPEN if string == 1 else FIRST_OPEN
    if pitch < FIRST_OPEN:
        return 0, OPEN
    if abs(pitch - open_note) < OPEN_WITHIN:
        return string, OPEN
    if string == 0 and pitch > HIGHEST_ON_F and wish != 0:
        string = 1
    if string == 1 and pitch <= SECOND_OPEN:
        string = 0
    if string != p.string:
        return string, learnt_position(p, string, pitch, speed)
    return string, position_of(p, string, pitch, speed, p.sharper)


@compiled_exactly
def stay_for_slide(p: Any, pitch: float, aim: float, speed: float) -> tuple[int, float]:
    """The fingering of a pitch from which the finger slides to another, on one string if it can.

    Returns as `choose` does.
    """
    low, high = min(pitch, aim), max(pitch, aim)
    if low < SECOND_OPEN + OPEN_WITHIN and high <= HIGHEST_ON_F and wished_string(p) != 1:
        return 0, OPEN if pitch < FIRST_OPEN + OPEN_WITHIN else learnt_position(p, 0, pitch, speed)
    if low > SECOND_OPEN and pitch > SECOND_OPEN + OPEN_WITHIN and wished_string(p) != 0:
        return 1, learnt_position(p, 1, pitch, speed)
    return stay(p, pitch, speed)


@compiled_exactly
def learnt_position(p: Any, string: int, pitch: float, speed: float) -> float:
    """Finger position (m) for a pitch, with what the ear has learnt of it."""
    return position_of(p, string, pitch, speed, learnt_cents(p, string, pitch))
