"""The rule that names the regime of a bowed string, and how loud and bright its sound is. Compiled.

It is the rule of the player's ear (`player.ear`), extended: what counts is when the hair sticks and
slips, and after what time that repeats. A pitch detector alone errs by octaves just where regimes
meet. docs/sweep.md defines the regimes, and how the rule was checked.
"""

import math
from typing import Annotated, Any

import numpy as np

from yehu_lab.regimes.columns import (
    ANOMALOUS_LOW,
    APERIODIC,
    FINDING,
    HELMHOLTZ,
    MULTIPLE_SLIP,
    OCTAVE,
    RAUCOUS,
    SILENT,
    Finding,
)
from yehu_lab.regimes.periods import (
    NOWHERE,
    centre,
    correlate,
    first_peak,
    highest_peak,
    rectify,
    refined,
    times_of_slips,
)
from yehu_server.compile.jit import compiled_exactly, native
from yehu_server.compile.memory import carray
from yehu_server.core.physics.elementary import cos, log10, sin
from yehu_server.core.player.ear import SEARCH_FRACTION, SLIP_END_FRACTION, count_slips
from yehu_server.errors import ParameterError

Array = Any

WINDOW_S = 0.04  # of the spectrum whose centroid is the brightness
PERIODS = 10  # at the end of a stroke, which are judged
LONGEST, SHORTEST = 4.3, 0.1  # periods after which motion may repeat
MIN_PERIODS = LONGEST + 2.0  # of a stroke
QUIET = 0.15  # of the bow's speed: a string that moves less under the bow is silent
SLIDING = 0.03  # of the time, sticking: below, the hair slides steadily
STILL = 1e-4  # m/s, the same of a bow that is at rest
REPEATS = 0.78  # correlation from which motion repeats after a period, noisy as it may be
EXACTLY = 0.9  # after a part of a period, and where several slips repeat after more than one
NEARLY = 0.95  # of the highest peak
AFTER_MORE = 0.8  # after more than a period
SEVERAL = 1.4  # slips a period
ONE_EACH = 0.25  # deviation from one slip in each part of a period
AT_MOST_ONE = 1.05  # slips a period


@compiled_exactly
def name_regime(
    slips: float,
    sticking: float,
    alike: Array,
    count: int,
    period: float,
    motion: float,
    speed: float,
) -> tuple[int, int]:
    """The regime, and the lag (samples) after which the motion repeats, or NOWHERE.

    Of the slips in a period of the note (samples), the share of the time that the hair is sticking,
    the correlation at each lag below `count`, the root mean square of the velocity of string on
    hair without its mean, and the bow's speed (m/s).
    """
    if motion < max(QUIET * speed, STILL) or sticking < SLIDING:
        return SILENT, NOWHERE
    shortest = max(2, math.ceil(SHORTEST * period))
    before, after = (1.0 - SEARCH_FRACTION) * period, (1.0 + SEARCH_FRACTION) * period
    lag = first_peak(alike, shortest, math.ceil(before) - 1, EXACTLY)
    while lag != NOWHERE:
        if abs(slips * lag / period - 1.0) < ONE_EACH:
            return OCTAVE, lag
        lag = first_peak(alike, lag + 1, math.ceil(before) - 1, EXACTLY)
    at_period = highest_peak(alike, math.ceil(before), math.floor(after))
    if at_period != NOWHERE and alike[at_period] >= REPEATS:
        return (MULTIPLE_SLIP if slips >= SEVERAL else HELMHOLTZ), at_period
    best = highest_peak(alike, shortest, count - 2)
    if slips >= SEVERAL:
        if best != NOWHERE and alike[best] >= EXACTLY:
            return MULTIPLE_SLIP, best
        return APERIODIC, NOWHERE
    lower = highest_peak(alike, math.floor(after) + 1, count - 2)
    if lower != NOWHERE and alike[lower] >= AFTER_MORE:
        # Where it repeats after twice that too, perhaps a little better: the first.
        return ANOMALOUS_LOW, first_peak(alike, math.floor(after) + 1, lower, NEARLY * alike[lower])
    return (RAUCOUS if slips <= AT_MOST_ONE else APERIODIC), NOWHERE


@compiled_exactly
def judge_end(
    relative_velocity: Array,
    slipping: Array,
    frames: int,
    rate: float,
    period: float,
    speed: float,
    work: Array,
    out: Any,
) -> None:
    """Judge the last periods of a stroke; write regime, slips, certainty and pitch.

    Of the velocity of string on hair (m/s) and the slipping of `periods.rectify` [shape=(at least
    frames,)], at least MIN_PERIODS of the note (samples), and the bow's speed (m/s), not
    negative. `work` [shape=(2, at least frames)] is written.
    """
    count = int(LONGEST * period) + 2
    span = min(int(np.rint(PERIODS * period)), frames - count - 1)
    window, alike = work[0], work[1]
    begin, size = frames - span - count - 1, span + count + 1
    centre(relative_velocity, begin, frames, window)
    correlate(window, size, span, alike, count)
    power = 0.0
    for i in range(size - span, size):
        power += window[i] * window[i]
    slips = count_slips(slipping, frames, span) * period / span
    sticking = share_of_sticking(slipping, frames, span)
    regime, lag = name_regime(slips, sticking, alike, count, period, math.sqrt(power / span), speed)
    out.regime, out.slips = regime, slips
    out.certainty, out.pitch_hz = 0.0, math.nan
    if lag != NOWHERE:
        out.certainty = alike[lag]
        out.pitch_hz = rate / refined(alike, lag, count)


@compiled_exactly
def share_of_sticking(slipping: Array, end: int, span: int) -> float:
    """How much of the last `span` samples before `end` the hair sticks, 0 to 1."""
    largest, stuck = 0.0, 0
    for i in range(end - span, end):
        largest = max(largest, slipping[i])
    for i in range(end - span, end):
        if slipping[i] <= SLIP_END_FRACTION * largest:
            stuck += 1
    return stuck / span


@compiled_exactly
def judge_stroke(
    relative_velocity: Array,
    bow_velocity: Array,
    pressure: Array,
    frames: int,
    rate: float,
    frequency_hz: float,
    work: Array,
    out: Any,
) -> None:
    """Judge a whole stroke; write all of a finding but its faults.

    Velocities (m/s) of string on hair and of the bow, and pressure (Pa) are [shape=(at least
    frames,)]; the frequency is that of the note. `work` [shape=(3, at least frames)] is written.
    """
    period = rate / frequency_hz
    slipping, rest = work[2], work[:2]
    rectify(relative_velocity, bow_velocity, frames, slipping)
    first, begun = times_of_slips(slipping, bow_velocity, frames, period)
    out.first_slip_s = first / rate if first >= 0 else math.nan
    out.helmholtz_s = begun / rate if begun >= 0 else math.nan
    speed = abs(bow_velocity[frames - 1])
    judge_end(relative_velocity, slipping, frames, rate, period, speed, rest, out)
    count = min(frames, int(np.rint(PERIODS * period)))
    out.level_db = level_db(pressure, frames - count, frames)
    out.brightness_hz = centroid_hz(pressure, frames, rate, rest)


# Rows of what a whole stroke is judged by, and worked in.
RELATIVE, BOW, SOUND, WORK = range(4)
SIGNALS = WORK + 3


@native
def judge_signals(
    signals: Any,
    room: int,
    frames: int,
    rate: float,
    frequency_hz: float,
    out: Annotated[Any, FINDING],
) -> None:
    """Judge a stroke as `judge_stroke` does.

    `signals` is a pointer to an array [shape=(SIGNALS, room)]: velocities of string on hair and of
    the bow, pressure, and rows to work in.
    """
    rows = carray(signals, (SIGNALS, room), np.float64)
    judge_stroke(
        rows[RELATIVE], rows[BOW], rows[SOUND], frames, rate, frequency_hz, rows[WORK:], out
    )


@compiled_exactly
def window_frames(rate: float, frames: int) -> int:
    """Samples of the spectrum: a power of two, at least WINDOW_S where there are so many."""
    size = 2
    while size < WINDOW_S * rate and 2 * size <= frames:
        size *= 2
    return size


@compiled_exactly
def transform(real: Array, imaginary: Array, size: int) -> None:
    """Fourier transform in place, of a power of two of samples. Source: [CooleyTukey]."""
    place = 0
    for i in range(1, size):
        bit = size >> 1
        while place & bit:
            place ^= bit
            bit >>= 1
        place |= bit
        if i < place:
            real[i], real[place] = real[place], real[i]
            imaginary[i], imaginary[place] = imaginary[place], imaginary[i]
    length = 2
    while length <= size:
        half = length >> 1
        turn = -2.0 * math.pi / length
        step_real, step_imaginary = cos(turn), sin(turn)
        for begin in range(0, size, length):
            w_real, w_imaginary = 1.0, 0.0
            for a in range(begin, begin + half):
                b = a + half
                x = real[b] * w_real - imaginary[b] * w_imaginary
                y = real[b] * w_imaginary + imaginary[b] * w_real
                real[b], imaginary[b] = real[a] - x, imaginary[a] - y
                real[a], imaginary[a] = real[a] + x, imaginary[a] + y
                w_real, w_imaginary = (
                    w_real * step_real - w_imaginary * step_imaginary,
                    w_real * step_imaginary + w_imaginary * step_real,
                )
        length *= 2


@compiled_exactly
def centroid_hz(signal: Array, end: int, rate: float, work: Array) -> float:
    """The mean frequency, by power, of the sound before `end`; NaN for silence.

    `work` [shape=(2, at least the window)] is written.
    """
    size = window_frames(rate, end)
    real, imaginary = work[0], work[1]
    mean = 0.0
    for i in range(end - size, end):
        mean += signal[i]
    mean /= size
    for i in range(size):
        hann = 0.5 - 0.5 * cos(2.0 * math.pi * i / size)
        real[i], imaginary[i] = (signal[end - size + i] - mean) * hann, 0.0
    transform(real, imaginary, size)
    total, moment = 0.0, 0.0
    for i in range(1, size // 2 + 1):
        power = real[i] * real[i] + imaginary[i] * imaginary[i]
        total += power
        moment += power * i
    return moment / total * rate / size if total > 0.0 else math.nan


@compiled_exactly
def level_db(signal: Array, begin: int, end: int) -> float:
    """The level (dB re 1, rms) of a part of a signal, without its mean."""
    total, squares = 0.0, 0.0
    for i in range(begin, end):
        total += signal[i]
        squares += signal[i] * signal[i]
    mean = total / (end - begin)
    return 10.0 * log10(max(squares / (end - begin) - mean * mean, 1e-30))


def judge(
    relative_velocity: Array,
    bow_velocity: Array | float,
    pressure: Array,
    rate: float,
    frequency_hz: float,
) -> Finding:
    """Judge the end of a stroke, and when its Helmholtz motion began.

    Of the velocity of the bowed string on the hair (m/s), as `simulate` keeps it, the bow's
    velocity (m/s), and the pressure (Pa), each [shape=(frames,)]; and the frequency of the note
    that is fingered, which may be off by 6 %. Raises ParameterError where the stroke has less than
    MIN_PERIODS.
    """
    frames = len(relative_velocity)
    check_length(frames, rate, frequency_hz)
    signals, found = np.zeros((SIGNALS, frames)), np.zeros(1, FINDING)
    signals[RELATIVE], signals[BOW], signals[SOUND] = relative_velocity, bow_velocity, pressure
    judge_signals.call(signals.ctypes.data, frames, frames, rate, frequency_hz, found.ctypes.data)
    return Finding.of(found[0])


def check_length(frames: int, rate: float, frequency_hz: float) -> None:
    """Refuse a stroke of less than MIN_PERIODS of its note; raises ParameterError."""
    if not frames * frequency_hz >= MIN_PERIODS * rate:
        raise ParameterError(
            f"{frames / rate:g} s are too short to judge a note of {frequency_hz:.4g} Hz: "
            f"{MIN_PERIODS / frequency_hz:.3g} s are needed"
        )
