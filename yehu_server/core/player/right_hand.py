"""The right hand: draws the bow, or plucks, as a finger of the left hand may. Compiled."""

import math
from typing import Any

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.physics.elementary import exp2, log2
from yehu_server.core.player import bowing, gestures
from yehu_server.core.player.fingering import OPEN
from yehu_server.core.player.harmonics import HARMONIC_BOW_POSITION, NONE
from yehu_server.core.player.intonation import in_tables
from yehu_server.core.player.ownership import DEFAULT_RAMP_MS, invalidate_sent, move_parameter
from yehu_server.core.player.parameter_indices import (
    BOW,
    FINGER_COUNT,
    FINGER_PRESS,
    PLAYING,
    PLUCK,
)
from yehu_server.core.player.phrasing import (
    HURRIED_ATTACK_MS,
    HURRIED_WEIGHT,
    INNER,
    USUAL_PHRASING,
    hurried,
)
from yehu_server.core.player.velocity import (
    ATTACK_PRESSURE_MS,
    attack_pressure_factor,
    struck_speed,
)
from yehu_server.params.table import find

Array = Any

# Part of the time of an attack or a slur in which the bow changes to the other string, and the most
# time; it meets that string half-way. Sooner, the string left rings on; later, there is a gap.
CROSSING_PART, CROSSING_MS = 0.65, 36.0
LIFT_BEFORE_PLUCK_MS = 20.0  # before a pluck
SLURRED_MS = 25.0  # ramp of bow speed from one slurred note to the next
# Bow speed at dynamics 0, as a fraction of that at full dynamics. By ear.
MIN_SPEED_FRACTION = 0.45
# Factor on the dynamics of the whole range of intensity, as a power of 2, for some 20 dB: 15 below
# its default, 5 above.
INTENSITY_OCTAVES = 1.75
DEFAULT_INTENSITY = find("/playing/intensity").default
MIN_DYNAMICS = 0.012  # below, at the first two steps of a controller, the bow is lifted
# A heavy stroke on the inner string begins with this share of its pressure: with more, the first
# periods are too long and the note begins flat. Under MIN_INNER_ATTACK it may slip twice in a
# period. Tried at 0.3 to 0.9 and 60 to 200 ms, F4 to B4, at three dynamics. Hurried strokes have
# little pressure already.
INNER_ATTACK_FRACTION, MIN_INNER_ATTACK, INNER_ATTACK_MS = 0.65, 0.4, 150.0
# A quick stroke on the outer string turns with this share of Schelleng's limit, where it has less;
# one that takes SLOW_ATTACK_MS, as a single note's, with no more: the sooner the bow has its speed,
# the more force it needs until the string has caught it [Guettler], or that slips twice in a period
# for all of a short note. Before the bow has turned the old note would burst out. Tried at 1 to 2
# on a yehu and an erhu, notes of 0.1 to 0.3 s; by a factor of 2.8 on what each note has, those that
# have much were rough. Up to 80 ms, single high notes of an erhu were 19 cents flat.
QUICK_SHARE, SLOW_ATTACK_MS = 1.25, 40.0
# Louder is heavier and nearer to the bridge [Schoonderwaldt], at phrasing USUAL_PHRASING: powers of
# what dynamics and velocity do to the speed, and the largest factor. By ear.
ARM_FORCE, ARM_PLACE, MAX_ARM = 0.25, -0.2, 1.2
# Force of a pluck at medium pressure. By ear.
PLUCK_FORCE_N, MEDIUM_PRESSURE = 1.0, 0.4
MAX_PLUCK_FORCE_N = find("/pluck/force").hi
DEFAULT_PLUCK_POSITION = find("/pluck/position").default


@compiled_exactly
def requested_dynamics(p: Any) -> float:
    """The dynamics that are asked for, with the intensity: 1 at the defaults."""
    octaves = INTENSITY_OCTAVES * (p.value[PLAYING.intensity] - DEFAULT_INTENSITY)
    return float(p.value[PLAYING.dynamics] * exp2(octaves))


@compiled_exactly
def requested_speed(p: Any) -> float:
    """The bow speed that is asked for (m/s)."""
    fraction = MIN_SPEED_FRACTION + (1.0 - MIN_SPEED_FRACTION) * requested_dynamics(p)
    return float(
        p.value[PLAYING.speed]
        * fraction
        * struck_speed(p)
        * p.speed_variation
        * p.stroke_speed_factor
    )


@compiled_exactly
def arm(p: Any, exponent: float) -> float:
    """What louder playing does to the bow's force or place, as a factor: a power of its speed.

    As far as phrasing says; 1 at the defaults of dynamics, intensity and velocity.
    """
    if p.value[PLAYING.phrasing] == 0.0:
        return 1.0
    louder = requested_dynamics(p) * struck_speed(p)
    exponent *= p.value[PLAYING.phrasing] / USUAL_PHRASING * (INNER if p.string == 0 else 1.0)
    power = exponent * log2(max(louder, MIN_DYNAMICS))
    return float(min(max(exp2(power), 1.0 / MAX_ARM), MAX_ARM))


@compiled_exactly
def bowing_of(p: Any, pitch: float, column: int) -> float:
    """One value of how a pitch is bowed on the string of the fingering; see `bowing_value`."""
    string = max(p.string, 0)
    stopped = in_tables(p, string, pitch)
    return bowing.bowing_value(p.bowing_table, string, requested_position(p), stopped, column)


@compiled_exactly
def requested_position(p: Any) -> float:
    """The bow position that is asked for, as a fraction of the sounding length."""
    if p.gesture.node != NONE:
        return float(HARMONIC_BOW_POSITION)
    return float(p.value[PLAYING.bow_position] * arm(p, ARM_PLACE))


@compiled_exactly
def speed_at(p: Any, pitch: float) -> float:
    """Bow speed (m/s) for a pitch: as requested and moved, up to the highest at which it speaks."""
    return float(min(requested_speed(p) * p.gesture.speed, bowing_of(p, pitch, bowing.TOP_SPEED)))


@compiled_exactly
def has_same_bowing(p: Any, pitch: float) -> bool:
    """Whether a pitch is bowed as the present one is."""
    for column in range(bowing.BOWING_SIZE):
        if bowing_of(p, pitch, column) != p.bowing[column]:
            return False
    return True


@compiled_exactly
def set_bow_pressure(p: Any, c: Any, pitch: float, is_sounding: bool) -> None:
    """Set bow pressure and position, as requested and adapted to the sounding pitch, if any."""
    pressure = (
        p.value[PLAYING.pressure]
        * p.pressure_variation
        * p.gesture.weight
        * hurried(p, HURRIED_WEIGHT)
    )
    pressure *= arm(p, ARM_FORCE)
    if is_sounding:
        for column in range(bowing.BOWING_SIZE):
            p.bowing[column] = bowing_of(p, pitch, column)
        m = p.bowing
        pressure = bowing.bow_pressure_for(
            m[bowing.AT_FLAUTANDO],
            m[bowing.AT_LIGHT],
            m[bowing.AT_FIRM],
            pressure,
            max(p.string, 0),
        )
        pressure *= p.pressure_factor
    move_parameter(p, c, BOW.pressure, pressure, DEFAULT_RAMP_MS)
    place = requested_position(p) * p.bowing[bowing.DISTANCE_FACTOR] * p.nearer
    move_parameter(p, c, BOW.position, place, DEFAULT_RAMP_MS)


@compiled_exactly
def set_attack_pressure(p: Any, c: Any) -> None:
    """Begin a hard or quick stroke with more pressure, and one on the inner string with less.

    This applies to new strokes, and to slurred notes on the string that was at rest.
    """
    usual = p.sent[BOW.pressure]
    quick = (SLOW_ATTACK_MS - gestures.attack_ms(p)) / (SLOW_ATTACK_MS - HURRIED_ATTACK_MS)
    heavier = usual + min(max(quick, 0.0), 1.0) * (QUICK_SHARE - usual)
    begins, ms = attack_pressure_factor(p) * usual, ATTACK_PRESSURE_MS
    if p.string == 0:
        lighter = max(INNER_ATTACK_FRACTION * usual, MIN_INNER_ATTACK)
        begins, ms = min(usual, lighter + p.hurry * (usual - lighter)), INNER_ATTACK_MS
    elif heavier > begins:
        p.pressure_after_turning, p.turning_pressure = usual, heavier
        move_parameter(p, c, BOW.pressure, p.turning_pressure, 0.5 * gestures.attack_ms(p))
        return
    if begins != usual:
        move_parameter(p, c, BOW.pressure, begins, 0.0)
        move_parameter(p, c, BOW.pressure, usual, ms)


@compiled_exactly
def ease_turning_pressure(p: Any, c: Any, now: float) -> None:
    """Take back what a quick stroke began with, once the bow has turned, unless it was moved."""
    if p.turning_pressure == 0.0 or now < 0.5e-3 * gestures.attack_ms(p):
        return
    if p.sent[BOW.pressure] == p.turning_pressure:
        move_parameter(p, c, BOW.pressure, p.pressure_after_turning, ATTACK_PRESSURE_MS)
    p.turning_pressure = 0.0


@compiled_exactly
def draw(p: Any, c: Any, pitch: float, side: float, ramp_ms: float) -> None:
    """Draw the bow on the string of a side; its speed changes in `ramp_ms`.

    A lifted bow attacks in ``/playing/attack`` instead. Below MIN_DYNAMICS the bow is
    lifted.
    """
    if p.value[PLAYING.dynamics] < MIN_DYNAMICS:
        if p.side != 0.0:
            lift(p, c, p.value[PLAYING.release])
        return
    if p.side == 0.0:
        ramp_ms = gestures.attack_ms(p)
    is_on_string = c.value[SLOTS.bow_side] * side < 0.0 or p.side != 0.0
    crossing_ms = min(CROSSING_PART * ramp_ms, CROSSING_MS) if is_on_string else ramp_ms / 4.0
    p.side = side
    move_parameter(p, c, BOW.side, side, crossing_ms)
    move_parameter(p, c, BOW.tremolo, gestures.tremolo_of(p), DEFAULT_RAMP_MS)
    move_parameter(p, c, BOW.tremolo_depth, gestures.tremolo_depth_of(p), DEFAULT_RAMP_MS)
    move_parameter(p, c, BOW.speed, p.direction * speed_at(p, pitch), ramp_ms)


@compiled_exactly
def lift(p: Any, c: Any, release_ms: float) -> None:
    """End the stroke in a time (ms)."""
    p.side = 0.0
    move_parameter(p, c, BOW.speed, 0.0, release_ms)
    move_parameter(p, c, BOW.side, 0.0, release_ms)


@compiled_exactly
def pluck(p: Any, c: Any, side: float) -> None:
    """Pluck the string of a side where the articulation has it; lift the bow before."""
    if p.side != 0.0:
        lift(p, c, LIFT_BEFORE_PLUCK_MS)
    if p.position == OPEN:
        clear_string(p, c)
    at = gestures.SHAPES[p.gesture.row, gestures.PLUCKED_AT]
    if at > 0.0:
        move_parameter(p, c, PLUCK.position, at, 0.0)
    elif not math.isnan(p.sent[PLUCK.position]):  # after one that was plucked elsewhere
        move_parameter(p, c, PLUCK.position, DEFAULT_PLUCK_POSITION, 0.0)
    force = (
        PLUCK_FORCE_N
        * p.value[PLAYING.pressure]
        * p.pressure_variation
        * requested_dynamics(p)
        * gestures.SHAPES[p.gesture.row, gestures.PLUCKED_BY]
        / MEDIUM_PRESSURE
    )
    move_parameter(p, c, PLUCK.force, side * min(force, MAX_PLUCK_FORCE_N), DEFAULT_RAMP_MS)
    invalidate_sent(p, PLUCK.force)  # the next one may be as hard


@compiled_exactly
def clear_string(p: Any, c: Any) -> None:
    """Take all fingers from the strings at once: one that hovers would stop what a pluck swings."""
    for finger in range(FINGER_COUNT):
        invalidate_sent(p, FINGER_PRESS[finger])
        move_parameter(p, c, FINGER_PRESS[finger], 0.0, 0.0)
        c.finger_up[finger] = c.park_after
