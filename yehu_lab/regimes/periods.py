"""When the hair slips, and after what time the motion of a bowed string repeats. Compiled."""

import math
from typing import Any

from yehu_server.compile.jit import compiled, compiled_exactly
from yehu_server.core.physics.elementary import exp
from yehu_server.core.player.ear import SLIP_BEGIN_FRACTION, SLIP_END_FRACTION

Array = Any

NOWHERE = -1
LASTING = 10  # slips, one a period, after which Helmholtz motion is said to have begun
REGULAR = 0.08  # of a period, by which their distances may be off; [Guettler]
MIN_SLIP = 0.3  # of the bow's speed; in Helmholtz motion a slip is 1 / beta of it
MIN_SPEED = 0.02  # m/s; as the bow sets off the bristles bend, which is no slip
FADING = 8.0  # periods after which a large slip no longer hides smaller ones


@compiled_exactly
def centre(signal: Array, begin: int, end: int, to: Array) -> None:
    """Write a part of a signal to the beginning of `to`, without its mean."""
    mean = 0.0
    for i in range(begin, end):
        mean += signal[i]
    mean /= end - begin
    for i in range(begin, end):
        to[i - begin] = signal[i] - mean


@compiled
def inner(one: Array, other: Array, count: int) -> float:
    """Sum of the products of the first numbers of two arrays, as vectors."""
    total = 0.0
    for i in range(count):
        total += one[i] * other[i]
    return total


@compiled_exactly
def correlate(signal: Array, end: int, span: int, alike: Array, count: int) -> None:
    """Write how alike the last `span` samples before `end` are to those each lag before.

    `alike` is written up to `count`: 1 where they are the same but for a factor, 0 where unrelated.
    So many samples, and one more, lie before the last `span`.
    """
    last = signal[end - span : end]
    power = inner(last, last, span)
    earlier = power
    for lag in range(count):
        scale = math.sqrt(power * max(0.0, earlier) + 1e-30)
        alike[lag] = inner(last, signal[end - span - lag : end - lag], span) / scale
        came, went = signal[end - span - lag - 1], signal[end - lag - 1]
        earlier += came * came - went * went


@compiled_exactly
def is_peak(alike: Array, lag: int) -> bool:
    """Whether the correlation is higher here than at both neighbouring lags."""
    return bool(alike[lag - 1] < alike[lag] >= alike[lag + 1])


@compiled_exactly
def highest_peak(alike: Array, first: int, last: int) -> int:
    """The lag of the highest peak from `first` to `last`; NOWHERE where there is none."""
    found = NOWHERE
    for lag in range(first, last + 1):
        if is_peak(alike, lag) and (found == NOWHERE or alike[lag] > alike[found]):
            found = lag
    return found


@compiled_exactly
def first_peak(alike: Array, first: int, last: int, least: float) -> int:
    """The first lag from `first` to `last` with a peak of at least `least`, or NOWHERE."""
    for lag in range(first, last + 1):
        if alike[lag] >= least and is_peak(alike, lag):
            return lag
    return NOWHERE


@compiled_exactly
def refined(alike: Array, lag: int, count: int) -> float:
    """The period (samples) whose peak is at `lag`, by parabolas at ever more periods."""
    period, periods = vertex(alike, lag), 1
    while (periods + 1) * period < count - 3:
        periods += 1
        at = round(periods * period)
        best = at
        for near in range(at - 2, at + 3):
            if alike[near] > alike[best]:
                best = near
        if not is_peak(alike, best):
            break
        period = vertex(alike, best) / periods
    return period


@compiled_exactly
def vertex(alike: Array, lag: int) -> float:
    """The place of the maximum of a parabola through three values."""
    below, here, above = alike[lag - 1], alike[lag], alike[lag + 1]
    bend = below - 2.0 * here + above
    return lag if bend >= 0.0 else lag + 0.5 * (below - above) / bend


@compiled_exactly
def rectify(relative_velocity: Array, bow_velocity: Array, frames: int, to: Array) -> None:
    """Write how fast the string slips back under the hair, against the bow's direction; else 0."""
    for i in range(frames):
        back = -relative_velocity[i] if bow_velocity[i] >= 0.0 else relative_velocity[i]
        to[i] = max(0.0, back)


@compiled_exactly
def times_of_slips(
    slipping: Array, bow_velocity: Array, frames: int, period: float
) -> tuple[int, int]:
    """The frames of the first slip, and of the slip from which LASTING follow one a period.

    A slip begins and ends as the player's ear has it, relative to the largest of late. `slipping`
    is as of `rectify`, the period (samples) that of the note. Returns frames, -1 for never.
    """
    fade = exp(-1.0 / (FADING * period))
    largest, is_slipping = 0.0, False
    first, last, begun, regular = -1, -1, -1, 0
    for i in range(frames):
        size = slipping[i]
        largest = max(size, largest * fade)
        least = max(SLIP_BEGIN_FRACTION * largest, MIN_SLIP * abs(bow_velocity[i]), MIN_SPEED)
        if is_slipping:
            is_slipping = size > SLIP_END_FRACTION / SLIP_BEGIN_FRACTION * least
        elif size > least and bow_velocity[i] != 0.0:
            is_slipping = True
            if first < 0:
                first = i
            if last >= 0 and abs((i - last) / period - 1.0) < REGULAR:
                regular += 1
                if regular == LASTING:
                    return first, begun
            else:
                regular, begun = 0, i
            last = i
    return first, -1
