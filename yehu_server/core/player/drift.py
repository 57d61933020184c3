"""Slow drift and tremor of the hands that hold bow and finger. Compiled.

The drift of a hand has a spectrum of about 1/f ([Gilden]), from four random sequences whose times
are two octaves apart; tremor is a resonance about 10 Hz, where that of hands is ([Elble]). What one
hand does goes together: a bow that is drawn faster is pressed harder. `/playing/variation` says how
much, and `/engine/seed` which; a parameter that somebody else moves is steady.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.record import (
    CENTS_DRIFT,
    DRIFTS,
    FORCE_DRIFT,
    PLACE_DRIFT,
    PRESS_DRIFT,
    SPEED_DRIFT,
)
from yehu_server.core.physics.elementary import cos, each, exp, pseudorandom
from yehu_server.core.player.ear import HOP_S
from yehu_server.core.player.parameter_indices import (
    BOW_FORCE,
    BOW_POSITION,
    BOW_PRESSURE,
    BOW_SPEED,
    FINGER_POSITION,
    FINGER_PRESS,
    VARIATION,
)

# Standard deviations at full variation, in the order of ``controls.record``. By ear.
DRIFT = np.array((0.06, 0.06, 0.04, 4.8, 0.06))
TREMOR = np.array((0.04, 0.05, 0.02, 2.5, 0.04))
RIGHT, LEFT = 0, 1
HAND = np.array((RIGHT, RIGHT, RIGHT, LEFT, LEFT))
# The drift that the others of each hand go with.
LEADING = np.array((SPEED_DRIFT, SPEED_DRIFT, SPEED_DRIFT, CENTS_DRIFT, CENTS_DRIFT))
CORRELATION = 0.6  # with it

# A vibrato's turns differ: standard deviations of rate and width at full variation, by ear less
# than violinists' [Seashore]. Half of the variance is slow: its correlation from turn to turn.
UNEVEN_PACE, UNEVEN_WIDTH = 0.4, 0.4
TURN_CORRELATION = 0.85
TURN_NOISE = math.sqrt(3.0 * (1.0 - TURN_CORRELATION * TURN_CORRELATION))
MAX_UNEVEN = 0.5  # of rate and width, up or down
FOLLOW = 0.15  # of the way to those of the next turn, in a hop

TIMES_S = np.array((0.04, 0.16, 0.64, 2.56))  # of the sequences whose sum is the drift
TIMES = 4
KEPT = each(exp, -HOP_S / TIMES_S)
# Uniform numbers in -1..1 have a variance of 1/3; the sums have one of 1.
NOISE = np.sqrt(3.0 * (1.0 - KEPT**2) / TIMES)
TREMOR_HZ, WIDTH_HZ = 10.0, 3.0
TREMOR_RADIUS = exp(-math.pi * WIDTH_HZ * HOP_S)
TREMOR_A_1 = 2.0 * TREMOR_RADIUS * cos(2.0 * math.pi * TREMOR_HZ * HOP_S)
TREMOR_A_2 = TREMOR_RADIUS * TREMOR_RADIUS
TREMOR_NOISE = math.sqrt(
    3.0
    * (1.0 - TREMOR_A_2)
    * ((1.0 + TREMOR_A_2) * (1.0 + TREMOR_A_2) - TREMOR_A_1 * TREMOR_A_1)
    / (1.0 + TREMOR_A_2)
)
HANDS = 2
SETTLING, STEADY = 0.8, 1e-6  # a hand that does not play comes to rest, by so much in a hop
LATE = 2  # hops after which what a finger did is heard
DRAWN_FROM = 1 << 31  # of the seed's numbers; those before are the notes' (``phrasing``)

DRIFT_STATE = np.dtype(
    [
        ("slow", np.float64, (DRIFTS, TIMES)),  # the sequences of each drift
        ("tremor", np.float64, (HANDS, 2)),  # of each hand, now and one hop ago
        ("cents", np.float64, LATE + 1),  # of the finger, now and at the last hops
        ("phase", np.float64),  # of the vibrato, one hop ago (turns)
        (
            "slow_deviate",
            np.float64,
            2,
        ),  # of the vibrato's rate and width, which changes from turn to turn
        ("pace", np.float64),  # deviates of this turn of the vibrato
        ("width", np.float64),
        ("drawn", np.int64),  # random numbers so far
    ],
    align=True,
)


@compiled_exactly
def next_random(p: Any) -> float:
    """The next random number, -1 to 1."""
    p.drift_state.drawn += 1
    return pseudorandom((p.seed << 32) + DRAWN_FROM + p.drift_state.drawn)


@compiled_exactly
def advance_drift(p: Any, c: Any) -> None:
    """Let the hands drift and tremble on to where they are one hop later."""
    u, amount = p.drift_state, p.value[VARIATION]
    for hand in range(HANDS):
        now, before = u.tremor[hand, 0], u.tremor[hand, 1]
        u.tremor[hand, 0] = TREMOR_A_1 * now - TREMOR_A_2 * before + TREMOR_NOISE * next_random(p)
        u.tremor[hand, 1] = now
    for i in range(DRIFTS):
        for k in range(TIMES):
            u.slow[i, k] = KEPT[k] * u.slow[i, k] + NOISE[k] * next_random(p)
    c.drifting = 0
    for i in range(DRIFTS):
        drift = total(u.slow[i])
        if i != LEADING[i]:
            drift = (
                CORRELATION * total(u.slow[LEADING[i]]) + math.sqrt(1.0 - CORRELATION**2) * drift
            )
        wanted = amount * (DRIFT[i] * drift + TREMOR[i] * u.tremor[HAND[i], 0])
        if amount == 0.0 or not is_playing(p, i):
            wanted = SETTLING * c.drift[i] if abs(c.drift[i]) > STEADY else 0.0
        c.drift_slope[i] = (wanted - c.drift[i]) / p.ear.hop
        if wanted == 0.0 and abs(c.drift[i]) <= STEADY:
            c.drift[i] = c.drift_slope[i] = 0.0
        c.drifting |= 1 if c.drift[i] != 0.0 or c.drift_slope[i] != 0.0 else 0
    if c.drifting == 0:
        c.sounding_drift = c.place_drift = 1.0
    for k in range(LATE, 0, -1):
        u.cents[k] = u.cents[k - 1]
    u.cents[0] = c.drift[CENTS_DRIFT]


@compiled_exactly
def vary_vibrato(p: Any, c: Any) -> None:
    """Let the vibrato's rate and width follow the deviates of its turn."""
    u, amount = p.drift_state, p.value[VARIATION] if p.sounding >= 0 else 0.0
    if c.vibrato < u.phase:
        u.pace, u.width = next_turn_deviate(p, 0), next_turn_deviate(p, 1)
    u.phase = c.vibrato
    c.vibrato_pace += FOLLOW * (turn_factor(amount * UNEVEN_PACE * u.pace) - c.vibrato_pace)
    c.vibrato_width += FOLLOW * (turn_factor(amount * UNEVEN_WIDTH * u.width) - c.vibrato_width)
    if amount == 0.0 and max(abs(c.vibrato_pace - 1.0), abs(c.vibrato_width - 1.0)) < STEADY:
        c.vibrato_pace = c.vibrato_width = 1.0


@compiled_exactly
def next_turn_deviate(p: Any, which: int) -> float:
    """The deviate of the vibrato's next turn, of variance 1: of its rate (0) or its width (1)."""
    slow_deviate = p.drift_state.slow_deviate
    slow_deviate[which] = TURN_CORRELATION * slow_deviate[which] + TURN_NOISE * next_random(p)
    return float(math.sqrt(0.5) * (slow_deviate[which] + math.sqrt(3.0) * next_random(p)))


@compiled_exactly
def turn_factor(by: float) -> float:
    """The factor of a turn that differs by so much, within what a hand does."""
    return 1.0 + min(max(by, -MAX_UNEVEN), MAX_UNEVEN)


@compiled_exactly
def total(numbers: Any) -> float:
    """Their sum."""
    found = 0.0
    for number in numbers:
        found += number
    return found


@compiled_exactly
def is_playing(p: Any, drift: int) -> bool:
    """Whether the player moves what drifts, and nobody else."""
    if p.sounding < 0:
        return False
    index = BOW_SPEED
    if drift == FORCE_DRIFT:
        index = BOW_PRESSURE if p.taken[BOW_FORCE] == 0 and p.is_held[BOW_FORCE] == 0 else BOW_FORCE
    elif drift == PLACE_DRIFT:
        index = BOW_POSITION
    elif drift == CENTS_DRIFT:
        index = FINGER_POSITION[p.finger]
    elif drift == PRESS_DRIFT:
        index = FINGER_PRESS[p.finger]
    return bool(p.taken[index] == 0 and p.is_held[index] == 0)


@compiled_exactly
def heard_semitones(p: Any) -> float:
    """The finger's drift in what is heard now."""
    return float(p.drift_state.cents[LATE] / 100.0)
