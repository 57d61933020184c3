"""Corrects the finger's place by the pitch that is heard, and remembers the correction. Compiled.

What is corrected is the sharpening: how much sharper the string sounds than the tables say. It is
learnt for each string, pitch, place and speed of the bow, as long as the program runs.
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.ear import PITCH_CERTAINTY, learning_bin, learnt_cents
from yehu_server.core.player.intonation import position_of
from yehu_server.core.player.ownership import move_parameter
from yehu_server.core.player.parameter_indices import FINGER_POSITION, PLAYING
from yehu_server.core.player.right_hand import requested_speed

# Parts of an error that are corrected in a second: of a small error (cents), of a large one. Some
# pitches swing about their place some eleven times a second, E5 above all: a quick hand would make
# that last.
SMALL_ERROR_PER_S, LARGE_ERROR_PER_S, SMALL_CENTS, LARGE_CENTS = 2.5, 12.0, 4.0, 10.0
# A pitch that is off by FAR_CENTS for JUMP_HOPS hops, and then on the other side, has jumped; after
# MAX_JUMPS the finger rests.
FAR_CENTS, JUMP_HOPS, MAX_JUMPS = 2.5, 16, 2
MOVED_CENTS = 8.0  # the same under a bow arm that moves, which moves the pitch
MAX_CENTS = 100.0  # of all corrections
TOLERANCE_CENTS = 0.3  # nearer than this the finger rests
# A pitch that follows the finger needs a correction as large as its first error. Beyond this part
# of it, and so many cents, it doesn't follow: it is locked to the body or to the other string.
MAX_ERROR_RATIO, MAX_ERROR_CENTS = 1.5, 15.0
MIN_SLIPS, MAX_SLIPS = 0.5, 1.6  # in a period, of a string that sounds its note


@compiled_exactly
def begin_tuning(p: Any, pitch: float) -> None:
    """Begin a note with what was learnt of it."""
    p.sharper = learnt_cents(p, p.string, pitch)
    p.first_error, p.first_press = math.nan, p.value[PLAYING.press]
    p.jumps, p.side_heard, p.times_heard = 0, 0, 0


@compiled_exactly
def tune(p: Any, c: Any, pitch: float) -> None:
    """Correct the finger by what is heard of the sounding pitch, where that is sure."""
    ear = p.ear
    if ear.certainty < PITCH_CERTAINTY or not MIN_SLIPS < ear.slips < MAX_SLIPS or p.position < 0.0:
        return
    finger = FINGER_POSITION[p.finger]
    if p.taken[finger] != 0 or p.is_held[finger] != 0:
        return
    if p.value[PLAYING.press] != p.first_press:  # a finger that presses harder is to be heard
        return
    row, position_bin, speed_bin = learning_bin(p, p.string, pitch)
    if math.isnan(p.first_error):
        p.first_error, p.first_sharper = ear.error, p.sharper
    if abs(p.sharper - p.first_sharper) > MAX_ERROR_RATIO * abs(p.first_error) + MAX_ERROR_CENTS:
        p.sharper = p.learnt[p.string, row, position_bin, speed_bin] = p.first_sharper
        p.first_error = math.inf  # no more in this note: the pitch does not follow the finger
        place_finger(p, c, pitch)
        return
    if math.isinf(p.first_error):
        return
    uncorrected = ear.error + p.sharper
    wanted = p.value[PLAYING.listening] * uncorrected - p.sharper
    if jumps(p, wanted) >= MAX_JUMPS:
        p.first_error = math.inf
        return
    if abs(wanted) > TOLERANCE_CENTS:
        large = (abs(wanted) - SMALL_CENTS) / (LARGE_CENTS - SMALL_CENTS)
        rate = SMALL_ERROR_PER_S + (LARGE_ERROR_PER_S - SMALL_ERROR_PER_S) * min(
            max(large, 0.0), 1.0
        )
        p.sharper += rate * wanted * ear.hop / p.rate
        p.sharper = min(max(p.sharper, -MAX_CENTS), MAX_CENTS)
        place_finger(p, c, pitch)
    p.learnt[p.string, row, position_bin, speed_bin] = p.sharper


@compiled_exactly
def jumps(p: Any, wanted: float) -> int:
    """How often the pitch has jumped over its place in this note, from far on one side.

    Between two such places the finger would go to and fro for ever.
    """
    if abs(wanted) > (FAR_CENTS if p.value[PLAYING.phrasing] == 0.0 else MOVED_CENTS):
        side = 1 if wanted > 0.0 else -1
        if side == p.side_heard:
            p.times_heard += 1
        else:
            p.jumps += 1 if p.times_heard >= JUMP_HOPS else 0
            p.side_heard, p.times_heard = side, 1
    return int(p.jumps)


@compiled_exactly
def place_finger(p: Any, c: Any, pitch: float) -> None:
    """Move the finger that is down to where the corrected pitch is."""
    p.position = position_of(p, p.string, pitch, requested_speed(p), p.sharper)
    move_parameter(p, c, FINGER_POSITION[p.finger], p.position, 1e3 * p.ear.hop / p.rate)
