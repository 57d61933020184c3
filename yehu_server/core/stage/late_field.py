"""The late field of a room: a feedback delay network, shared by all players. Compiled.

Sound goes round in LINES delay lines of different lengths. What leaves them is mixed by an
orthogonal matrix, which keeps its energy, and enters them again; only the filters of
``absorption`` take some of it. So the decay is as asked, in each octave [Jot]. Sound enters each
line after a time of its own, which makes the echoes dense early and, unlike all-pass filters in a
row, leaves no ringing of its own.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.stage import absorption, image_sources

Array = Any

LINES = 16
LENGTH = 1 << 15  # most frames of a line, and of the span that it is kept in
# Frames between two lines: with a span of a power of two alone, all would fall into the same set of
# the processor's cache.
APART = LENGTH + 24
SHORTEST, LONGEST = 0.5, 1.5  # of the lines, over the middle one
LEAST_S, MOST_S = 0.03, 0.11  # of the middle line; shorter ones have too few modes not to ring
PATHS = 3.0  # mean free paths in the middle line
INTO_LINES = 1.0 / math.sqrt(LINES)
# When sound enters each line, and with which sign: the left in even lines, the right in odd ones.
# By chance, one in each eighth of the time, and of those the ones with the evenest tail.
ENTRY_S = 1e-3 * np.array([
    13.81, 13.26, 10.61, 9.69, 19.13, 6.56, 18.18, 29.21,
    1.18, 25.06, 4.17, 0.5, 22.98, 21.7, 27.15, 17.82,
])  # fmt: skip
ENTRY_SIGN = np.array([1, -1, 1, 1, -1, -1, 1, 1, 1, -1, 1, 1, 1, 1, 1, 1], np.float64)
ENTRIES = 1 << 13  # most frames until sound has entered all lines
DIFFUSERS = 2  # all-pass filters before them, which decay sooner than any room
DIFFUSER_LENGTH = 1 << 9
DIFFUSION = 0.6  # their coefficient
DIFFUSER_S = np.array([[0.0009, 0.0023], [0.0011, 0.0021]])
# Which line's sound enters a line again: so that two ways round of the same lines in another order,
# which take the same time, do not add up.
TURN, SHIFT = 5, 3
MOVE_S = 0.05  # in which lines take on the lengths of another size
CLOSE_S, OPEN_S = 0.005, 0.02  # fades when the room is emptied

ROOM = np.dtype(
    [
        ("rate", np.float64),  # Hz
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
        ("length", np.int64, LINES),
        ("b_0", np.float64, LINES),
        ("b_1", np.float64, LINES),
        ("a_1", np.float64, LINES),
        ("state", np.float64, LINES),  # of the filters
        ("entry", np.int64, LINES),  # frames
        ("entry_gain", np.float64, LINES),
        ("x", np.float64, LINES),
        ("left", np.float64),  # what it gives
        ("right", np.float64),
        ("diffuser_length", np.int64, (2, DIFFUSERS)),
        ("diffuser", np.float64, (2, DIFFUSERS, DIFFUSER_LENGTH)),
        ("entered", np.float64, (2, ENTRIES)),
        ("line", np.float64, (LINES, APART)),
    ],
    align=True,
)


def prepare_room(room: Any, rate: float) -> None:
    """Prepare a record of dtype ROOM [shape=()] for a rate (Hz), in place: an empty room."""
    room["rate"] = rate
    room["close_step"], room["open_step"] = 1.0 / (CLOSE_S * rate), 1.0 / (OPEN_S * rate)
    room["move_step"] = 1.0 / (MOVE_S * rate)
    room["entry"] = np.round(ENTRY_S * rate)
    room["diffuser_length"] = np.round(DIFFUSER_S * rate)
    empty_room(room)


def empty_room(room: Any) -> None:
    """Take all sound out of a record of dtype ROOM, in place."""
    for name in ("state", "diffuser", "entered", "line", "open", "left", "right"):
        room[name] = 0.0
    # A room of no size is closed; that which is asked for first is open at once.
    room["size"], room["closing"], room["emptying"], room["moved"] = 0.0, 1, 0, 1.0


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
            left = 10.0 ** (-absorption.loss_low(decay) * r.entry[i] / r.rate / 20.0)
            r.entry_gain[i] = ENTRY_SIGN[i] * INTO_LINES * left


@compiled_exactly
def reset_state(r: Any) -> None:
    """Clear all sound and filter state after an invalid sample. Real time: safe."""
    r.size, r.open, r.closing, r.emptying = 0.0, 0.0, 1, LENGTH


@compiled_exactly
def measure(r: Any, size: float) -> None:
    """Give the lines the lengths that belong to a size (m): primes, in equal ratios."""
    r.size = size
    middle = PATHS * image_sources.mean_free_path(size) / image_sources.SOUND
    middle = min(max(middle, LEAST_S), MOST_S)
    frames = 0
    for i in range(LINES):
        ratio = SHORTEST * (LONGEST / SHORTEST) ** (i / (LINES - 1.0))
        r.was_length[i] = r.length[i]
        r.length[i] = next_prime(int(middle * ratio * r.rate))
        frames += r.length[i]
    # Of the energy that entered, which decays, each frame of the lines has the same; each ear
    # hears half of the lines. A steady sound of power 1 is heard with half of this, over the decay
    # (s), of which the diffuse field has as much.
    heard = LINES * r.rate / (frames * math.log(1e6))
    r.was_per_level = r.per_level
    r.per_level = image_sources.diffuse_level(size, 1.0) / math.sqrt(0.5 * heard)


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
def enter(r: Any, frame: int, side: int, x: float) -> None:
    """Let a sample of one side enter, through the all-pass filters."""
    for k in range(DIFFUSERS):
        line = r.diffuser[side, k]
        late = line[(frame - r.diffuser_length[side, k]) & (DIFFUSER_LENGTH - 1)]
        if r.emptying > 0:
            late = 0.0
        kept = x + DIFFUSION * late
        line[frame & (DIFFUSER_LENGTH - 1)] = kept
        x = late - DIFFUSION * kept
    r.entered[side, frame & (ENTRIES - 1)] = x


@compiled_exactly
def reverberate(r: Any, frame: int, level: float, left: float, right: float) -> None:
    """Let sound of two sides enter the room; ``left`` and ``right`` are what it gives.

    At a level of 0 nothing is computed, and the room is empty when it is heard again.
    Real time: safe.
    """
    r.left, r.right = 0.0, 0.0
    if level == 0.0 or r.size == 0.0:
        r.open, r.closing = 0.0, 1
        return
    if r.closing != 0:
        r.open = max(0.0, r.open - r.close_step)
    elif r.emptying == 0:
        r.open = min(1.0, r.open + r.open_step)
    enter(r, frame, 0, r.open * left)
    enter(r, frame, 1, r.open * right)
    leave(r, frame)
    x = r.x
    for i in range(LINES):
        y = r.b_0[i] * x[i] + r.state[i]
        r.state[i] = r.b_1[i] * x[i] - r.a_1[i] * y
        x[i] = y
    per_level = r.per_level
    if r.moved < 1.0:
        per_level += (1.0 - r.moved) * (r.was_per_level - per_level)
        r.moved = min(1.0, r.moved + r.move_step)
    gain = per_level * level * r.open
    r.left = gain * (((x[0] + x[2]) + (x[4] + x[6])) - ((x[8] + x[10]) + (x[12] + x[14])))
    r.right = gain * (((x[1] + x[3]) + (x[5] + x[7])) - ((x[9] + x[11]) + (x[13] + x[15])))
    if r.emptying == 0:
        for i in range(LINES):
            x[i] += r.entry_gain[i] * r.entered[i & 1, (frame - r.entry[i]) & (ENTRIES - 1)]
    mix(x)
    here = frame & (LENGTH - 1)
    for i in range(LINES):
        r.line[i, here] = x[(TURN * i + SHIFT) & (LINES - 1)]


@compiled_exactly
def leave(r: Any, frame: int) -> None:
    """Take what leaves the lines."""
    x = r.x
    if r.emptying > 0:
        r.emptying -= 1
        for i in range(LINES):
            x[i], r.state[i] = 0.0, 0.0
        return
    for i in range(LINES):
        x[i] = r.line[i, (frame - r.length[i]) & (LENGTH - 1)]
    if r.moved < 1.0:
        for i in range(LINES):
            was = r.line[i, (frame - r.was_length[i]) & (LENGTH - 1)]
            x[i] += (1.0 - r.moved) * (was - x[i])


@compiled_exactly
def mix(x: Array) -> None:
    """Multiply LINES values by an orthogonal matrix, in place: all its entries are 1/4 or -1/4.

    It is the Kronecker product of two Householder reflections of four values, so that each line
    feeds all lines alike.
    """
    for j in range(4):
        half = 0.5 * ((x[j] + x[4 + j]) + (x[8 + j] + x[12 + j]))
        x[j] -= half
        x[4 + j] -= half
        x[8 + j] -= half
        x[12 + j] -= half
    for i in range(0, LINES, 4):
        half = 0.5 * ((x[i] + x[i + 1]) + (x[i + 2] + x[i + 3]))
        x[i] -= half
        x[i + 1] -= half
        x[i + 2] -= half
        x[i + 3] -= half
