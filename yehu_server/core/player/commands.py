"""The requests that a player accepts, each with the frame at which it is carried out. Compiled.

| kind | index | value | other |
|---|---|---|---|
| RAMP | slot of the engine, or SILENCE | target | length of the ramp (frames) |
| WRITE | index of a parameter | value | minimum ramp time of the resulting moves (ms) |
| HOLD | the same, kept through notes | value | the same |
| EXPRESS | index of a parameter | value; it takes effect when the next note begins | |
| BEGIN | channel | key | pitch (fractional MIDI note within range) |
| END | channel | key | 1 where more keys end at the same time |
| SLIDE | | pitch within range | |
| DRAW | | bow speed (m/s) | bow force (N) |
| LIFT | | | |
| STOP | | 1: even where a note sounds | |
| RELEASE | | 1: held parameters stay so | |
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.controls.ramps import start_ramp
from yehu_server.core.controls.record import Controls
from yehu_server.core.player import direct_bowing, left_hand, notes
from yehu_server.core.player.ownership import invalidate_sent, ramp_to, release, write_directly
from yehu_server.core.player.parameter_indices import (
    BODY,
    BOW,
    ENGINE,
    IS_ENGINES,
    IS_PLAYER_CONTROLLED,
    LOWER_BOUNDS,
    PARAMETER_COUNT,
    PLAYING,
    SMOOTH_MS,
    UPPER_BOUNDS,
)
from yehu_server.core.player.phrasing import begin_sequence
from yehu_server.core.player.record import Player

KINDS = (
    "ramp", "write", "hold", "express", "begin", "end", "slide", "draw", "lift", "stop", "release",
)  # fmt: skip
RAMP, WRITE, HOLD, EXPRESS, BEGIN, END, SLIDE, DRAW, LIFT, STOP, RELEASE = range(len(KINDS))
MAX_RAMP = 1e9  # frames of a ramp, ms of a glide
# What each costs at most, of what EXPRESS does (some 0.3 us; bench/worst.py --mixes). A note
# beside as many held keys as there may be takes 2.7 us.
COSTS = np.array([{"express": 1, "begin": 9, "end": 8, "slide": 5}.get(kind, 2) for kind in KINDS])
COST_TO_FOLLOW, COST_OF_ONE_OF_MANY = 5, 2  # a write that bow and finger follow; END of more keys
IS_FOLLOWED = np.zeros(PARAMETER_COUNT, np.bool_)
IS_FOLLOWED[[
    PLAYING.bend, PLAYING.dynamics, PLAYING.intensity, PLAYING.speed, PLAYING.pressure,
    PLAYING.bow_position, PLAYING.brilliance, PLAYING.velocity, ENGINE.calibration, BODY.evenness,
]] = True  # fmt: skip

COMMAND = np.dtype(
    [
        ("frame", np.int64),
        ("kind", np.int64),
        ("index", np.int64),
        ("value", np.float64),
        ("other", np.float64),
    ]
)


@native
def apply(
    p: Player, c: Controls, frame: int, kind: int, index: int, value: float, other: float
) -> None:
    """Apply a command, given by its fields, within the ranges of what it moves. Real time: safe.

    A command of unknown kind, for an unknown parameter, or with a number that is not finite is
    ignored.
    """
    if not (math.isfinite(value) and math.isfinite(other)):
        return
    if kind == RAMP:
        start_ramp(c, index, value, int(clamp(other, 0.0, MAX_RAMP)))
    elif kind == BEGIN:
        notes.begin(p, c, frame, index, value, clamp_pitch(p, other))
    elif kind == END:
        notes.end(p, c, index, value, other != 0.0)
    elif kind == SLIDE:
        direct_bowing.slide(p, c, clamp_pitch(p, value))
    elif kind == DRAW:
        direct_bowing.draw(p, c, clamp_to_range(BOW.speed, value), clamp_to_range(BOW.force, other))
    elif kind == LIFT:
        direct_bowing.lift(p, c)
    elif kind == STOP:
        notes.stop_sound(p, c, value != 0.0)
    elif kind == RELEASE:
        release(p, value != 0.0)
        p.is_direct = 0
    elif 0 <= index < PARAMETER_COUNT:
        if kind in (WRITE, HOLD):
            glide_ms = clamp(other, 0.0, MAX_RAMP)
            write(p, c, index, clamp_to_range(index, value), kind == HOLD, glide_ms)
        elif kind == EXPRESS:
            set_for_next_note(p, c, index, clamp_to_range(index, value))


@compiled_exactly
def cost(kind: int, index: int, other: float) -> int:
    """What a command costs, for budgets of work (``engine.mailbox.ready_at``)."""
    if not 0 <= kind < len(COSTS):
        return 1
    if kind in (WRITE, HOLD) and 0 <= index < PARAMETER_COUNT and IS_FOLLOWED[index]:
        return COST_TO_FOLLOW
    return COST_OF_ONE_OF_MANY if kind == END and other != 0.0 else int(COSTS[kind])


@compiled_exactly
def clamp(value: float, lo: float, hi: float) -> float:
    """Clamp a value to bounds."""
    return float(min(max(value, lo), hi))


@compiled_exactly
def clamp_pitch(p: Any, pitch: float) -> float:
    """Clamp a pitch to the range of the instrument."""
    return clamp(pitch, p.open_note[0], p.highest[1])


@compiled_exactly
def clamp_to_range(index: int, value: float) -> float:
    """Clamp a value to the range of a parameter."""
    return clamp(value, LOWER_BOUNDS[index], UPPER_BOUNDS[index])


@compiled_exactly
def write(p: Any, c: Any, index: int, value: float, hold: bool, glide_ms: float) -> None:
    """Set a parameter; the resulting moves of bow and fingers take at least `glide_ms`."""
    if IS_PLAYER_CONTROLLED[index]:
        write_directly(p, c, index, value, hold)
        return
    if hold:
        p.is_held[index] = 1
        invalidate_sent(p, index)
    elif p.is_held[index] != 0:
        return
    if p.value[index] == value:
        return
    p.value[index] = value
    if IS_ENGINES[index]:
        ramp_to(p, c, index, value, max(SMOOTH_MS[index], glide_ms))
    p.glide_ms = glide_ms
    apply_parameter_change(p, c, index)
    p.glide_ms = 0.0


@compiled_exactly
def set_for_next_note(p: Any, c: Any, index: int, value: float) -> None:
    """Set a parameter; it takes effect when the next note begins."""
    if IS_ENGINES[index]:
        write(p, c, index, value, False, 0.0)
    elif p.is_held[index] == 0:
        p.value[index] = value


@compiled_exactly
def apply_parameter_change(p: Any, c: Any, index: int) -> None:
    """Apply a changed parameter of the player to the sounding note."""
    if index in (PLAYING.bend, ENGINE.calibration):
        notes.follow_bend(p, c)
    elif index == PLAYING.press:
        left_hand.press(p, c, notes.min_press(p, max(p.string, 0)), left_hand.LANDING_MS)
    elif index in (PLAYING.dynamics, PLAYING.intensity):
        notes.update_bow(p, c)
        notes.follow_bend(p, c)
        notes.set_level(p, c)
        if p.value[PLAYING.phrasing] > 0.0:  # force and place go with the speed
            notes.set_bow_pressure(p, c)
    elif index == PLAYING.speed:  # a faster bow changes the pitch
        notes.update_bow(p, c)
        notes.follow_bend(p, c)
    elif index in (PLAYING.pressure, PLAYING.bow_position):
        notes.set_bow_pressure(p, c)
    elif index == PLAYING.tremolo:
        notes.update_bow(p, c)
    elif index in (
        PLAYING.vibrato,
        PLAYING.vibrato_press,
        PLAYING.vibrato_rate,
        PLAYING.phrasing,
        PLAYING.left_hand,
    ):
        notes.rock(p, c)
    elif index == PLAYING.assist:
        notes.set_assist(p, c)
    elif index in (PLAYING.volume, PLAYING.expression):
        notes.set_level(p, c)
    elif index in (PLAYING.brilliance, BODY.evenness):
        notes.set_loudness_balance(p, c)
    elif index == PLAYING.velocity:
        notes.update_bow(p, c)
        notes.follow_bend(p, c)
        notes.set_loudness_balance(p, c)
    elif index == PLAYING.listening and p.value[PLAYING.listening] == 0.0:
        notes.reset_corrections(p, c)
    elif index == ENGINE.seed:
        begin_sequence(p, int(p.value[ENGINE.seed]))
