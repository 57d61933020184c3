"""The requests that a player accepts, each with the frame at which it is carried out. Compiled.

| kind | index | value | other |
|---|---|---|---|
| RAMP | slot of the engine, or SILENCE | target | length of the ramp (frames) |
| WRITE | index of a parameter | value | least time of the moves that follow (ms) |
| HOLD | the same, kept through notes | value | the same |
| EXPRESS | index of a parameter | value for the note that begins next | |
| BEGIN | channel | key | pitch (fractional MIDI note within range) |
| END | channel | key | 1 where more keys end at the same time |
| SLIDE | | pitch within range | |
| DRAW | | bow speed (m/s) | bow force (N) |
| LIFT | | | |
| STOP | | 1: even where a note sounds | |
| RELEASE | | | |
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.core.controls.ramps import take
from yehu_server.core.controls.record import Controls
from yehu_server.core.player import direct_bowing, left_hand, notes, vibrato
from yehu_server.core.player.ownership import forget, ramp_to, release, write_directly
from yehu_server.core.player.parameter_indices import (
    ASSIST,
    BEND,
    BOW_FORCE,
    BOW_SPEED,
    BRILLIANCE,
    DYNAMICS,
    EVENNESS,
    EXPRESSION,
    IS_ENGINES,
    IS_PLAYER_CONTROLLED,
    LISTENING,
    LOWER_BOUNDS,
    PARAMETER_COUNT,
    PHRASING,
    PLAYING_VIBRATO_PRESS,
    PLAYING_VIBRATO_RATE,
    POSITION,
    PRESS,
    PRESSURE,
    SEED,
    SHARPENING_CORRECTION,
    SMOOTH_MS,
    SPEED,
    TREMOLO,
    UPPER_BOUNDS,
    VELOCITY,
    VIBRATO,
    VOLUME,
)
from yehu_server.core.player.phrasing import begin_sequence
from yehu_server.core.player.record import Player

KINDS = (
    "ramp", "write", "hold", "express", "begin", "end", "slide", "draw", "lift", "stop", "release",
)  # fmt: skip
RAMP, WRITE, HOLD, EXPRESS, BEGIN, END, SLIDE, DRAW, LIFT, STOP, RELEASE = range(len(KINDS))
MAX_RAMP = 1e9  # frames of a ramp, ms of a glide

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
    """Apply a command, given by its fields, within the ranges of what it moves.

    One of no kind, for no parameter, or with a number that is not finite changes nothing.

    Real time: safe.
    """
    if not (math.isfinite(value) and math.isfinite(other)):
        return
    if kind == RAMP:
        take(c, index, value, int(bounded(other, 0.0, MAX_RAMP)))
    elif kind == BEGIN:
        notes.begin(p, c, frame, index, value, playable(p, other))
    elif kind == END:
        notes.end(p, c, index, value, other != 0.0)
    elif kind == SLIDE:
        direct_bowing.slide(p, c, playable(p, value))
    elif kind == DRAW:
        direct_bowing.draw(p, c, in_range(BOW_SPEED, value), in_range(BOW_FORCE, other))
    elif kind == LIFT:
        direct_bowing.lift(p, c)
    elif kind == STOP:
        notes.stop_sound(p, c, value != 0.0)
    elif kind == RELEASE:
        release(p)
        p.is_direct = 0
    elif 0 <= index < PARAMETER_COUNT:
        if kind in (WRITE, HOLD):
            glide_ms = bounded(other, 0.0, MAX_RAMP)
            write(p, c, index, in_range(index, value), kind == HOLD, glide_ms)
        elif kind == EXPRESS:
            express(p, c, index, in_range(index, value))


@compiled_exactly
def bounded(value: float, lo: float, hi: float) -> float:
    """The value nearest to one that lies within bounds."""
    return float(min(max(value, lo), hi))


@compiled_exactly
def playable(p: Any, pitch: float) -> float:
    """The pitch of the instrument that is nearest to one."""
    return bounded(pitch, p.open_note[0], p.highest[1])


@compiled_exactly
def in_range(index: int, value: float) -> float:
    """The value nearest to one that a parameter can have."""
    return bounded(value, LOWER_BOUNDS[index], UPPER_BOUNDS[index])


@compiled_exactly
def write(p: Any, c: Any, index: int, value: float, hold: bool, glide_ms: float) -> None:
    """Set a parameter; the moves of bow and fingers that follow take at least `glide_ms`."""
    if IS_PLAYER_CONTROLLED[index]:
        write_directly(p, c, index, value, hold)
        return
    if hold:
        p.is_held[index] = 1
        forget(p, index)
    elif p.is_held[index] != 0:
        return
    if p.value[index] == value:
        return
    p.value[index] = value
    if IS_ENGINES[index]:
        ramp_to(p, c, index, value, max(SMOOTH_MS[index], glide_ms))
    p.glide_ms = glide_ms
    follow(p, c, index)
    p.glide_ms = 0.0


@compiled_exactly
def express(p: Any, c: Any, index: int, value: float) -> None:
    """Set a parameter for the note that begins next; what it moves, the note will."""
    if IS_ENGINES[index]:
        write(p, c, index, value, False, 0.0)
    elif p.is_held[index] == 0:
        p.value[index] = value


@compiled_exactly
def follow(p: Any, c: Any, index: int) -> None:
    """Move what follows a parameter of the player while a note sounds."""
    if index in (BEND, SHARPENING_CORRECTION):
        notes.follow_bend(p, c)
    elif index == PRESS:
        left_hand.press(p, c, notes.min_press(p, max(p.string, 0)), left_hand.LANDING_MS)
    elif index == DYNAMICS:
        notes.draw_on(p, c)
        notes.follow_bend(p, c)
        notes.set_level(p, c)
    elif index == SPEED:  # a faster bow changes the pitch
        notes.draw_on(p, c)
        notes.follow_bend(p, c)
    elif index in (PRESSURE, POSITION):
        notes.set_bow_pressure(p, c)
    elif index == TREMOLO:
        notes.draw_on(p, c)
    elif index in (VIBRATO, PLAYING_VIBRATO_PRESS, PLAYING_VIBRATO_RATE, PHRASING):
        vibrato.set_vibrato(p, c)
    elif index == ASSIST:
        notes.set_assist(p, c)
    elif index in (VOLUME, EXPRESSION):
        notes.set_level(p, c)
    elif index in (BRILLIANCE, EVENNESS):
        notes.even_out(p, c)
    elif index == VELOCITY:
        notes.draw_on(p, c)
        notes.follow_bend(p, c)
        notes.even_out(p, c)
    elif index == LISTENING and p.value[LISTENING] == 0.0:
        notes.reset_corrections(p, c)
    elif index == SEED:
        begin_sequence(p, int(p.value[SEED]))
