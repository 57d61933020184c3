"""Strokes of a bow that has a length: planned, and reversed before its ends. Compiled.

A stroke whose note needs more hair than is left is drawn more slowly; where that is not enough, it
goes the other way. In a rest the bow is lifted, and set down where the next stroke wants it. A bow
that still reaches its end changes direction there. The strokes of a tremolo are not planned here:
their rate is in ``params.articulations``.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.parameter_indices import BOW, PLAYING

USUAL_S = 0.4  # a note lasts, where nothing says so
MIN_SPEED_FACTOR = 0.6  # factor on the speed of a bow that has to last
END_FRACTION = 0.04  # part of the bow at either end that strokes don't begin or end on
RESTART_FRACTION = 0.15  # behind a stroke that begins after a rest: hair to go back on
CHANGE_MS = 28.0  # time in which a bow changes its direction within a note


@compiled_exactly
def hair_left(p: Any, c: Any, direction: float) -> float:
    """Hair (m) that is left for a stroke in a direction."""
    length = p.value[PLAYING.bow_length]
    left = length - c.bow_displacement if direction > 0.0 else c.bow_displacement
    return float(left - END_FRACTION * length)


@compiled_exactly
def plan_stroke(p: Any, c: Any, speed: float, is_slur: bool) -> bool:
    """Choose a note's direction, and a factor on its speed (m/s); return whether it turns."""
    before = p.direction
    command = np.rint(p.value[PLAYING.direction])
    if not is_slur:
        p.direction = command if command != 0.0 else -p.direction
    length = p.value[PLAYING.bow_length]
    p.stroke_speed_factor = 1.0
    if length == 0.0:
        return bool(p.direction != before)
    c.bow_displacement = min(max(c.bow_displacement, 0.0), length)
    is_known = p.value[PLAYING.note_length] > 0.0
    needed = speed * (p.value[PLAYING.note_length] if is_known else USUAL_S)
    if not is_slur and (p.side == 0.0 or command != 0.0):
        begin = (
            RESTART_FRACTION
            if needed < (1.0 - RESTART_FRACTION - END_FRACTION) * length
            else END_FRACTION
        )
        behind = length - hair_left(p, c, p.direction) - END_FRACTION * length
        if command != 0.0 or hair_left(p, c, p.direction) < needed or behind < begin * length:
            c.bow_displacement = length * (begin if p.direction > 0.0 else 1.0 - begin)
    left, other = hair_left(p, c, p.direction), hair_left(p, c, -p.direction)
    if left < MIN_SPEED_FACTOR * needed and left < other and command == 0.0:
        p.direction, left = -p.direction, other
    if is_known and left < needed:
        p.stroke_speed_factor = max(MIN_SPEED_FACTOR, left / needed)
    return bool(p.direction != before)


@compiled_exactly
def is_at_its_end(p: Any, c: Any, speed: float) -> bool:
    """Whether the bow has to turn now, at a speed (m/s), to turn before its end."""
    if p.side == 0.0 or p.value[PLAYING.bow_length] == 0.0:
        return False
    if p.taken[BOW.speed] != 0 or p.is_held[BOW.speed] != 0:
        return False
    return hair_left(p, c, p.direction) < 0.5e-3 * CHANGE_MS * speed
