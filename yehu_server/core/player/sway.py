"""How a player sways, and the fiddle with the player: two angles that go their own ways. Compiled.

Each wanders slowly, as musicians sway [Spielbewegungen], and both swing with the strokes, to one
side in a down-bow and back in an up-bow; a slurred note goes back, too. `/body/sway` says how far,
`/playing/variation` 0 keeps the player still, and `/engine/seed` says which way. Where no note
sounds the player stays. What the angles do to the sound: ``physics.lobes``.
"""

from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.physics.elementary import tanh
from yehu_server.core.physics.lobes import DIRECTIONS
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.core.player.stroke_contours import (
    CONTOURS_FROM,
    SEGMENT,
    follow,
    go,
    next_chance,
    next_deviate,
)

# The sizes below are those at this sway and variation, whatever the defaults are. By ear, and by
# how far partials move in recordings (scripts/liveliness.py).
USUAL_SWAY, USUAL_VARIATION = 0.5, 0.25
WANDERS = 0.85  # standard deviation of the wandering
SHORTEST_S, LONGEST_S = 0.45, 1.1  # from one side to the other
STROKE, UNEVEN = np.array((1.0, -0.85)), 0.5  # of a stroke of WHOLE_S; their standard deviation
WHOLE_S, OPEN_S = 0.5, 0.7  # a note of unknown length swings in the latter
BACK = 0.9  # of the last swing, in a slurred note
FARTHEST = 1.2  # of the measured sound's amplitude
SWAY_FROM = CONTOURS_FROM + (1 << 29)  # of the seed's numbers

SWAY_STATE = np.dtype(
    [
        ("wander", SEGMENT, DIRECTIONS),
        ("stroke", SEGMENT, DIRECTIONS),
        ("side", np.float64),  # to which the last note swung: 1, -1, or BACK of it
        ("time_s", np.float64),  # in which notes sounded
        ("random_count", np.int64),
    ],
    align=True,
)


@compiled_exactly
def swing(p: Any, is_slur: bool) -> None:
    """Begin to swing with a note."""
    s = p.sway
    known_s = p.value[PLAYING.note_length]
    size = min(known_s / WHOLE_S, 1.0) if known_s > 0.0 else 1.0
    s.side = -BACK * s.side if is_slur else p.direction
    lasts = known_s if known_s > 0.0 else OPEN_S
    for k in range(DIRECTIONS):
        to = size * s.side * STROKE[k] * (1.0 + UNEVEN * next_deviate(p, s, SWAY_FROM))
        go(s.stroke[k], to, s.time_s, lasts)


@compiled_exactly
def advance_sway(p: Any, c: Any) -> None:
    """Let the controls turn the body to where the player sways in one hop."""
    s, hop_s = p.sway, p.ear.hop / p.rate
    amount = (
        c.value[SLOTS.body_sway]
        / USUAL_SWAY
        * min(p.value[PLAYING.variation] / USUAL_VARIATION, 1.0)
    )
    is_moving = p.sounding >= 0
    if is_moving:
        s.time_s += hop_s
    for k in range(DIRECTIONS):
        w = s.wander[k]
        if is_moving:
            if s.time_s >= w.begins + w.lasts:
                share = 0.5 * (1.0 + next_chance(p, s, SWAY_FROM))
                lasts = SHORTEST_S + (LONGEST_S - SHORTEST_S) * share
                go(w, WANDERS * next_deviate(p, s, SWAY_FROM), s.time_s, lasts)
            follow(w, s.time_s)
            follow(s.stroke[k], s.time_s)
        to = amount * (w.now + s.stroke[k].now)
        to = FARTHEST * tanh(to / FARTHEST)
        c.turned_slope[k] = (to - c.turned[k]) / p.ear.hop if is_moving else 0.0
        if c.turned_slope[k] != 0.0:
            c.drifting = 1
