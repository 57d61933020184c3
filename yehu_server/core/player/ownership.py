"""Which parameters of bow and fingers the player may move. Compiled.

A direct write to a parameter marked ``player_controlled`` takes it over until the next note begins.
A parameter written with ``hold`` keeps its value, whatever notes and controllers do
(decisions/0006).
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.ramps import start_ramp
from yehu_server.core.player.parameter_indices import BOW, PARAMETER_COUNT, SLOT_OF, SMOOTH_MS

DEFAULT_RAMP_MS = -1.0  # a sentinel: the ramp time of the parameter itself


@compiled_exactly
def ramp_to(p: Any, c: Any, index: int, value: float, ramp_ms: float) -> None:
    """Move a parameter of the engine, whoever owns it; in `ramp_ms`, or DEFAULT_RAMP_MS."""
    ramp_ms = SMOOTH_MS[index] if ramp_ms < 0.0 else ramp_ms
    start_ramp(c, SLOT_OF[index], value, int(np.rint(ramp_ms * 1e-3 * p.rate)))


@compiled_exactly
def move_parameter(p: Any, c: Any, index: int, value: float, ramp_ms: float) -> None:
    """Move a parameter, unless it is taken over or already moving to this value."""
    if p.taken[index] != 0 or p.is_held[index] != 0 or p.sent[index] == value:
        return
    p.sent[index] = value
    ramp_ms = SMOOTH_MS[index] if ramp_ms < 0.0 else ramp_ms
    ramp_to(p, c, index, value, max(ramp_ms, p.glide_ms))


@compiled_exactly
def invalidate_sent(p: Any, index: int) -> None:
    """Forget the value last sent, so that the next move is sent in any case."""
    p.sent[index] = math.nan


@compiled_exactly
def write_directly(p: Any, c: Any, index: int, value: float, hold: bool) -> None:
    """Take a parameter over and move it; `hold` keeps it. Newtons are heard only without assist."""
    mark_taken(p, index, hold)
    if index == BOW.force:
        mark_taken(p, BOW.assist, hold)
        ramp_to(p, c, BOW.assist, 0.0, DEFAULT_RAMP_MS)
    ramp_to(p, c, index, value, DEFAULT_RAMP_MS)


@compiled_exactly
def mark_taken(p: Any, index: int, hold: bool) -> None:
    """Mark a parameter as taken over by a direct write, until the next note or as held."""
    if hold:
        p.is_held[index] = 1
    else:
        p.taken[index] = 1
    invalidate_sent(p, index)


@compiled_exactly
def take_back(p: Any, index: int) -> None:
    """Own a parameter again, unless it is held."""
    p.taken[index] = 0
    invalidate_sent(p, index)


@compiled_exactly
def take_all_back(p: Any) -> None:
    """Own all parameters again that are not held."""
    for index in range(PARAMETER_COUNT):
        p.taken[index] = 0


@compiled_exactly
def release(p: Any, keep_held: bool) -> None:
    """Own all parameters again, held ones too, unless they are kept."""
    take_all_back(p)
    if keep_held:
        return
    for index in range(PARAMETER_COUNT):
        p.is_held[index] = 0
