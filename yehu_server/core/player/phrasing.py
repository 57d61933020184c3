"""What the player adds to plain notes: vibrato, slides, and small random differences. Compiled.

Vibrato and slides only as far as `/playing/phrasing` says, and where nothing else is requested.
docs/playing.md has the rules.
"""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.physics.elementary import pseudorandom
from yehu_server.core.player.parameter_indices import PLAYING

# A sum of this many uniform numbers is nearly normal.
SUMMED_UNIFORMS = 12
# Standard deviations at full variation. By ear.
VARIED_FRACTION = 0.1  # of bow speed and pressure
VARIED_CENTS = 6.0
VARIED_LANDING, MAX_LANDING = 0.8, 2.0  # of the time of a landing; and its largest factor


@compiled_exactly
def begin_sequence(p: Any, seed: int) -> None:
    """Begin the sequence of a seed."""
    p.seed, p.random_count = seed, 0
    p.drift_state.slow[:], p.drift_state.tremor[:], p.drift_state.random_count = 0.0, 0.0, 0
    p.drift_state.slow_deviate[:], p.drift_state.within[:] = 0.0, 0.0
    p.contours.random_count = p.sway.random_count = 0


@compiled_exactly
def vary_next_note(p: Any) -> None:
    """Draw the deviates of a new note."""
    varied = p.value[PLAYING.variation] * VARIED_FRACTION
    p.speed_variation = 1.0 + varied * deviate(p)
    p.pressure_variation = 1.0 + varied * deviate(p)
    p.detuned = deviate(p)


@compiled_exactly
def chance(p: Any, number: int) -> float:
    """A random number of the player's seed, -1 to 1; without variation no seed changes it."""
    seed = p.seed if p.value[PLAYING.variation] > 0.0 else 0
    return pseudorandom((seed << 32) + number)


@compiled_exactly
def deviate(p: Any) -> float:
    """A number of mean 0 and variance 1; each of the uniform ones has a variance of 1/3."""
    total = 0.0
    for _ in range(SUMMED_UNIFORMS):
        total += chance(p, p.random_count)
        p.random_count += 1
    return total / math.sqrt(SUMMED_UNIFORMS / 3.0)


@compiled_exactly
def varied_semitones(p: Any) -> float:
    """Deviation of the sounding note from its pitch."""
    return float(p.value[PLAYING.variation] * p.detuned * VARIED_CENTS / 100.0)


@compiled_exactly
def varied_landing(p: Any, landing_ms: float) -> float:
    """The time (ms) in which a finger lands, from the usual one."""
    if p.value[PLAYING.variation] == 0.0:
        return landing_ms
    factor = 1.0 + p.value[PLAYING.variation] * VARIED_LANDING * deviate(p)
    return float(landing_ms * min(max(factor, 1.0 / MAX_LANDING), MAX_LANDING))


USUAL_PHRASING = 0.5  # the default of files, for which sizes are that say nothing else
INNER = 0.4  # share of what bow force and place do on the inner string, whose pitch they move more
# At full phrasing; by ear.
SLIDE_MS, MIN_SLIDE_MS = 130.0, 45.0
STEP_MS, SHIFT = -1.0, -2.0  # in place of the time of a slide: see ``left_hand``
# A leap asks for a slide where it is so wide (semitones), from a note and to a note so long.
MIN_LEAP, MAX_LEAP, LONG_S = 4.5, 9.5, 0.3


# Strokes that follow another within EASY_S are hurried, wholly from HURRIED_S on: the bow comes to
# its speed in a shorter time and with less pressure, and leaves sooner, so that the string sounds
# its note in the little time it has. Tried on sixteenths, 8 to 16 a second (scripts/playability.py
# detached).
EASY_S, HURRIED_S = 0.16, 0.1
HURRIED_ATTACK_MS = 14.0
# So many periods at least, in which a string is caught [Guettler]: of low notes on the inner string
# one in fifteen slipped twice in each. Tried at 5 to 14.
HURRIED_ATTACK_PERIODS = 11.0
HURRIED_WEIGHT, HURRIED_RELEASE = 0.7, 0.65  # factors


@compiled_exactly
def hurry_of(p: Any, c: Any) -> float:
    """How much a stroke that begins now is hurried, from 0 to 1."""
    if p.began < 0:
        return 0.0
    since = (c.frame - p.note_began) / p.rate
    return float(min(max((EASY_S - since) / (EASY_S - HURRIED_S), 0.0), 1.0))


@compiled_exactly
def hurried(p: Any, factor: float) -> float:
    """A factor as far as the stroke is hurried."""
    return float(1.0 + p.hurry * (factor - 1.0))


@compiled_exactly
def fingered(p: Any) -> float:
    """How far the left hand phrases, 0 to 1."""
    return float(p.value[PLAYING.phrasing] * p.value[PLAYING.left_hand])


# Scoops: how far below its pitch a note begins (cents) at USUAL_PHRASING, and how long it takes to
# come there; the shortest note that has one. The deviate above which one comes, after a rest, after
# a step up so wide (semitones), and else.
MIN_SCOOP_CENTS, MAX_SCOOP_CENTS, SCOOP_MS, SCOOPED_S = 10.0, 20.0, 110.0, 0.4
RESTED_SCOOP, RISEN_SCOOP, OTHER_SCOOP, RISE = 0.3, 0.5, 1.3, 2.5


@compiled_exactly
def scoop_of(p: Any, c: Any, rise: float) -> float:
    """Where the finger begins, from a note's pitch (semitones, not above 0), after a rise of some.

    Where the length of the note is not known, it is taken to be as long as the one before.
    """
    amount = min(fingered(p) / USUAL_PHRASING, 1.5)
    length_s = p.value[PLAYING.note_length]
    if length_s == 0.0:
        length_s = p.contours.pace_s
    if amount == 0.0 or length_s < SCOOPED_S:
        return 0.0
    limit = RISEN_SCOOP if rise > RISE else OTHER_SCOOP
    if c.value[SLOTS.bow_speed] == 0.0:
        limit = RESTED_SCOOP
    if deviate(p) < limit:
        return 0.0
    wide = 0.5 + 0.5 * chance(p, p.random_count)
    return float(-amount * (MIN_SCOOP_CENTS + (MAX_SCOOP_CENTS - MIN_SCOOP_CENTS) * wide) / 100.0)


@compiled_exactly
def slide_of_leap_ms(p: Any, c: Any, leap: float) -> float:
    """Time of a slide over a leap (semitones); STEP_MS where the finger steps.

    Not where lengths of notes are known, and so what comes: files have slides that arrive on the
    beat (``scores.slides``).
    """
    amount = fingered(p)
    if amount == 0.0 or c.value[SLOTS.bow_side] == 0.0 or p.value[PLAYING.note_length] > 0.0:
        return STEP_MS
    is_wide = MIN_LEAP < abs(leap) < MAX_LEAP
    is_long = c.frame - p.note_began > LONG_S * p.rate
    if not is_wide or not is_long:
        return STEP_MS
    return float(MIN_SLIDE_MS + (SLIDE_MS - MIN_SLIDE_MS) * amount)
