"""Slow drift and tremor of the hands that hold bow and finger. Compiled.

The drift of a hand has a spectrum of about 1/f ([Gilden]), from four random sequences whose times
are two octaves apart; tremor is a resonance about 10 Hz, where that of hands is ([Elble]). What one
hand does goes together: a bow that is drawn faster is pressed harder. `/playing/variation` says how
much, and `/engine/seed` which; a parameter that somebody else moves is steady.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.record import (
    CENTS_DRIFT,
    DRIFT_COUNT,
    FORCE_DRIFT,
    POSITION_DRIFT,
    PRESS_DRIFT,
    SPEED_DRIFT,
)
from yehu_server.core.physics.elementary import cos, elementwise, exp, pseudorandom
from yehu_server.core.player.ear import HOP_S
from yehu_server.core.player.parameter_indices import BOW, FINGER_POSITION, FINGER_PRESS, PLAYING
from yehu_server.core.player.stroke_contours import QUANTITIES

# Standard deviations at full variation, in the order of ``controls.record``. By ear.
DRIFT = np.array((0.06, 0.06, 0.04, 4.8, 0.06))
TREMOR = np.array((0.04, 0.05, 0.02, 2.5, 0.04))
RIGHT, LEFT = 0, 1
HAND = np.array((RIGHT, RIGHT, RIGHT, LEFT, LEFT))
# The drift with which the others of the same hand correlate.
LEADING = np.array((SPEED_DRIFT, SPEED_DRIFT, SPEED_DRIFT, CENTS_DRIFT, CENTS_DRIFT))
CORRELATION = 0.6  # with it

# A vibrato's cycles differ: standard deviations of rate and depth at full variation, by ear less
# than violinists' [Seashore]. Half of the variance is slow: its correlation from cycle to cycle.
RATE_VARIATION, DEPTH_VARIATION = 0.4, 0.4
CYCLE_CORRELATION = 0.85
CYCLE_NOISE = math.sqrt(3.0 * (1.0 - CYCLE_CORRELATION * CYCLE_CORRELATION))
MAX_VARIATION = 0.5  # of rate and depth, up or down
SMOOTHING_PER_HOP = 0.15  # of the way to the factors of the next cycle

TIME_CONSTANTS_S = np.array((0.04, 0.16, 0.64, 2.56))  # of the sequences whose sum is the drift
STAGES = 4
# The pitch drifts more, by so many cents at full variation and phrasing, to and fro in some 0.6
# s: so a note moves within, and its mean is in tune.
MORE_CENTS, SLOW_HZ, SLOW_WIDTH_HZ = 30.0, 1.6, 0.8
POLES = elementwise(exp, -HOP_S / TIME_CONSTANTS_S)
# Uniform numbers in -1..1 have a variance of 1/3; the sums have one of 1.
NOISE_GAINS = np.sqrt(3.0 * (1.0 - POLES**2) / STAGES)
TREMOR_HZ, WIDTH_HZ = 10.0, 3.0


def resonance(hz: float, width_hz: float) -> tuple[float, float, float]:
    """Of a resonance of noise, of variance 1: factors on its last values, and on the noise."""
    radius = exp(-math.pi * width_hz * HOP_S)
    one, two = 2.0 * radius * cos(2.0 * math.pi * hz * HOP_S), radius * radius
    left = (1.0 - two) * ((1.0 + two) * (1.0 + two) - one * one) / (1.0 + two)
    return one, two, math.sqrt(3.0 * left)


TREMOR_A_1, TREMOR_A_2, TREMOR_NOISE = resonance(TREMOR_HZ, WIDTH_HZ)
SLOW_A_1, SLOW_A_2, SLOW_NOISE = resonance(SLOW_HZ, SLOW_WIDTH_HZ)
HANDS = 2
DECAY_PER_HOP, NEGLIGIBLE = (0.8, 1e-6)  # how a hand that does not play comes to rest
DETECTION_DELAY_HOPS = 2  # of what a finger does, by the ear
SEQUENCE_OFFSET = 1 << 31  # of the seed's numbers; those before are the notes' (``phrasing``)

DRIFT_STATE = np.dtype(
    [
        ("slow", np.float64, (DRIFT_COUNT, STAGES)),  # the sequences of each drift
        ("tremor", np.float64, (HANDS, 2)),  # of each hand, now and one hop ago
        ("within", np.float64, 2),  # the pitch's motion within notes, as the tremor
        ("cents", np.float64, DETECTION_DELAY_HOPS + 1),  # of the finger, now and at the last hops
        ("phase", np.float64),  # of the vibrato, one hop ago (turns)
        (
            "slow_deviate",
            np.float64,
            2,
        ),  # of the vibrato's rate and width, which changes from turn to turn
        ("rate_deviate", np.float64),  # of this cycle of the vibrato
        ("depth_deviate", np.float64),
        ("random_count", np.int64),  # random numbers so far
    ],
    align=True,
)


@compiled_exactly
def next_random(p: Any) -> float:
    """The next random number, -1 to 1."""
    p.drift_state.random_count += 1
    return pseudorandom((p.seed << 32) + SEQUENCE_OFFSET + p.drift_state.random_count)


@compiled_exactly
def advance_drift(p: Any, c: Any) -> None:
    """Advance drift and tremor of the hands by one hop."""
    u, amount = p.drift_state, p.value[PLAYING.variation]
    for hand in range(HANDS):
        now, before = u.tremor[hand, 0], u.tremor[hand, 1]
        u.tremor[hand, 0] = TREMOR_A_1 * now - TREMOR_A_2 * before + TREMOR_NOISE * next_random(p)
        u.tremor[hand, 1] = now
    now = u.within[0]
    u.within[0] = SLOW_A_1 * now - SLOW_A_2 * u.within[1] + SLOW_NOISE * next_random(p)
    u.within[1] = now
    for i in range(DRIFT_COUNT):
        for k in range(STAGES):
            u.slow[i, k] = POLES[k] * u.slow[i, k] + NOISE_GAINS[k] * next_random(p)
    contours = p.contours
    c.drifting = 0
    for i in range(DRIFT_COUNT):
        drift = sum_of(u.slow[i])
        if i != LEADING[i]:
            drift = (
                CORRELATION * sum_of(u.slow[LEADING[i]]) + math.sqrt(1.0 - CORRELATION**2) * drift
            )
        is_own, before, contour = is_owned(p, i), 0.0, 0.0
        if i < QUANTITIES:
            before, contour = contours.before[i], contours.value[i]
        own = amount * (DRIFT[i] * drift + TREMOR[i] * u.tremor[HAND[i], 0])
        if i == CENTS_DRIFT:
            own += amount * MORE_CENTS * p.value[PLAYING.phrasing] * u.within[0]
        if amount == 0.0 or p.sounding < 0 or not is_own:
            left = c.drift[i] - (before if is_own else 0.0)
            own = DECAY_PER_HOP * left if abs(left) > NEGLIGIBLE else 0.0
        wanted = own + contour if is_own else own
        c.drift_slope[i] = (wanted - c.drift[i]) / p.ear.hop
        if wanted == 0.0 and abs(c.drift[i]) <= NEGLIGIBLE:
            c.drift[i] = c.drift_slope[i] = 0.0
        c.drifting |= 1 if c.drift[i] != 0.0 or c.drift_slope[i] != 0.0 else 0
    gain = contours.gain if is_owned(p, SPEED_DRIFT) else 0.0
    c.swell_slope = (gain - c.swell) / p.ear.hop
    if gain == 0.0 and abs(c.swell) <= NEGLIGIBLE:
        c.swell = c.swell_slope = 0.0
    c.drifting |= 1 if c.swell != 0.0 or c.swell_slope != 0.0 else 0
    if c.drifting == 0:
        c.sounding_drift = c.position_drift = 1.0
    for k in range(DETECTION_DELAY_HOPS, 0, -1):
        u.cents[k] = u.cents[k - 1]
    u.cents[0] = c.drift[CENTS_DRIFT]


@compiled_exactly
def vary_vibrato(p: Any, c: Any) -> None:
    """Let the vibrato's rate and depth follow the deviates of its cycle."""
    u, amount = p.drift_state, p.value[PLAYING.variation] if p.sounding >= 0 else 0.0
    if c.vibrato < u.phase:
        u.rate_deviate, u.depth_deviate = next_cycle_deviate(p, 0), next_cycle_deviate(p, 1)
    u.phase = c.vibrato
    c.vibrato_rate_factor += SMOOTHING_PER_HOP * (
        cycle_factor(amount * RATE_VARIATION * u.rate_deviate) - c.vibrato_rate_factor
    )
    c.vibrato_depth_factor += SMOOTHING_PER_HOP * (
        cycle_factor(amount * DEPTH_VARIATION * u.depth_deviate) - c.vibrato_depth_factor
    )
    if (
        amount == 0.0
        and max(abs(c.vibrato_rate_factor - 1.0), abs(c.vibrato_depth_factor - 1.0)) < NEGLIGIBLE
    ):
        c.vibrato_rate_factor = c.vibrato_depth_factor = 1.0


@compiled_exactly
def next_cycle_deviate(p: Any, which: int) -> float:
    """A deviate of the vibrato's next cycle, of variance 1: of its rate (0) or its depth (1)."""
    slow_deviate = p.drift_state.slow_deviate
    slow_deviate[which] = CYCLE_CORRELATION * slow_deviate[which] + CYCLE_NOISE * next_random(p)
    return float(math.sqrt(0.5) * (slow_deviate[which] + math.sqrt(3.0) * next_random(p)))


@compiled_exactly
def cycle_factor(deviation: float) -> float:
    """The factor of a cycle, from its deviation, which is limited to what a hand does."""
    return 1.0 + min(max(deviation, -MAX_VARIATION), MAX_VARIATION)


@compiled_exactly
def sum_of(numbers: Any) -> float:
    """The sum of numbers, in their order."""
    total = 0.0
    for number in numbers:
        total += number
    return total


@compiled_exactly
def is_owned(p: Any, drift: int) -> bool:
    """Whether the player moves what drifts, and nobody else."""
    index = BOW.speed
    if drift == FORCE_DRIFT:
        index = BOW.pressure if p.taken[BOW.force] == 0 and p.is_held[BOW.force] == 0 else BOW.force
    elif drift == POSITION_DRIFT:
        index = BOW.position
    elif drift == CENTS_DRIFT:
        index = FINGER_POSITION[p.finger]
    elif drift == PRESS_DRIFT:
        index = FINGER_PRESS[p.finger]
    return bool(p.taken[index] == 0 and p.is_held[index] == 0)


@compiled_exactly
def heard_semitones(p: Any) -> float:
    """The finger's drift in what is heard now."""
    return float(p.drift_state.cents[DETECTION_DELAY_HOPS] / 100.0)
