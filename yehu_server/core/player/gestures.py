"""The gesture of a note: the steps of both hands that its articulation asks for. Compiled.

The steps are those of ``params.articulations``. A note's gesture begins with it; each 5 ms
``articulating`` checks which steps are due. An ordinary note is shaped as phrasing says.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.physics.elementary import exp, exp2, log10
from yehu_server.core.player.harmonics import GAINS_DB, NONE, node_of, string_of
from yehu_server.core.player.parameter_indices import PLAYING
from yehu_server.core.player.phrasing import (
    HURRIED_ATTACK_MS,
    HURRIED_ATTACK_PERIODS,
    HURRIED_RELEASE,
    USUAL_PHRASING,
    deviate,
    hurried,
)
from yehu_server.core.player.velocity import struck_attack
from yehu_server.params.articulations import ARTICULATIONS, Articulation

ORDINARY = 0
# The attack of an ordinary note at USUAL_PHRASING: its factor for a short note and for a long
# one (s). By ear; in recordings of an erhu and a violin a tenth of the notes rise within 30 ms and
# half in 120 to 250.
USUAL_S = 1.2
SHORT_ATTACK, LONG_ATTACK, LONG_S, UNEVEN_ATTACK = 0.8, 3.4, 1.2, 0.3
# The same of a bow that turns, and the least: the level falls by up to 12 dB then in nine of ten, a
# fiddle's by 5 to 15; at 0.4 by 13, at 0.8 by more (scripts/liveliness.py). At 0.22 some notes
# begin an octave up.
TURNING = 0.3
# How much longer the bow takes to leave the string after a note of LONG_S, so that there is no hole
# between phrases (scripts/liveliness.py: dips of 28 to 34 dB without).
EASED_RELEASE = 0.9
MIN_STOPPED_PITCH = 65.6  # MIDI note: a finger there is over 8 mm from the loop
STEPS_FRACTION = 0.7  # of a note, for steps that have times of their own
# The level is this power of the bow's factor, on top of what a faster bow gives, as with dynamics.
LEVEL_EXPONENT, MIN_FACTOR = 0.6, 0.1

ROWS = len(ARTICULATIONS)

AT, AT_SHARE, RAMP, RAMP_SHARE, SPEED, WEIGHT, IS_ON, TURNS = range(8)  # of a bow's step
SEMITONES, GLIDE = 2, 3  # of a finger's, after AT and AT_SHARE
ATTACK, LENGTH, REPEAT_MS, SHORTENING, MAX_ROUNDS, STROKES, DEPTH, IS_PLUCKED = range(8)
PLUCKED_AT, PLUCKED_BY = 8, 9  # of the same rows
CENTS, HERTZ, PRESS, UPWARD, DELAY_MS = range(5)  # of a vibrato


def _padded(rows: Sequence[Sequence[Sequence[float]]], columns: int) -> Any:
    most = max(len(steps) for steps in rows)
    table = np.zeros((len(rows), max(most, 1), columns))
    for number, steps in enumerate(rows):
        for at, step in enumerate(steps):
            table[number, at] = step
    return table


BOW_COUNT = np.array([len(row.bow) for row in ARTICULATIONS])
FINGER_COUNT = np.array([len(row.fingers) for row in ARTICULATIONS])
BOW_STEPS = _padded([
    [
        (step.at_ms, step.at_share, step.ramp_ms, step.ramp_share, step.speed, step.weight,
         step.is_on, step.turns)
        for step in row.bow
    ]
    for row in ARTICULATIONS
], 8)  # fmt: skip
FINGER_STEPS = _padded(
    [
        [(step.at_ms, step.at_share, step.semitones, step.glide_ms) for step in row.fingers]
        for row in ARTICULATIONS
    ],
    4,
)
SHAPES = np.array([
    (row.attack, row.length_s, row.repeat_ms, row.speed_up, row.times or math.inf, row.tremolo,
     row.tremolo_depth, row.is_plucked, row.pluck_position, row.pluck_force)
    for row in ARTICULATIONS
])  # fmt: skip


def _reach(row: Articulation) -> tuple[float, float]:
    """How far slides and vibrato take a finger from the note's pitch, down and up (semitones)."""
    has_slide = any(step.glide_ms for step in row.fingers)
    slides = [step.semitones for step in row.fingers if has_slide]
    wide = 0.01 * row.vibrato.cents if row.vibrato else 0.0
    return min(0.0, -wide, *slides), max(0.0, wide, *slides)


REACH = np.array([_reach(row) for row in ARTICULATIONS])
# Whether finger and bow are free for a slide over a leap: the one moves no other way, the other
# neither stops nor leaves the string before the finger is there.
BEARS_SLIDE = np.array([
    not (row.fingers or row.is_plucked or row.touches)
    and all(step.is_on and step.speed > 0.0 for step in row.bow)
    for row in ARTICULATIONS
])  # fmt: skip
# Whether another finger beats above the note's pitch.
BEATS = np.array([any(step.semitones > 0.0 for step in row.fingers) for row in ARTICULATIONS])
TOUCHES = np.array([row.touches for row in ARTICULATIONS])
HAS_VIBRATO = np.array([row.vibrato is not None for row in ARTICULATIONS])
VIBRATOS = np.array([
    (row.vibrato.cents, row.vibrato.hertz, row.vibrato.press, row.vibrato.upward,
     row.vibrato.delay_ms)
    if row.vibrato else (0.0,) * 5
    for row in ARTICULATIONS
])  # fmt: skip

# How far the steps of a hand are: the next one, how often they came before, and the time after the
# note's beginning from which they count (s).
TRACK = np.dtype([("step", np.int64), ("times", np.int64), ("begins", np.float64)], align=True)

GESTURE = np.dtype(
    [
        ("row", np.int64),  # of the tables above
        ("attack", np.float64),  # factor
        ("bow", TRACK),
        ("speed", np.float64),  # factors
        ("weight", np.float64),
        ("time_factor", np.float64),  # of the steps, below 1 in a note that is too short for them
        ("gain_db", np.float64),  # of the level, that follows the bow's speed
        ("gain_to", np.float64),  # where it goes (dB)
        ("gain_step", np.float64),  # by so much in each 5 ms
        ("move_ends", np.float64),  # when the bow's move ends (s after the note's beginning)
        ("is_off", np.int64),  # whether the hair is lifted
        ("node", np.int64),  # of `harmonics.NODES`, that the finger touches; else NONE
        ("finger", TRACK),
        ("bend", np.float64),  # where the finger is from the note's pitch (semitones)
        # The slide it is in: ends (semitones), time after the note's beginning, duration (s).
        ("slide_from", np.float64),
        ("slide_to", np.float64),
        ("slide_at", np.float64),
        ("slide_s", np.float64),  # 0: none
    ],
    align=True,
)


RESTING = np.zeros(1, GESTURE)[0]  # as `rest` leaves it
for _field in ("attack", "speed", "weight", "time_factor"):
    RESTING[_field] = 1.0
RESTING["node"] = NONE


@compiled_exactly
def rest(g: Any) -> None:
    """Do nothing: a steady bow, the finger on the note's pitch."""
    g.row, g.attack = ORDINARY, 1.0
    g.bow.step = g.bow.times = g.finger.step = g.finger.times = 0
    g.bow.begins = g.finger.begins = 0.0
    g.speed = g.weight = g.time_factor = 1.0
    g.gain_db = g.gain_to = g.gain_step = 0.0
    g.move_ends, g.is_off, g.bend, g.slide_s, g.node = 0.0, 0, 0.0, 0.0, NONE


@compiled_exactly
def begin_gesture(p: Any, c: Any, is_slur: bool) -> None:
    """Begin the gesture of a note; on a slur the bow goes on as it is."""
    g = p.gesture
    rest(g)
    number = int(np.rint(p.value[PLAYING.articulation]))
    g.row = number if 0 <= number < ROWS else ORDINARY
    if g.row == ORDINARY and p.value[PLAYING.phrasing] > 0.0:
        shape(p, c)
    g.attack *= SHAPES[g.row, ATTACK]
    g.time_factor = time_factor_of(p, g.row)
    if TOUCHES[g.row]:
        touch(p)
    if is_slur and SHAPES[g.row, STROKES] == 0.0:
        g.bow.step = BOW_COUNT[g.row]
    while g.bow.step < BOW_COUNT[g.row] and is_immediate(BOW_STEPS[g.row, g.bow.step]):
        step = BOW_STEPS[g.row, g.bow.step]
        g.speed, g.weight = step[SPEED], step[WEIGHT]
        g.bow.step += 1
    g.gain_db = g.gain_to = gain_of(g)
    if g.bow.step < BOW_COUNT[g.row]:
        step = BOW_STEPS[g.row, g.bow.step]
        if step[AT] == step[AT_SHARE] == 0.0:  # a swell, which begins once the bow is there
            g.bow.begins = 1e-3 * attack_ms(p)
    if FINGER_COUNT[g.row] > 0:
        first = FINGER_STEPS[g.row, 0]
        if first[AT] == first[AT_SHARE] == first[GLIDE] == 0.0:
            g.bend = within_reach(p, first[SEMITONES])
            g.finger.step = 1


@compiled_exactly
def touch(p: Any) -> None:
    """Touch the open string at the node that the key is, if it is one: it is bowed as that."""
    key = p.held_pitch[p.sounding]
    p.gesture.node = node_of(p, key)
    if p.gesture.node != NONE:
        p.gesture.bend = p.open_note[string_of(p.gesture.node)] - key


@compiled_exactly
def within_reach(p: Any, semitones: float) -> float:
    """Where a finger can be, from the note's pitch: not lower than the lowest that one stops."""
    lowest = MIN_STOPPED_PITCH - p.held_pitch[p.sounding]
    return float(max(semitones, min(lowest, 0.0)))


@compiled_exactly
def shape(p: Any, c: Any) -> None:
    """Shape the attack of an ordinary note as far as phrasing says.

    Only after a rest the bow comes slowly; one that still moves turns at once. What comes after is
    in ``contours``.
    """
    g = p.gesture
    amount = min(p.value[PLAYING.phrasing] / USUAL_PHRASING, 1.5)
    length = p.value[PLAYING.note_length] if p.value[PLAYING.note_length] > 0.0 else USUAL_S
    uneven = 1.0 + UNEVEN_ATTACK * deviate(p) * min(4.0 * p.value[PLAYING.variation], 1.0)
    factor = TURNING / max(struck_attack(p), 1.0)
    if c.value[SLOTS.bow_speed] == 0.0:
        longer = min(length / LONG_S, 1.0)
        factor = SHORT_ATTACK + (LONG_ATTACK - SHORT_ATTACK) * longer
    factor *= max(uneven, 0.4)
    g.attack = max(1.0 + amount * (factor - 1.0), TURNING)


@compiled_exactly
def note_length(p: Any, row: int) -> float:
    """The length of the note (s), or what is assumed of it."""
    known = p.value[PLAYING.note_length]
    return float(known if known > 0.0 else SHAPES[row, LENGTH])


@compiled_exactly
def time_factor_of(p: Any, row: int) -> float:
    """Factor on the times of a gesture's steps, so that they fit into a note of a known length.

    A gesture that repeats keeps its times.
    """
    length_ms = 1e3 * p.value[PLAYING.note_length]
    factor = 1.0
    if length_ms == 0.0 or SHAPES[row, REPEAT_MS] > 0.0:
        return factor
    for i in range(BOW_COUNT[row]):
        step = BOW_STEPS[row, i]
        factor = min(factor, fitting(step[AT] + step[RAMP], step[AT_SHARE], length_ms))
    for i in range(FINGER_COUNT[row]):
        step = FINGER_STEPS[row, i]
        factor = min(factor, fitting(step[AT] + step[GLIDE], step[AT_SHARE], length_ms))
    return factor


@compiled_exactly
def fitting(needed_ms: float, at_share: float, length_ms: float) -> float:
    """Factor by which a time fits into what of a note is left after a share of it."""
    left_ms = STEPS_FRACTION * (1.0 - at_share) * length_ms
    return float(left_ms / needed_ms if needed_ms > left_ms else 1.0)


@compiled_exactly
def gain_of(g: Any) -> float:
    """Gain of the level (dB) at the bow's factor on its speed, beyond what the speed gives."""
    own = GAINS_DB[string_of(g.node)] if g.node != NONE else 0.0
    if g.is_off != 0 or g.speed <= MIN_FACTOR:
        return float(own)
    return float(own + 20.0 * LEVEL_EXPONENT * log10(g.speed))


@compiled_exactly
def is_immediate(step: Any) -> bool:
    """Whether a step of the bow is the state that a note begins in."""
    return bool(step[AT] == step[AT_SHARE] == step[RAMP] == step[RAMP_SHARE] == 0.0)


@compiled_exactly
def attack_ms(p: Any) -> float:
    """The time in which a lifted bow reaches its speed and force."""
    usual = p.value[PLAYING.attack] * struck_attack(p) * p.gesture.attack
    hz = p.a4 * exp2((p.held_pitch[max(p.sounding, 0)] - 69.0) / 12.0)
    quickest = max(HURRIED_ATTACK_MS, 1e3 * HURRIED_ATTACK_PERIODS / hz)
    return float(usual + p.hurry * min(quickest - usual, 0.0))


@compiled_exactly
def release_ms(p: Any, c: Any) -> float:
    """The time in which the bow leaves the string: longer after a long note, as phrasing says."""
    long = min((c.frame - p.note_began) / (LONG_S * p.rate), 1.0)
    eased = min(p.value[PLAYING.phrasing] / USUAL_PHRASING, 1.5) * EASED_RELEASE * long
    if p.gesture.row != ORDINARY:
        eased = 0.0
    return float(p.value[PLAYING.release] * hurried(p, HURRIED_RELEASE) * (1.0 + eased))


@compiled_exactly
def tremolo_of(p: Any) -> float:
    """Strokes a second: as requested, else the gesture's."""
    requested = p.value[PLAYING.tremolo]
    return float(requested if requested > 0.0 else SHAPES[p.gesture.row, STROKES])


@compiled_exactly
def tremolo_depth_of(p: Any) -> float:
    """How deep a tremolo is: as requested where there is a request for one, else the gesture's."""
    requested = p.value[PLAYING.tremolo_depth]
    return float(requested if p.value[PLAYING.tremolo] > 0.0 else SHAPES[p.gesture.row, DEPTH])


@compiled_exactly
def begin_slide(p: Any, from_semitones: float, to_semitones: float, at_s: float, s: float) -> None:
    """Begin to slide the finger; times in seconds after the note's beginning."""
    g = p.gesture
    g.slide_from, g.slide_to, g.slide_at, g.slide_s = from_semitones, to_semitones, at_s, s
    g.bend = from_semitones


STEEP = 3.0  # of the logistic curve that slides follow


@compiled_exactly
def slide_position(g: Any, at_s: float) -> float:
    """Where a slide is (semitones) at a time; logistic in time, as huqin players' are [Yang]."""
    part = min(max((at_s - g.slide_at) / g.slide_s, 0.0), 1.0)
    end = 1.0 / (1.0 + exp(-STEEP))
    come = 1.0 / (1.0 + exp(-STEEP * (2.0 * part - 1.0)))
    come = 0.5 + (come - 0.5) * 0.5 / (end - 0.5)
    return float(g.slide_from + (g.slide_to - g.slide_from) * come)
