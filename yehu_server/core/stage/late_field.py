"""The late field of a room: a feedback delay network, shared by all players. Compiled.

Sound circulates in LINES delay lines of different lengths. What leaves them is mixed by an
orthogonal matrix, which keeps its energy, and enters them again; only the filters of
``absorption`` take some of it. So the decay is as asked, in each octave [Jot]. Sound enters each
line after a time of its own, which makes the echoes dense early and, unlike all-pass filters in a
row, leaves no ringing of its own.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.record import CHUNK
from yehu_server.core.physics.elementary import exp10, log, log2, power
from yehu_server.core.stage import absorption, room_geometry
from yehu_server.core.stage.delay_lines import (
    LINES,
    absorb,
    add_ring,
    blend,
    mix,
    read_lines,
    read_ring,
    write_ring,
)

Array = Any

CHECK_FRAMES = 32  # frames from one check of what is asked of a room to the next
MAX_LINE_FRAMES = 1 << 15  # most frames of a line, and of the span that it is kept in
# Frames between two lines: with a span of a power of two alone, all would fall into the same set of
# the processor's cache.
LINE_STRIDE = MAX_LINE_FRAMES + 24
MIN_LENGTH_RATIO, MAX_LENGTH_RATIO = 0.5, 1.5  # of the lines, over the middle one
MIN_MIDDLE_S, MAX_MIDDLE_S = (
    0.03,
    0.11,
)  # of the middle line; shorter ones have too few modes not to ring
MIDDLE_LINE_PATHS = 3.0  # mean free paths in the middle line
INTO_LINES = 1.0 / math.sqrt(LINES)
# When sound enters each line, and with which sign: the left in even lines, the right in odd ones.
# Drawn at random, one in each eighth of the time, and of those the ones with the evenest tail.
ENTRY_S = 1e-3 * np.array([
    13.81, 13.26, 10.61, 9.69, 19.13, 6.56, 18.18, 29.21,
    1.18, 25.06, 4.17, 0.5, 22.98, 21.7, 27.15, 17.82,
])  # fmt: skip
ENTRY_SIGN = np.array([1, -1, 1, 1, -1, -1, 1, 1, 1, -1, 1, 1, 1, 1, 1, 1], np.float64)
MAX_ENTRY_FRAMES = 1 << 13  # most frames until sound has entered all lines
DIFFUSERS = 2  # all-pass filters before them, which decay sooner than any room
DIFFUSER_LENGTH = 1 << 9
DIFFUSION = 0.6  # their coefficient
DIFFUSER_S = np.array([[0.0009, 0.0023], [0.0011, 0.0021]])
# Line i gets back the sound of line FEEDBACK_FACTOR i + FEEDBACK_OFFSET, so that two paths through
# the same lines in another order, which take the same time, do not add up.
FEEDBACK_FACTOR, FEEDBACK_OFFSET = 5, 3
MAX_GAP = 128 + CHUNK  # frames by which a prime may be longer than asked, and a block
MOVE_S = 0.05  # in which lines take on the lengths of another size
CLOSE_S, OPEN_S = 0.005, 0.02  # fades when the room is emptied
# Level in the lines that counts as silence (full scale): 55 dB below half a step of 24 bits, as
# eight are heard at once. It cannot grow, since the matrix keeps the energy.
SILENCE_AMPLITUDE = 1e-10

LATE_FIELD = np.dtype(
    [
        ("rate", np.float64),  # Hz
        # Frames that lines, and what entered, are kept for, less 1: powers of two, as few as do.
        ("mask", np.int64),
        ("entry_mask", np.int64),
        # What holds now: m, s, and shares.
        ("size", np.float64),
        ("decay", np.float64),
        ("damping", np.float64),
        ("per_level", np.float64),  # amplitude of what the lines give, at a level of 1
        # A room of another size comes as that of before goes.
        ("moved", np.float64),  # from 0 to 1
        ("move_step", np.float64),
        ("shaped", np.float64),  # for which share of the move the filters are set
        ("was_per_level", np.float64),
        ("was_length", np.int64, LINES),
        # To fall silent, a room is closed, emptied, and opened again.
        ("open", np.float64),  # amplitude
        ("closing", np.int64),
        ("emptying", np.int64),  # frames for which its lines still give nothing
        ("close_step", np.float64),
        ("open_step", np.float64),
        # Nothing is computed while it is asleep: see `begin_window`.
        ("is_asleep", np.int64),
        ("is_watched", np.int64),  # whether nothing has entered in this window
        ("loudest", np.float64),  # in the lines, of what they were given in this window
        ("length", np.int64, LINES),
        ("b_0", np.float64, LINES),
        ("b_1", np.float64, LINES),
        ("a_1", np.float64, LINES),
        ("state", np.float64, LINES),  # of the filters
        ("entry", np.int64, LINES),  # frames
        ("entry_gain", np.float64, LINES),
        # For each of the frames that are computed at once: what is in the lines; what one line gave
        # before a move, and its share; the amplitude that is heard; how far the room is open.
        ("row", np.float64, (LINES, CHUNK)),
        ("was", np.float64, CHUNK),
        ("share", np.float64, CHUNK),
        ("gain", np.float64, CHUNK),
        ("opened", np.float64, CHUNK),
        ("diffuser_length", np.int64, (2, DIFFUSERS)),
        ("diffuser", np.float64, (2, DIFFUSERS, DIFFUSER_LENGTH)),
        ("entered", np.float64, (2, MAX_ENTRY_FRAMES)),
        ("line", np.float64, (LINES, LINE_STRIDE)),
    ],
    align=True,
)


def power_of_two(least: float) -> int:
    """The least power of two that is at least a number."""
    return 1 << math.ceil(log2(least))


def prepare_room(room: Any, rate: float) -> None:
    """Prepare a record of dtype LATE_FIELD [shape=()] for a rate (Hz), in place: an empty room."""
    room["rate"] = rate
    room["close_step"], room["open_step"] = 1.0 / (CLOSE_S * rate), 1.0 / (OPEN_S * rate)
    room["move_step"] = 1.0 / (MOVE_S * rate)
    room["mask"] = power_of_two(MAX_LENGTH_RATIO * MAX_MIDDLE_S * rate + MAX_GAP) - 1
    room["entry_mask"] = power_of_two(ENTRY_S.max() * rate + CHUNK) - 1
    room["entry"] = np.round(ENTRY_S * rate)
    room["diffuser_length"] = np.round(DIFFUSER_S * rate)
    empty_room(room)


def empty_room(room: Any) -> None:
    """Take all sound out of a record of dtype LATE_FIELD, in place."""
    for name in ("state", "diffuser", "entered", "line", "open", "row"):
        room[name] = 0.0
    # A room of no size is closed; that which is asked for first is open at once.
    room["size"], room["closing"], room["emptying"], room["moved"] = 0.0, 1, 0, 1.0
    room["is_asleep"] = room["is_watched"] = 0


@compiled_exactly
def set_room(r: Any, size: float, decay: float, damping: float) -> None:
    """Follow what is asked of a room: size (m), decay (s), damping (0 to 1).

    Real time: safe; some microseconds where something changed.
    """
    if r.size == 0.0:  # the first, which is empty
        r.moved, r.shaped = 1.0, -1.0
        measure(r, size)
        r.closing, r.open = 0, 1.0
    elif size != r.size and r.moved >= 1.0:
        r.moved = 0.0
        measure(r, size)
    if r.closing != 0 and r.open <= 0.0 and r.emptying == 0:
        r.closing = 0
        for i in range(LINES):
            r.emptying = max(r.emptying, r.length[i], r.was_length[i])
    if decay != r.decay or damping != r.damping or r.moved != r.shaped:
        r.decay, r.damping, r.shaped = decay, damping, r.moved
        for i in range(LINES):
            frames = r.length[i] + (1.0 - r.moved) * (r.was_length[i] - r.length[i])
            absorption.set_shelf(r, i, frames / r.rate, decay, damping)
            left = exp10(-absorption.loss_low(decay) * r.entry[i] / r.rate / 20.0)
            r.entry_gain[i] = ENTRY_SIGN[i] * INTO_LINES * left


@compiled_exactly
def is_settled(r: Any, size: float, decay: float, damping: float) -> bool:
    """Whether `set_room` would leave the room as it is."""
    is_as_asked = size == r.size and decay == r.decay and damping == r.damping
    return bool(is_as_asked and r.moved >= 1.0 and r.moved == r.shaped and r.closing == 0)


@compiled_exactly
def reset_state(r: Any) -> None:
    """Clear all sound and filter state after an invalid sample. Real time: safe."""
    r.size, r.open, r.closing, r.emptying = 0.0, 0.0, 1, MAX_LINE_FRAMES
    r.is_asleep, r.is_watched = 0, 0


@compiled_exactly
def measure(r: Any, size: float) -> None:
    """Give the lines the lengths that belong to a size (m): primes, in equal ratios."""
    r.size = size
    middle = MIDDLE_LINE_PATHS * room_geometry.mean_free_path(size) / room_geometry.SPEED_OF_SOUND
    middle = min(max(middle, MIN_MIDDLE_S), MAX_MIDDLE_S)
    frames = 0
    for i in range(LINES):
        ratio = MIN_LENGTH_RATIO * power(MAX_LENGTH_RATIO / MIN_LENGTH_RATIO, i / (LINES - 1.0))
        r.was_length[i] = r.length[i]
        r.length[i] = next_prime(int(middle * ratio * r.rate))
        frames += r.length[i]
    # Of the energy that entered, which decays, each frame of the lines has the same; each ear
    # hears half of the lines. A steady sound of power 1 is heard with half of this, over the decay
    # (s), of which the diffuse field has as much.
    heard = LINES * r.rate / (frames * log(1e6))
    r.was_per_level = r.per_level
    r.per_level = room_geometry.diffuse_level(size, 1.0) / math.sqrt(0.5 * heard)


@compiled_exactly
def next_prime(number: int) -> int:
    """The least prime from a number on."""
    while True:
        divisor = 2
        while divisor * divisor <= number and number % divisor != 0:
            divisor += 1
        if divisor * divisor > number:
            return number
        number += 1


@compiled_exactly
def reverberate(r: Any, frame: int, level: Array, sound: Array, heard: Array) -> None:
    """Let sound of two sides enter the room; write what the room gives, and how far it is open.

    While the level is 0 nothing is computed, and the room is empty when it is heard again. Of at
    most CHUNK frames from `frame` on: `level` [shape=(frames,)], `sound` and `heard`
    [shape=(frames, 2)]. Real time: safe.
    """
    frames, done = level.shape[0], 0
    while done < frames:
        if level[done] == 0.0 or r.size == 0.0:
            r.open, r.closing, r.opened[done] = 0.0, 1, 0.0
            r.is_asleep, r.is_watched = 0, 0
            heard[done, 0], heard[done, 1] = 0.0, 0.0
            done += 1
            continue
        if r.is_asleep == 0 and (frame + done) & r.mask == 0:
            begin_window(r)
        if r.is_asleep != 0:
            if is_open(r) and sound[done, 0] == 0.0 and sound[done, 1] == 0.0:
                r.opened[done] = r.open
                heard[done, 0], heard[done, 1] = 0.0, 0.0
                done += 1
                continue
            r.is_asleep = 0
        end = done + 1
        while end < frames and level[end] != 0.0 and (frame + end) & r.mask != 0:
            end += 1
        if r.emptying > 0:
            end = min(end, done + r.emptying)
        opened = r.opened[done:end]
        open_room(r, opened)
        diffuse_input(r, frame + done, opened, sound[done:end])
        advance_lines(r, frame + done, level[done:end], opened, heard[done:end])
        if r.is_watched != 0:
            watch(r, sound[done:end])
        done = end


@compiled_exactly
def is_open(r: Any) -> bool:
    """Whether the room is open, and its lines stay as long as they are."""
    return bool(r.closing == 0 and r.emptying == 0 and r.open >= 1.0 and r.moved >= 1.0)


@compiled_exactly
def begin_window(r: Any) -> None:
    """Begin a window of as many frames as lines are kept for; fall asleep after a silent one.

    Where nothing entered in a whole window, and all that lines were given in it is below
    SILENCE_AMPLITUDE, all that they keep is. It stays there: what enters later wakes the room,
    and mixes with it.
    """
    r.is_asleep = 1 if r.is_watched != 0 and r.loudest < SILENCE_AMPLITUDE and is_open(r) else 0
    r.is_watched, r.loudest = 1 - r.is_asleep, 0.0


@compiled_exactly
def watch(r: Any, sound: Array) -> None:
    """Take frames into the window, after they have passed the lines."""
    for n in range(sound.shape[0]):
        if sound[n, 0] != 0.0 or sound[n, 1] != 0.0:
            r.is_watched = 0
            return
        for i in range(LINES):
            r.loudest = max(r.loudest, abs(r.row[i, n]))


@compiled_exactly
def open_room(r: Any, opened: Array) -> None:
    """Write how far the room is open at each frame: a room that closes or opens does so slowly."""
    now, step = r.open, 0.0
    if r.closing != 0:
        step = -r.close_step
    elif r.emptying == 0 and now < 1.0:
        step = r.open_step
    for n in range(opened.shape[0]):
        if step != 0.0:
            now = min(1.0, max(0.0, now + step))
        opened[n] = now
    r.open = now


@compiled_exactly
def diffuse_input(r: Any, frame: int, opened: Array, sound: Array) -> None:
    """Let sound of both sides enter, through the all-pass filters."""
    for n in range(opened.shape[0]):
        for side in range(2):
            x = opened[n] * sound[n, side]
            for k in range(DIFFUSERS):
                line = r.diffuser[side, k]
                late = line[(frame + n - r.diffuser_length[side, k]) & (DIFFUSER_LENGTH - 1)]
                if r.emptying > 0:
                    late = 0.0
                kept = x + DIFFUSION * late
                line[(frame + n) & (DIFFUSER_LENGTH - 1)] = kept
                x = late - DIFFUSION * kept
            r.entered[side, (frame + n) & r.entry_mask] = x


@compiled_exactly
def advance_lines(r: Any, frame: int, level: Array, opened: Array, heard: Array) -> None:
    """Take what leaves the lines, write what is heard of it, and let it enter them again.

    No line is as short as CHUNK frames, so nothing that enters leaves among the same frames.
    """
    frames, row = level.shape[0], r.row
    was_moving, is_empty = r.moved < 1.0, r.emptying > 0
    moved, step, gain, was_gain = r.moved, r.move_step, r.per_level, r.was_per_level
    for n in range(frames):
        share = 1.0 - moved
        r.share[n] = share
        r.gain[n] = (gain + share * (was_gain - gain)) * level[n] * opened[n]
        if was_moving:
            moved = min(1.0, moved + step)
    r.moved = moved
    if is_empty:
        r.emptying -= frames
        r.state[:], row[:] = 0.0, 0.0
    else:
        for i in range(LINES):
            read_ring(row[i], r.line[i], frame - r.length[i], r.mask, frames)
    if was_moving and not is_empty:
        for i in range(LINES):
            read_ring(r.was, r.line[i], frame - r.was_length[i], r.mask, frames)
            blend(row[i], r.was, r.share, frames)
    absorb(row, r.b_0, r.b_1, r.a_1, r.state, frames)
    read_lines(row, r.gain, heard, frames)
    if not is_empty:
        for i in range(LINES):
            entered, gain = r.entered[i & 1], r.entry_gain[i]
            add_ring(row[i], entered, frame - r.entry[i], r.entry_mask, gain, frames)
    mix(row, frames)
    for i in range(LINES):
        write_ring(
            r.line[i],
            row[(FEEDBACK_FACTOR * i + FEEDBACK_OFFSET) & (LINES - 1)],
            frame,
            r.mask,
            frames,
        )
