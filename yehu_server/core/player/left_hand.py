"""The left hand: four fingers that stop the strings, step, slide and press. Compiled.

A step puts the next finger down while the one before still holds, and then lifts that, so that
the string is never open in between. A slide moves the finger that is down. A shift is a slide of
a light finger to another place, on either string, while the bow is off.
"""

from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player.fingering import OPEN
from yehu_server.core.player.harmonics import NONE, TOUCH_N
from yehu_server.core.player.ownership import move_parameter, take_back
from yehu_server.core.player.parameter_indices import (
    FINGER_COUNT,
    FINGER_POSITION,
    FINGER_PRESS,
    PLAYING,
    SLOT_OF,
)
from yehu_server.core.player.phrasing import SHIFT, STEP_MS, varied_landing

# Ramps of finger force. Chosen by trying landings of 1 to 5 ms and lifts of 3 to 25 ms on 24 steps
# up and down both strings; half of these are within 10 cents of their pitch after 21 ms
# (scripts/playability.py legato tries more).
LANDING_MS, LIFTING_MS = 3.0, 5.0
# A position nearer than this is reached by a slide, as no second finger fits beside the first.
MIN_STEP = 2e-3  # m
SETTLING_MS = 8.0
# A finger that lands while the bow changes strings: it stops both, and would strike the one left.
CROSSING_LANDING_MS = 10.0
# A finger bends both strings. Where its place changes under its full force, the one that is not
# bowed rings: at a shift of 5 semitones in 12 ms as loud as the note (-21 dB), so at -40.
SHIFTING_MS, SHIFT_N, EASING_MS = 15.0, 0.4, 3.0
# A finger that is lifted for an open string while the bow is off: tried at 0.5 to 25 ms.
OPENING_MS = 2.0


@compiled_exactly
def side_of(p: Any) -> float:
    """The value of ``/bow/side`` that bows the string of the fingering; 0 without one."""
    if p.string < 0:
        return 0.0
    return 1.0 if p.string == 0 else -1.0


@compiled_exactly
def stop(p: Any, c: Any, string: int, position: float, least_press: float, slide_ms: float) -> None:
    """Stop a string at a position (m, or OPEN) with at least the force (N) that the pitch needs.

    The finger that is down slides there in a time; `phrasing.STEP_MS` for a step, `SHIFT` for a
    shift. To another string it never slides under force, but steps.
    """
    p.is_shifting = 0
    before = OPEN if p.string < 0 else p.position
    landing_ms = LANDING_MS
    if string != p.string:
        slide_ms = SHIFT if slide_ms == SHIFT else STEP_MS
        landing_ms = LANDING_MS if p.string < 0 else CROSSING_LANDING_MS
    p.string, p.position = string, position
    if position == OPEN:
        press(p, c, least_press, OPENING_MS if slide_ms == SHIFT else LIFTING_MS)
        return
    if before == OPEN:
        land(p, c, position)
        press(p, c, least_press, landing_ms)
        return
    if slide_ms < 0.0 and abs(position - before) < MIN_STEP:
        slide_ms = SETTLING_MS
    if slide_ms == SHIFT:
        shift(p, c, position, least_press)
        return
    if slide_ms >= 0.0:
        move_parameter(p, c, FINGER_POSITION[p.finger], position, slide_ms)
        press(p, c, least_press, landing_ms)
        return
    land(p, c, position)
    press(p, c, least_press, landing_ms)
    for finger in range(FINGER_COUNT):  # all, since a direct write may have put others down
        if finger != p.finger:
            move_parameter(p, c, FINGER_PRESS[finger], 0.0, LIFTING_MS)


@compiled_exactly
def shift(p: Any, c: Any, position: float, least_press: float) -> None:
    """Slide the finger to a position (m) with little force; `end_shift` presses it there."""
    p.is_shifting = 1
    p.pressing = max(p.value[PLAYING.press], least_press)
    move_parameter(p, c, FINGER_POSITION[p.finger], position, SHIFTING_MS)
    move_parameter(p, c, FINGER_PRESS[p.finger], min(SHIFT_N, p.pressing), EASING_MS)


@compiled_exactly
def end_shift(p: Any, c: Any) -> None:
    """Press a finger that has come to its place."""
    if p.is_shifting != 0 and c.remaining[SLOT_OF[FINGER_POSITION[p.finger]]] == 0:
        p.is_shifting = 0
        move_parameter(p, c, FINGER_PRESS[p.finger], p.pressing, LANDING_MS)


@compiled_exactly
def press(p: Any, c: Any, least_press: float, moving_ms: float) -> None:
    """Set the requested finger force in a time (ms), or lift the finger from an open string."""
    force = 0.0
    if p.string >= 0 and p.position != OPEN:
        force = max(p.value[PLAYING.press], least_press) if p.gesture.node == NONE else TOUCH_N
    if force != p.pressing or force > 0.0:
        if p.pressing == 0.0:
            moving_ms = varied_landing(p, moving_ms)
        move_parameter(p, c, FINGER_PRESS[p.finger], force, moving_ms)
    p.pressing = force


@compiled_exactly
def lift_all(p: Any, c: Any) -> None:
    """Lift all fingers, also those that a direct write put down."""
    p.string, p.position, p.pressing, p.is_shifting = -1, OPEN, 0.0, 0
    for finger in range(FINGER_COUNT):
        take_back(p, FINGER_PRESS[finger])
        move_parameter(p, c, FINGER_PRESS[finger], 0.0, LIFTING_MS)


@compiled_exactly
def land(p: Any, c: Any, position: float) -> None:
    """Put the next finger over a position (m)."""
    p.finger = (p.finger + 1) % FINGER_COUNT
    p.pressing = 0.0
    move_parameter(p, c, FINGER_POSITION[p.finger], position, 0.0)
