"""Carries out the steps of a note's gesture as they are due. Compiled."""

from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.player import gestures, notes, right_hand
from yehu_server.core.player.ear import HOP_S
from yehu_server.core.player.notes import BEND_RAMP_MS
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.core.player.phrasing import STEP_MS
from yehu_server.core.player.velocity import has_risen

HOP_MS = 1e3 * HOP_S  # from one call of `articulate` to the next
MIN_ROUND_FRACTION = 0.55  # of the time between rounds, at least: as quick as hands go
HEARD_LAST_MS = 40.0  # of a trilled note after its last beat


@compiled_exactly
def articulate(p: Any, c: Any) -> None:
    """Do what of the sounding note's gesture is due."""
    if p.sounding < 0:
        return
    g = p.gesture
    now = (c.frame - p.note_began) / p.rate
    length = gestures.note_length(p, g.row)
    right_hand.ease_turning_pressure(p, c, now)
    move_bow(p, c, now, length)
    move_level(p, c)
    move_finger(p, c, now, length)


@compiled_exactly
def time_of(step: Any, time_factor: float, length: float) -> float:
    """When a step is due (s after its round began)."""
    return float(1e-3 * time_factor * step[gestures.AT] + step[gestures.AT_SHARE] * length)


@compiled_exactly
def pace_of(track: Any, row: int) -> float:
    """Factor on the time of a round, as they come faster and faster."""
    slower = 1.0 - gestures.SHAPES[row, gestures.SHORTENING] * track.times
    return float(max(slower, MIN_ROUND_FRACTION))


@compiled_exactly
def begin_again(track: Any, row: int, count: int, now: float) -> None:
    """Begin a hand's steps once more, where all are done and they are to come again by now."""
    if gestures.SHAPES[row, gestures.REPEAT_MS] == 0.0 or not track.step >= count > 0:
        return
    if track.times + 1 >= gestures.SHAPES[row, gestures.MAX_ROUNDS]:
        return
    again = 1e-3 * gestures.SHAPES[row, gestures.REPEAT_MS] * pace_of(track, row)
    if now >= track.begins + again:
        track.step, track.begins = 0, track.begins + again
        track.times += 1


@compiled_exactly
def has_time(p: Any, track: Any, row: int, now: float) -> bool:
    """Whether a finger can beat once more, and the note itself then be heard before it ends."""
    length = p.value[PLAYING.note_length]
    last = max(gestures.FINGER_COUNT[row] - 1, 0)
    round_ms = gestures.FINGER_STEPS[row, last, gestures.AT] + HEARD_LAST_MS
    return bool(length == 0.0 or now + 1e-3 * round_ms * pace_of(track, row) <= length)


@compiled_exactly
def move_bow(p: Any, c: Any, now: float, length: float) -> None:
    """Carry out the bow's steps that are due."""
    g = p.gesture
    count = gestures.BOW_COUNT[g.row]
    if gestures.FINGER_COUNT[g.row] == 0:
        begin_again(g.bow, g.row, count, now)
    while g.bow.step < count:
        step = gestures.BOW_STEPS[g.row, g.bow.step]
        if now < g.bow.begins + time_of(step, g.time_factor, length):
            return
        g.bow.step += 1
        ramp_ms = g.time_factor * step[gestures.RAMP] + 1e3 * step[gestures.RAMP_SHARE] * length
        g.move_ends = now + 1e-3 * ramp_ms
        g.speed, g.weight = step[gestures.SPEED], step[gestures.WEIGHT]
        g.is_off = 0 if step[gestures.IS_ON] != 0.0 else 1
        if step[gestures.TURNS] != 0.0:
            p.direction = -p.direction
        if g.is_off != 0:
            right_hand.lift(p, c, ramp_ms)
        else:
            notes.set_bow_pressure(p, c)
            notes.draw(p, c, ramp_ms)
            g.gain_to = gestures.gain_of(g)
            g.gain_step = (g.gain_to - g.gain_db) / max(ramp_ms / HOP_MS, 1.0)


@compiled_exactly
def move_level(p: Any, c: Any) -> None:
    """Let the level go on to where the bow's speed wants it."""
    g = p.gesture
    if g.gain_db == g.gain_to:
        return
    is_there = abs(g.gain_to - g.gain_db) <= abs(g.gain_step)
    if has_risen(p, c) or not is_there:
        g.gain_db = g.gain_to if is_there else g.gain_db + g.gain_step
    if has_risen(p, c):
        notes.set_loudness_balance(p, c)


@compiled_exactly
def move_finger(p: Any, c: Any, now: float, length: float) -> None:
    """Carry out the finger's steps that are due, and go on with its slide."""
    g = p.gesture
    count = gestures.FINGER_COUNT[g.row]
    if has_time(p, g.finger, g.row, now):
        begin_again(g.finger, g.row, count, now)
    pace = pace_of(g.finger, g.row)
    while g.finger.step < count:
        step = gestures.FINGER_STEPS[g.row, g.finger.step]
        if now < g.finger.begins + pace * time_of(step, g.time_factor, length):
            break
        g.finger.step += 1
        semitones = gestures.within_reach(p, step[gestures.SEMITONES])
        if step[gestures.GLIDE] > 0.0:
            gestures.begin_slide(
                p, g.bend, semitones, now, 1e-3 * g.time_factor * step[gestures.GLIDE]
            )
        else:
            g.bend, g.slide_s = semitones, 0.0
            notes.follow_pitch(p, c, STEP_MS)
    if g.slide_s > 0.0:
        g.bend = gestures.slide_position(g, now)
        if now >= g.slide_at + g.slide_s:
            g.slide_s = 0.0
        notes.follow_pitch(p, c, BEND_RAMP_MS)
