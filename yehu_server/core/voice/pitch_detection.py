"""Detects the pitch and the level of one voice, each 5 ms, as its sound comes in. Compiled.

The sound is thinned to about 12 kHz. Its normalised square difference with itself some time ago
(McLeod and Wyvill, "A smarter way to find pitch", ICMC 2005) has a peak at each period: the first
that is nearly as high as the highest is the period, and peaks at its multiples refine it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import cos, exp, exp2, log2, log10, sin
from yehu_server.core.player.ear import EAR_SAMPLES, product, remember

Array = Any

MIN_HZ, MAX_HZ = 70.0, 2100.0
THINNED_HZ = 11000.0  # the least rate at which it is heard, where the sound has so much
SPAN_S = 0.02  # of the sound that is compared with itself
HOP_S = 0.005
REFINED_S = 0.012  # multiples of the period up to here refine it
# A first peak so high beside the highest is that of the period. One within NEAR of the period of
# before needs less, and a shorter one instead of that must be so high beside it: the second partial
# may be strong, but of twice the period all is alike.
FIRST, SAME, INSTEAD, NEAR = 0.97, 0.8, 0.98, 1.06
CUTOFF_HZ, OF_RATE = 3000.0, 0.35  # of the low-pass, or this part of the thinned rate
STEADY_HZ = 40.0  # of the high-pass, for what is steady
# Loudness is that of what is above this: roughly as A-weighting has it for a voice.
LOUDNESS_HZ, LOUDNESS_S = 400.0, 0.012
SILENT = 1e-12  # power: -120 dB of full scale
MAX_AMPLITUDE = 4.0  # of full scale: what is beyond is no voice, and would deafen for long
A4_HZ = 440.0
MAX_LAGS = 2 + math.ceil(2.0 * THINNED_HZ / MIN_HZ)

HEARING = np.dtype(
    [
        ("rate", np.float64),  # thinned (Hz)
        ("step", np.int64),  # frames of the sound for one that is heard
        ("frame", np.int64),  # of the sound, within a step
        ("heard", np.int64),  # number of samples heard
        ("hop", np.int64),  # samples, as all below
        ("span", np.int64),
        ("lags", np.int64),
        ("lowpass", np.float64, (2, 5)),  # two sections: b0 b1 b2 a1 a2
        ("passed", np.float64, (2, 2)),  # their states
        ("steady", np.float64),
        ("below", np.float64),  # of LOUDNESS_HZ
        ("power", np.float64),
        ("keep_steady", np.float64),  # factors of the three above, by sample
        ("keep_below", np.float64),
        ("keep_power", np.float64),
        ("sound", np.float64, 2 * EAR_SAMPLES),
        ("likeness", np.float64, MAX_LAGS),  # by lag
        ("expected", np.float64),  # fractional MIDI note: the pitch of before; NaN for none
        # What is heard: fractional MIDI note; up to 1; dB of full scale.
        ("pitch", np.float64),
        ("certainty", np.float64),
        ("level_db", np.float64),
    ],
    align=True,
)


BUTTERWORTH = (0.541196, 1.306563)  # Q of the sections of a filter of fourth order


@compiled_exactly
def prepare_hearing(h: Any, rate: float) -> None:
    """Set up a record that is all 0 for a rate (Hz) of the sound."""
    h.step = max(1, int(rate / THINNED_HZ))
    h.rate = thinned = rate / h.step
    h.hop, h.span = int(HOP_S * thinned), int(SPAN_S * thinned)
    h.lags = min(math.ceil(thinned / MIN_HZ), MAX_LAGS - 2)
    angle = 2.0 * math.pi * min(CUTOFF_HZ, OF_RATE * thinned) / rate
    for section in range(2):
        set_lowpass(h.lowpass[section], angle, BUTTERWORTH[section])
    h.keep_steady = exp(-2.0 * math.pi * STEADY_HZ / thinned)
    h.keep_below = exp(-2.0 * math.pi * LOUDNESS_HZ / thinned)
    h.keep_power = exp(-1.0 / (LOUDNESS_S * thinned))
    h.level_db, h.expected = 10.0 * log10(SILENT), math.nan


@compiled_exactly
def set_lowpass(b: Array, angle: float, q: float) -> None:
    """Set the coefficients of a second-order low-pass; the angle is by sample."""
    alpha, cosine = sin(angle) / (2.0 * q), cos(angle)
    b[0] = 0.5 * (1.0 - cosine) / (1.0 + alpha)
    b[1], b[2] = 2.0 * b[0], b[0]
    b[3], b[4] = -2.0 * cosine / (1.0 + alpha), (1.0 - alpha) / (1.0 + alpha)


@compiled_exactly
def take(h: Any, sample: float) -> bool:
    """Take a sample of the sound; return whether something new is heard. Real time: safe."""
    passed = min(max(sample, -MAX_AMPLITUDE), MAX_AMPLITUDE) if math.isfinite(sample) else 0.0
    for section in range(2):
        b, z = h.lowpass[section], h.passed[section]
        out = b[0] * passed + z[0]
        z[0] = b[1] * passed - b[3] * out + z[1]
        z[1] = b[2] * passed - b[4] * out
        passed = out
    h.frame += 1
    if h.frame < h.step:
        return False
    h.frame = 0
    h.steady = passed + (h.steady - passed) * h.keep_steady
    sound = passed - h.steady
    h.below = sound + (h.below - sound) * h.keep_below
    loud = (sound - h.below) ** 2
    h.power = loud + (h.power - loud) * h.keep_power
    remember(h.sound, h.heard, sound)
    h.heard += 1
    if h.heard % h.hop != 0:
        return False
    hear(h)
    return True


@compiled_exactly
def hear(h: Any) -> None:
    """Hear what the last samples have."""
    h.level_db = 10.0 * log10(h.power + SILENT)
    end = EAR_SAMPLES + (h.heard & (EAR_SAMPLES - 1))
    compare(h.likeness, h.sound, end, h.span, h.lags)
    expected = h.rate / (A4_HZ * exp2((h.expected - 69.0) / 12.0))
    lag = first_peak(h.likeness, h.lags, int(h.rate / MAX_HZ), expected)
    h.certainty = min(height_at(h.likeness, lag), 1.0) if lag > 0 else 0.0
    if lag == 0:
        return
    period, times = peak_at(h.likeness, lag), 1
    while 2.0 * times * period < min(REFINED_S * h.rate, h.lags - 2.0):
        near = highest_near(h.likeness, int(np.rint(2.0 * times * period)))
        if h.likeness[near] < SAME * h.certainty:
            break
        times *= 2
        period = peak_at(h.likeness, near) / times
    h.pitch = 69.0 + 12.0 * log2(h.rate / (period * A4_HZ))


@compiled_exactly
def compare(likeness: Array, sound: Array, end: int, span: int, lags: int) -> None:
    """The likeness of the last `span` samples before `end` with those up to `lags` before."""
    own = product(sound, end, span, 0, 0)
    before = own
    likeness[0] = 1.0
    for lag in range(1, lags + 1):
        first, last = sound[end - span - lag], sound[end - lag]
        before += first * first - last * last
        power = own + before
        likeness[lag] = 2.0 * product(sound, end, span, 0, lag) / (max(power, 0.0) + span * SILENT)


@compiled_exactly
def first_peak(likeness: Array, lags: int, shortest: int, expected: float) -> int:
    """The lag of the period, which lasts where it can; 0 for none."""
    highest, at_expected = 0.0, 0.0
    begin = 1
    while begin < lags and likeness[begin] > 0.0:  # what follows 0 is no period
        begin += 1
    begin = max(begin, shortest)
    for i in range(begin, lags):
        if is_peak(likeness, i):
            height = height_at(likeness, i)
            highest = max(highest, height)
            if expected / NEAR < peak_at(likeness, i) < expected * NEAR:
                at_expected = max(at_expected, height)
    lasts = at_expected > SAME * highest
    for i in range(begin, lags):
        if is_peak(likeness, i):
            height, place = height_at(likeness, i), peak_at(likeness, i)
            is_shorter = lasts and place < expected / NEAR
            wanted = INSTEAD * at_expected if is_shorter else (SAME if lasts else FIRST) * highest
            if height > wanted:
                return i
    return 0


@compiled_exactly
def is_peak(likeness: Array, lag: int) -> bool:
    """Whether the likeness is highest at a lag."""
    here = likeness[lag]
    return bool(here > 0.0 and here >= likeness[lag - 1] and here > likeness[lag + 1])


@compiled_exactly
def highest_near(likeness: Array, lag: int) -> int:
    """The lag of the highest likeness within a sample of one, or two."""
    best = lag
    for i in range(lag - 2, lag + 3):
        if likeness[i] > likeness[best]:
            best = i
    return best


@compiled_exactly
def peak_at(likeness: Array, lag: int) -> float:
    """The place of a peak, by a parabola through three points."""
    below, best, above = likeness[lag - 1], likeness[lag], likeness[lag + 1]
    bend = below - 2.0 * best + above
    if bend >= 0.0:
        return float(lag)
    return float(lag + min(max(0.5 * (below - above) / bend, -0.5), 0.5))


@compiled_exactly
def height_at(likeness: Array, lag: int) -> float:
    """The height of a peak, by the same parabola: a short period has few samples."""
    below, above = likeness[lag - 1], likeness[lag + 1]
    return float(likeness[lag] - 0.25 * (below - above) * (peak_at(likeness, lag) - lag))
