"""What a bow arm does within a stroke: curves of the bow's speed, force and place. Compiled.

Each of the three has an arch over the stroke, two cubic Bézier segments [MaestreBlaauw], from how
the stroke begins to its peak and from there to how it ends, and a wandering beside it, whose
segments follow each other as long as it lasts. Loud is fast, heavy and near to the bridge, as
players coordinate them [Schoonderwaldt]; in the wandering force and place go their own ways. Where
the length of a note is not known, the arch's second half is slow, and the release bends it to its
end. A segment begins with the value and the slope that are there, so that nothing jumps, but for
the arch of a new stroke, as the bow turns. All of it scales with `/playing/phrasing`, and
`/engine/seed` says which.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.controls.record import FORCE_DRIFT, POSITION_DRIFT, SPEED_DRIFT
from yehu_server.core.controls.slots import SLOTS
from yehu_server.core.physics.elementary import exp2, log2
from yehu_server.core.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    FLAUTANDO,
    SCRATCHY,
    TOP_SPEED,
)
from yehu_server.core.player.brilliance import HARDER, NEARER
from yehu_server.core.player.ear import HOP_S
from yehu_server.core.player.fingering import OPEN
from yehu_server.core.player.gestures import BOW_COUNT, FINGER_COUNT, IS_PLUCKED, SHAPES, tremolo_of
from yehu_server.core.player.harmonics import NONE
from yehu_server.core.player.ownership import move_parameter
from yehu_server.core.player.parameter_indices import BODY, BOW, PLAYING, SLOT_OF
from yehu_server.core.player.phrasing import INNER, USUAL_PHRASING, chance
from yehu_server.core.player.velocity import NEUTRAL_VELOCITY
from yehu_server.params.spec import TURNED_ON

# The sizes below are for USUAL_PHRASING. In trials by controllers partials, level and swell of dry
# notes came into the range of recordings by such curves (scripts/liveliness.py).
QUANTITIES = 3  # in the order of the drifts: speed, force, place
# Factors less 1 at the beginning, the peak and the end of a stroke.
BEGINS = np.array((-0.23, 0.08, 0.05))
PEAKS = np.array((0.13, 0.14, -0.08))
ENDS = np.array((-0.14, -0.12, 0.06))  # not slower: the bow that turns adds to the gap
UNEVEN, SMALLEST, LARGEST = 0.25, 0.5, 1.3  # standard deviation of an arch's size; bounds
# Where the peak is, as a share of the stroke: of a down-bow, of an up-bow, and how much sooner in
# the hardest note; its standard deviation; how much later force and place have theirs.
DOWN_PEAK, UP_PEAK, HARDER_PEAK, UNEVEN_PEAK = 0.34, 0.5, 0.3, 0.07
LATER = np.array((0.0, 0.06, 0.03))
# Of the wandering: standard deviations, and the times of a segment (s).
WANDERS = np.array((0.06, 0.24, 0.14))
SHORTEST_S = np.array((0.3, 0.18, 0.3))
LONGEST_S = np.array((0.6, 0.4, 0.6))
MAX_DEVIATE = 2.0
# A note of unknown length comes to its peak in this time, and eases off in that one.
OPEN_PEAK_S, OPEN_EASE_S = 0.45, 2.5
SMALL_S, WHOLE_S = 0.12, 0.45  # lengths of a note that has no arch, and of one that has all of it
BEATING = 0.7  # share of it under a finger that beats or slides
LIGHT = 0.4  # share of the force's where the bow is to be light or to scratch
LOUDER = 1.1  # the level is this power of the speed, beside what the speed does
# Harder and nearer is brighter (``brilliance``): the shelf's decibels for an octave of the
# centroid, and the most; changes that are not heard.
SHELF_DB, MAX_SHELF_DB, FINE_DB = 13.0, 5.0, 0.02
INNER_SPEED = 0.6  # share of the speed's on the inner string, which turns flat under a fast bow
MAX_FORCE, MAX_PLACE, MAX_SPEED, MIN_SPEED = 0.45, 0.3, 0.28, 0.68
CONTOURS_FROM = 1 << 30  # of the seed's numbers; `phrasing` has those before, `drift` some after

FADING_S = 0.08  # into a note that has none
GAIN_DECAY = 0.9  # per hop, of the level of what rings
# A cubic Bézier segment: where it begins and with which slope (a second), where it comes to rest;
# when it begins and how long it lasts (s); its value and slope now.
SEGMENT = np.dtype(
    [
        *((name, np.float64) for name in ("a", "slope", "b", "begins", "lasts", "now", "rate")),
        ("peaks", np.int64),  # whether the stroke's end follows
    ],
    align=True,
)
CONTOURS = np.dtype(
    [
        ("arch", SEGMENT, QUANTITIES),
        ("wander", SEGMENT, QUANTITIES),
        ("amount", np.float64),  # of the arch in this note, and of the wandering
        ("wandering", np.float64),
        ("is_on", np.int64),  # whether anything moves
        ("length_s", np.float64),  # of the note; 0: not known
        ("began", np.int64),  # the frame at which the note did
        ("pace_s", np.float64),  # since the note before began
        ("value", np.float64, QUANTITIES),  # factors less 1
        ("before", np.float64, QUANTITIES),  # the same one hop ago
        ("gain", np.float64),  # of the level, less 1
        ("bright_db", np.float64),  # more of the shelf
        ("random_count", np.int64),
    ],
    align=True,
)


@compiled_exactly
def next_chance(p: Any, drawn: Any, start: int) -> float:
    """The next random number, -1 to 1, of those that a record has drawn from `start` on."""
    drawn.random_count += 1
    return chance(p, start + drawn.random_count)


@compiled_exactly
def next_deviate(p: Any, drawn: Any, start: int) -> float:
    """A number of mean 0 and variance 1, within 3; a uniform one has one of 1/3."""
    total = next_chance(p, drawn, start) + next_chance(p, drawn, start)
    return total + next_chance(p, drawn, start)


@compiled_exactly
def contour_deviate(p: Any) -> float:
    """The same, within MAX_DEVIATE."""
    total = next_deviate(p, p.contours, CONTOURS_FROM)
    return float(min(max(total, -MAX_DEVIATE), MAX_DEVIATE))


@compiled_exactly
def has_contours(p: Any) -> bool:
    """Whether the sounding note is an ordinary stroke, whatever its finger does."""
    row = p.gesture.row
    is_plucked = p.value[PLAYING.pizzicato] >= TURNED_ON or SHAPES[row, IS_PLUCKED] != 0.0
    is_free = BOW_COUNT[row] == 0 and not is_plucked and tremolo_of(p) == 0.0
    return bool(p.value[PLAYING.phrasing] > 0.0 and is_free and p.gesture.node == NONE)


@compiled_exactly
def begin_contours(p: Any, c: Any, is_slur: bool) -> None:
    """Begin the curves of a note: anew in a new stroke, else from where they are."""
    k = p.contours
    since = (c.frame - k.began) / p.rate if p.began >= 0 else WHOLE_S  # the pace of what is played
    k.began, k.pace_s = c.frame, since
    if not has_contours(p):
        k.amount = k.wandering = 0.0
        for i in range(QUANTITIES if k.is_on != 0 else 0):
            go(k.arch[i], 0.0, 0.0, FADING_S)
            go(k.wander[i], 0.0, 0.0, FADING_S)
        return
    k.is_on = 1
    amount = p.value[PLAYING.phrasing] / USUAL_PHRASING
    if FINGER_COUNT[p.gesture.row] > 0:
        amount *= BEATING
    k.length_s = p.value[PLAYING.note_length]
    lasts = k.length_s if k.length_s > 0.0 else max(since, 2.0 * SMALL_S)
    whole = min(max((lasts - SMALL_S) / (WHOLE_S - SMALL_S), 0.0), 1.0)
    k.wandering = amount * whole
    k.amount = amount * whole * min(max(1.0 + UNEVEN * contour_deviate(p), SMALLEST), LARGEST)
    if is_slur:
        k.amount *= 0.5
    at_rest = c.value[SLOTS.bow_speed] == 0.0
    harder = HARDER_PEAK * (p.value[PLAYING.velocity] - NEUTRAL_VELOCITY)
    place = DOWN_PEAK if p.direction > 0.0 else UP_PEAK
    place += UNEVEN_PEAK * contour_deviate(p) - harder
    for i in range(QUANTITIES):
        if at_rest or not is_slur:  # where the bow turns, nothing jumps
            k.arch[i].now, k.arch[i].rate = k.amount * BEGINS[i], 0.0
        peak = min(max(place + LATER[i], 0.12), 0.8)
        peak_s = peak * k.length_s if k.length_s > 0.0 else OPEN_PEAK_S * (0.5 + peak)
        go(k.arch[i], k.amount * PEAKS[i], 0.0, peak_s)
        k.arch[i].peaks = 1
        if k.wander[i].lasts > 0.0:  # goes on in the new note's time
            k.wander[i].begins -= since
            if k.wander[i].begins + k.wander[i].lasts > 0.0 and k.wandering > 0.0:
                continue
        wander_on(p, i, 0.0)


@compiled_exactly
def end_contours(p: Any, c: Any, release_ms: float) -> None:
    """Bend the arches to the end of a stroke whose note has ended, in a time (ms)."""
    k = p.contours
    if k.is_on == 0:
        return
    now = (c.frame - k.began) / p.rate
    for i in range(QUANTITIES):
        go(k.arch[i], k.amount * ENDS[i], now, max(1e-3 * release_ms, 2.0 * HOP_S))


@compiled_exactly
def go(s: Any, to: float, begins: float, lasts: float) -> None:
    """Begin a segment where its curve is, to a value at which it comes to rest."""
    s.a, s.slope, s.b, s.begins, s.lasts = s.now, s.rate, to, begins, max(lasts, 2.0 * HOP_S)
    s.peaks = 0


@compiled_exactly
def wander_on(p: Any, i: int, now: float) -> None:
    """Begin the next segment of a wandering."""
    k = p.contours
    share = 0.5 * (1.0 + next_chance(p, k, CONTOURS_FROM))
    lasts = SHORTEST_S[i] + (LONGEST_S[i] - SHORTEST_S[i]) * share
    go(k.wander[i], k.wandering * WANDERS[i] * contour_deviate(p), now, lasts)


@compiled_exactly
def follow(s: Any, now: float) -> None:
    """Find value and slope of a segment at a time: a cubic Bézier curve whose end is level."""
    if s.lasts == 0.0:
        return
    u = min(max((now - s.begins) / s.lasts, 0.0), 1.0)
    left, steep = 1.0 - u, s.slope * s.lasts
    one = s.a + steep / 3.0  # the second control point; the third is the end
    s.now = left * left * (left * s.a + 3.0 * u * one) + u * u * (3.0 * left + u) * s.b
    s.rate = (left * left * steep + 6.0 * left * u * (s.b - one)) / s.lasts
    if u == 1.0:
        s.rate = 0.0


@compiled_exactly
def advance_contours(p: Any, c: Any) -> None:
    """Advance the curves by one hop: `value` and `gain` of the record."""
    k = p.contours
    for i in range(QUANTITIES):
        k.before[i] = k.value[i]
    if k.is_on == 0 or (p.sounding < 0 and c.value[SLOTS.bow_speed] == 0.0):
        k.is_on = 0
        k.value[:], k.bright_db = 0.0, 0.0
        k.gain *= GAIN_DECAY if abs(k.gain) > 1e-6 else 0.0
        return
    now = (c.frame - k.began) / p.rate
    for i in range(QUANTITIES):
        s = k.arch[i]
        if p.sounding >= 0 and s.peaks != 0 and now >= s.begins + s.lasts:
            left = k.length_s - now
            go(s, k.amount * ENDS[i], now, left if k.length_s > 0.0 else OPEN_EASE_S)
        follow(s, now)
        if now >= k.wander[i].begins + k.wander[i].lasts:
            wander_on(p, i, now)
        follow(k.wander[i], now)
        k.value[i] = s.now + k.wander[i].now
    is_inner = p.string == 0
    calm = INNER if is_inner else 1.0
    if is_inner and p.position == OPEN:  # which no finger tunes
        calm = 0.0
    k.value[FORCE_DRIFT] *= calm
    # On the inner string the place moves the pitch: F#4, G#4 and A4 by 30 cents and more.
    k.value[POSITION_DRIFT] *= 0.0 if is_inner else 1.0
    k.value[SPEED_DRIFT] *= INNER_SPEED if is_inner else 1.0
    k.value[SPEED_DRIFT] = within_speed(p, c, k.value[SPEED_DRIFT])
    k.value[FORCE_DRIFT] = within_force(p, k.value[FORCE_DRIFT])
    k.value[POSITION_DRIFT] = min(max(k.value[POSITION_DRIFT], -MAX_PLACE), MAX_PLACE)
    faster = log2(1.0 + k.value[SPEED_DRIFT])
    k.gain = exp2(LOUDER * faster) - 1.0
    harder = HARDER * (faster + log2(1.0 + k.value[FORCE_DRIFT]))
    brighter = SHELF_DB * (harder - NEARER * log2(1.0 + k.value[POSITION_DRIFT]))
    brighten(p, c, p.value[PLAYING.brilliance] * min(max(brighter, -MAX_SHELF_DB), MAX_SHELF_DB))


@compiled_exactly
def brighten(p: Any, c: Any, more_db: float) -> None:
    """Let the shelf follow the bow, by small steps, unless it moves for another reason."""
    k = p.contours
    if abs(more_db - k.bright_db) < FINE_DB or c.remaining[SLOT_OF[BODY.brilliance]] > 0:
        return
    usual = p.sent[BODY.brilliance] - k.bright_db
    k.bright_db = more_db
    if not math.isnan(usual):  # as it is where somebody else moves it, or nobody did
        move_parameter(p, c, BODY.brilliance, usual + more_db, 0.0)


@compiled_exactly
def within_speed(p: Any, c: Any, more: float) -> float:
    """A factor less 1 on the bow's speed, up to the highest at which the note speaks."""
    speed = abs(c.target[SLOTS.bow_speed])
    most = p.bowing[TOP_SPEED] / speed - 1.0 if speed > 0.0 else more
    most = min(max(most, 0.0), MAX_SPEED)
    return float(max(min(more, most), MIN_SPEED - 1.0))


@compiled_exactly
def within_force(p: Any, more: float) -> float:
    """A factor less 1 on the bow's force, between the least and the most at which the note speaks.

    Little where the bow is to be light or to scratch.
    """
    pressure = p.sent[BOW.pressure]
    if not pressure > 0.0:  # NaN where somebody else moves it
        return 0.0
    if p.value[PLAYING.pressure] <= FLAUTANDO or p.value[PLAYING.pressure] >= SCRATCHY:
        more *= LIGHT
    light = min(p.bowing[AT_FLAUTANDO], p.bowing[AT_LIGHT])
    least = max(min(light / pressure - 1.0, 0.0), -MAX_FORCE)
    most = min(max(p.bowing[AT_FIRM] / pressure - 1.0, 0.0), MAX_FORCE)
    return float(min(max(more, least), most))
