"""How the players of a section differ: in seed, gain and seat, and in when they begin.

Each player corrects a share, the gain, of how far it was from each of the others at the note
before [Wing]: A'_i = A_i - gain_i sum_j (A_i - A_j) + a random error. Their asynchronies are
counted from the earliest, which is on time: nobody is early, and nobody later than `MAX_LATE_MS`.
How their instruments differ is in ``playing.section_instruments``. Compiled.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.midi.record import MAX_ONSETS
from yehu_server.core.physics.elementary import log10, pseudorandom
from yehu_server.core.player.parameter_indices import (
    ENGINE,
    INDEX,
    LOWER_BOUNDS,
    PLAYING,
    UPPER_BOUNDS,
)

OWN_SEED, GAIN, PAN, DISTANCE = "/engine/seed", "/output/gain", "/room/pan", "/room/distance"
OWN = (OWN_SEED, GAIN, PAN, DISTANCE)
SEED_INDEX, GAIN_INDEX, PAN_INDEX, DISTANCE_INDEX = (INDEX[address] for address in OWN)
SEED_COUNT = 1 << 16
SEED_STEP = 7919  # seeds of two players; a prime, so that they meet no other section's soon

# Seats: in two rows, so far before and behind the part's own distance, alike on both sides; from
# left to right, neighbours so far apart, all of them no more than to either side of the part's
# own place.
FRONT, BACK = 0.87, 1.15
NEIGHBOUR, TO_EITHER_SIDE = 0.12, 0.35


@compiled_exactly
def own_value(index: int, value: float, number: int, players: int) -> float:
    """A player's value of a parameter, of what their part has.

    All together are as loud as one alone. `index` is -1 for none; players count from 0.
    """
    if index == SEED_INDEX:
        return float((int(np.rint(value)) + SEED_STEP * number) % SEED_COUNT)
    if players == 1:
        return value
    if index == GAIN_INDEX:
        own = value - 10.0 * log10(players)
        return float(min(max(own, LOWER_BOUNDS[GAIN_INDEX]), UPPER_BOUNDS[GAIN_INDEX]))
    if index == DISTANCE_INDEX:
        from_outside = min(number, players - 1 - number)
        factor = BACK if from_outside % 2 != 0 else FRONT
        own = value * (factor if players > 2 else 1.0)
        return float(min(max(own, LOWER_BOUNDS[DISTANCE_INDEX]), UPPER_BOUNDS[DISTANCE_INDEX]))
    if index == PAN_INDEX:
        side = min(0.5 * NEIGHBOUR * (players - 1), TO_EITHER_SIDE)
        middle = min(max(value, side - 1.0), 1.0 - side)
        return float(middle + side * (2.0 * min(number, players - 1) / (players - 1) - 1.0))
    return value


MAX_LATE_MS = 40.0
# Standard deviation of the error in each onset, at full variation and at most. At the usual
# variation it is 9 ms, which leaves onsets of two players 13 ms apart [Wing]. Trios that play
# different notes have 30 to 50 ms [Rasch].
ERROR_MS, MAX_ERROR_MS = 36.0, 14.0
# The gain that keeps players of a number closest is 1 over it: 0.25 for four [Wing]. Each has one
# of its own, within these factors. By ear.
GAIN_LO, GAIN_HI = 0.6, 1.4
MAX_LATE_FRACTION = 0.5  # of the time since the last onset; else short notes would be lost
SUMMED_UNIFORMS = 12  # a sum of this many uniform numbers is nearly normal
FIRST_STREAM = 1 << 20  # of random numbers; those of the players' variation come before


@compiled_exactly
def begin_sequence(m: Any, seed: int) -> None:
    """Begin the sequence of a seed; all are together."""
    m.stream, m.random_count = FIRST_STREAM + seed, 0
    for i in range(m.players):
        m.share[i] = uniform(m, GAIN_LO, GAIN_HI)
    m.onsets = 0
    draw_errors(m)


@compiled_exactly
def plan_onset(m: Any, frame: int) -> None:
    """Find how many frames each is late for an onset planned at a frame (``late``); note it."""
    if m.stream == 0:
        begin_sequence(m, int(m.value[ENGINE.seed]))
    find_lateness(m, frame)
    n = m.onsets % MAX_ONSETS
    m.onset_at[n] = frame
    for i in range(m.players):
        m.onset_late[n, i] = m.late[i]
    m.onsets += 1
    draw_errors(m)


@compiled_exactly
def plan_release(m: Any, frame: int) -> None:
    """Find how many frames each is late for the end of a note: as for the onset that follows."""
    if m.stream == 0:
        begin_sequence(m, int(m.value[ENGINE.seed]))
    for onset in range(max(0, m.onsets - MAX_ONSETS), m.onsets):
        n = onset % MAX_ONSETS
        if m.onset_at[n] >= frame:
            for i in range(m.players):
                m.late[i] = m.onset_late[n, i]
            return
    find_lateness(m, frame)


@compiled_exactly
def find_lateness(m: Any, frame: int) -> None:
    """Find how late each is for the next onset, if that is planned at a frame."""
    most, total = MAX_LATE_MS, 0.0
    n = (m.onsets - 1) % MAX_ONSETS
    if m.onsets > 0:
        most = min(most, max(0.0, MAX_LATE_FRACTION * 1e3 * (frame - m.onset_at[n]) / m.rate))
    for i in range(m.playing):
        m.before[i] = 1e3 * m.onset_late[n, i] / m.rate if m.onsets > 0 else 0.0
        total += m.before[i]
    error = min(ERROR_MS * m.value[PLAYING.variation], MAX_ERROR_MS)
    first = math.inf
    for i in range(m.playing):
        own = m.before[i]
        gain = m.share[i] / m.playing
        m.before[i] = own - gain * (m.playing * own - total) + error * m.error[i]
        first = min(first, m.before[i])
    for i in range(m.players):
        m.late[i] = 0
        if i < m.playing:
            m.late[i] = int(1e-3 * min(m.before[i] - first, most) * m.rate)


@compiled_exactly
def draw_errors(m: Any) -> None:
    """Draw the errors of the next onset."""
    for i in range(m.players):
        # A number of mean 0 and variance 1; each of the uniform ones has a variance of 1/3.
        total = 0.0
        for _ in range(SUMMED_UNIFORMS):
            total += uniform(m, -1.0, 1.0)
        m.error[i] = total / math.sqrt(SUMMED_UNIFORMS / 3.0)


@compiled_exactly
def uniform(m: Any, lo: float, hi: float) -> float:
    """The next random number of the sequence, within bounds."""
    m.random_count += 1
    return float(lo + 0.5 * (hi - lo) * (1.0 + pseudorandom((m.stream << 32) + m.random_count)))
