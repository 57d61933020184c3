"""Direct bowing: whoever plays draws the bow and slides the finger, without notes. Compiled."""

from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player import left_hand
from yehu_server.core.player.fingering import choose
from yehu_server.core.player.left_hand import side_of
from yehu_server.core.player.notes import BEND_RAMP_MS, follow_bend, set_loudness_balance
from yehu_server.core.player.ownership import (
    DEFAULT_RAMP_MS,
    ramp_to,
    take_all_back,
    write_directly,
)
from yehu_server.core.player.parameter_indices import BOW, PLAYING
from yehu_server.core.player.right_hand import requested_speed


@compiled_exactly
def slide(p: Any, c: Any, pitch: float) -> None:
    """Slide the finger to a pitch within range; in silence, it waits there for the bow."""
    if p.sounding >= 0:
        p.held_pitch[p.sounding] = pitch
        follow_bend(p, c)
        return
    p.finger_pitch = pitch
    string, position = choose(p, pitch, False, False, requested_speed(p))
    left_hand.stop(p, c, string, position, 0.0, BEND_RAMP_MS)
    if p.is_direct != 0:
        ramp_to(p, c, BOW.side, side_of(p), DEFAULT_RAMP_MS)
        set_loudness_balance(p, c)


@compiled_exactly
def draw(p: Any, c: Any, speed: float, force: float) -> None:
    """Draw the bow at a speed (m/s) and force (N), on the string of the fingering.

    Takes the bow over as direct writes do; 0 and 0 lift it.
    """
    write_directly(p, c, BOW.speed, speed, False)
    write_directly(p, c, BOW.force, force, False)
    p.is_direct = 1 if speed != 0.0 or force != 0.0 else 0
    side = 0.0
    if p.is_direct != 0:
        side = 1.0 if p.string < 0 else side_of(p)
    write_directly(p, c, BOW.side, side, False)
    p.speed = abs(speed)
    p.effort = force * p.value[PLAYING.bow_position] / c.schelleng[max(p.string, 0)]
    set_loudness_balance(p, c)


@compiled_exactly
def lift(p: Any, c: Any) -> None:
    """Lift a bow drawn directly, and return it to the player."""
    if p.is_direct != 0:
        ramp_to(p, c, BOW.speed, 0.0, DEFAULT_RAMP_MS)
        ramp_to(p, c, BOW.side, 0.0, DEFAULT_RAMP_MS)
    take_all_back(p)
    p.is_direct = 0
