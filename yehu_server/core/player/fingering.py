"""The string and finger position for a pitch. Compiled."""

from enum import Enum
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.ear import learnt_cents
from yehu_server.core.player.intonation import position_of
from yehu_server.core.player.parameter_indices import PLAYING

# Semitones around an open string that are played without a finger: no finger fits nearer to the
# loop than 8 mm, which is this interval.
OPEN_WITHIN = 0.45
ON_PITCH_WITHIN = 0.05
OPEN = -1.0  # the position of a finger that is up


class OpenStrings(Enum):
    """When the outer string is played open; the inner is, wherever no finger fits."""

    ALWAYS = "always"  # wherever no finger fits on the outer string
    ON_PITCH = "on-pitch"
    NEVER = "never"


OPEN_FOR = np.array([OPEN_WITHIN, ON_PITCH_WITHIN, 0.0])  # semitones, for each of OpenStrings


@compiled_exactly
def requested_string(p: Any) -> int:
    """The string asked for, 0 or 1; -1 for either."""
    return int(np.rint(p.value[PLAYING.string])) - 1


@compiled_exactly
def choose(p: Any, pitch: float, beats: bool, shakes: bool, speed: float) -> tuple[int, float]:
    """Choose the string and the finger's position (m, or OPEN) of a pitch at a bow speed (m/s).

    Below the open outer string it is on the inner one; from there up on the outer, unless the
    finger is on the inner string and nearer to the pitch there, as far as that is stopped. A string
    that is asked for is taken wherever it has the pitch. Where a finger `beats` above it, as in a
    trill, the inner string is too short there; where it `shakes`, in a vibrato, the open string is
    stopped on the other.
    """
    command = requested_string(p)
    if pitch < p.open_note[0] + OPEN_WITHIN:
        return 0, OPEN  # the lowest note of the instrument
    if command == 0:
        return 0, learnt_position(p, 0, pitch, speed)
    is_open = abs(pitch - p.open_note[1]) < OPEN_FOR[p.open_strings]
    if is_open and (command == 1 or not shakes):
        return 1, OPEN
    if pitch < p.open_note[1] + OPEN_WITHIN:
        return 0, learnt_position(p, 0, pitch, speed)
    near = learnt_position(p, 1, pitch, speed)
    if command == 1 or p.string != 0 or p.position == OPEN or beats or pitch > p.highest[0]:
        return 1, near
    far = learnt_position(p, 0, pitch, speed)
    if abs(far - p.position) < abs(near - p.position):
        return 0, far
    return 1, near


@compiled_exactly
def stay(p: Any, pitch: float, steps: bool, speed: float) -> tuple[int, float]:
    """Follow a bent pitch on the string that sounds, as far as that has it.

    Where the outer string has no finger it changes to the inner one, and above where that is
    stopped to the outer, unless the inner is asked for. An open string stays open within
    OPEN_WITHIN, and is again where the finger `steps` and does not slide. Returns as `choose` does.
    """
    command = requested_string(p)
    string = p.string if command < 0 else command
    if pitch < p.open_note[0]:
        return 0, OPEN
    may_be_open = string == 0 or p.position == OPEN or steps
    if abs(pitch - p.open_note[string]) < OPEN_WITHIN and may_be_open:
        return string, OPEN
    if string == 0 and pitch > p.highest[0] and command != 0:
        string = 1
    if string == 1 and pitch < p.open_note[1] + OPEN_WITHIN:
        string = 0
    if string != p.string:
        return string, learnt_position(p, string, pitch, speed)
    return string, position_of(p, string, pitch, speed, p.sharper)


@compiled_exactly
def choose_for_slide(
    p: Any, pitch: float, low: float, high: float, speed: float, is_new: bool
) -> tuple[int, float]:
    """The fingering of a pitch where the finger slides between two others, on one string if it can.

    If it cannot, a note that is new is fingered as without a slide; else the finger goes on from
    where it is. Returns as `choose` does.
    """
    first, second = p.open_note[0], p.open_note[1]
    if low < second + OPEN_WITHIN and high <= p.highest[0] and requested_string(p) != 1:
        return 0, OPEN if pitch < first + OPEN_WITHIN else learnt_position(p, 0, pitch, speed)
    if low > second and pitch > second + OPEN_WITHIN and requested_string(p) != 0:
        return 1, learnt_position(p, 1, pitch, speed)
    return choose(p, pitch, False, False, speed) if is_new else stay(p, pitch, False, speed)


@compiled_exactly
def learnt_position(p: Any, string: int, pitch: float, speed: float) -> float:
    """Finger position (m) for a pitch, with what the ear has learnt of it."""
    return position_of(p, string, pitch, speed, learnt_cents(p, string, pitch))
