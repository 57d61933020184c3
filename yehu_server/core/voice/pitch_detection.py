"""Detects the pitch and the level of one voice, each 5 ms, as its sound comes in. Compiled.

The sound is decimated to about 12 kHz. Its normalised square difference with itself some time ago
(McLeod and Wyvill, "A smarter way to find pitch", ICMC 2005) has a peak at each period: the first
that is nearly as high as the highest is the period, and peaks at its multiples refine it.
"""

import math
from typing import Any

import numpy as np

from yehu_server.compile.jit import compiled_exactly
from yehu_server.core.physics.elementary import cos, exp, exp2, log2, log10, sin
from yehu_server.core.player.ear import EAR_SAMPLES, product, remember

Array = Any

MIN_HZ, MAX_HZ = 70.0, 2100.0
MIN_DECIMATED_HZ = 11000.0  # except where the sound has a lower rate itself
SPAN_S = 0.02  # of the sound that is compared with itself
HOP_S = 0.005
REFINED_S = 0.012  # multiples of the period up to here refine it
# The first peak that is this high, over the highest one, is that of the period. One whose lag is
# within the factor SAME_PERIOD_WITHIN of the previous period needs less. A shorter period takes the
# place of that only if its peak is this high beside it: the second partial may be strong, but at
# twice its period the whole waveform repeats.
FIRST_PEAK_RATIO, SAME_PERIOD_RATIO, SHORTER_PERIOD_RATIO = 0.97, 0.8, 0.98
SAME_PERIOD_WITHIN = 1.06
CUTOFF_HZ, MAX_CUTOFF_OF_RATE = 3000.0, 0.35  # of the low-pass, or this part of the decimated rate
DC_BLOCKER_HZ = 40.0  # cutoff of the high-pass
# Loudness is that of what is above this: roughly as A-weighting has it for a voice.
LOUDNESS_HZ, LOUDNESS_S = 400.0, 0.012
SILENCE_POWER = 1e-12  # power: -120 dB of full scale
MAX_AMPLITUDE = 4.0  # of full scale: louder input is clipped, or the level would take long to fall
A4_HZ = 440.0
MAX_LAGS = 2 + math.ceil(2.0 * MIN_DECIMATED_HZ / MIN_HZ)

PITCH_DETECTOR = np.dtype(
    [
        ("rate", np.float64),  # decimated (Hz)
        ("step", np.int64),  # the factor of decimation
        ("frame", np.int64),  # of the sound, within a step
        ("sample_count", np.int64),  # decimated ones so far
        ("hop", np.int64),  # samples, as all below
        ("span", np.int64),
        ("lags", np.int64),
        ("lowpass", np.float64, (2, 5)),  # two sections: b0 b1 b2 a1 a2
        ("passed", np.float64, (2, 2)),  # their states
        ("dc", np.float64),
        ("lowpassed", np.float64),  # below LOUDNESS_HZ
        ("power", np.float64),
        ("dc_pole", np.float64),  # poles of the three filters above
        ("lowpass_pole", np.float64),
        ("power_pole", np.float64),
        ("sound", np.float64, 2 * EAR_SAMPLES),
        ("nsdf", np.float64, MAX_LAGS),  # by lag
        ("expected", np.float64),  # fractional MIDI note: the previous pitch; NaN for none
        # The last result: fractional MIDI note; up to 1; dB of full scale.
        ("pitch", np.float64),
        ("certainty", np.float64),
        ("level_db", np.float64),
    ],
    align=True,
)


BUTTERWORTH_Q = (0.541196, 1.306563)  # Q of the sections of a filter of fourth order


@compiled_exactly
def prepare_pitch_detector(h: Any, rate: float) -> None:
    """Set up a record that is all 0 for a rate (Hz) of the sound."""
    h.step = max(1, int(rate / MIN_DECIMATED_HZ))
    h.rate = decimated = rate / h.step
    h.hop, h.span = int(HOP_S * decimated), int(SPAN_S * decimated)
    h.lags = min(math.ceil(decimated / MIN_HZ), MAX_LAGS - 2)
    angle = 2.0 * math.pi * min(CUTOFF_HZ, MAX_CUTOFF_OF_RATE * decimated) / rate
    for section in range(2):
        set_lowpass(h.lowpass[section], angle, BUTTERWORTH_Q[section])
    h.dc_pole = exp(-2.0 * math.pi * DC_BLOCKER_HZ / decimated)
    h.lowpass_pole = exp(-2.0 * math.pi * LOUDNESS_HZ / decimated)
    h.power_pole = exp(-1.0 / (LOUDNESS_S * decimated))
    h.level_db, h.expected = 10.0 * log10(SILENCE_POWER), math.nan


@compiled_exactly
def set_lowpass(b: Array, angle: float, q: float) -> None:
    """Set the coefficients of a second-order low-pass; the angle is by sample."""
    alpha, cosine = sin(angle) / (2.0 * q), cos(angle)
    b[0] = 0.5 * (1.0 - cosine) / (1.0 + alpha)
    b[1], b[2] = 2.0 * b[0], b[0]
    b[3], b[4] = -2.0 * cosine / (1.0 + alpha), (1.0 - alpha) / (1.0 + alpha)


@compiled_exactly
def push_sample(h: Any, sample: float) -> bool:
    """Process a sample of the sound; return whether there is a new result. Real time: safe."""
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
    h.dc = passed + (h.dc - passed) * h.dc_pole
    sound = passed - h.dc
    h.lowpassed = sound + (h.lowpassed - sound) * h.lowpass_pole
    loud = (sound - h.lowpassed) ** 2
    h.power = loud + (h.power - loud) * h.power_pole
    remember(h.sound, h.sample_count, sound)
    h.sample_count += 1
    if h.sample_count % h.hop != 0:
        return False
    analyse(h)
    return True


@compiled_exactly
def analyse(h: Any) -> None:
    """Analyse the last samples: level, certainty and pitch."""
    h.level_db = 10.0 * log10(h.power + SILENCE_POWER)
    end = EAR_SAMPLES + (h.sample_count & (EAR_SAMPLES - 1))
    compare(h.nsdf, h.sound, end, h.span, h.lags)
    expected = h.rate / (A4_HZ * exp2((h.expected - 69.0) / 12.0))
    lag = first_peak(h.nsdf, h.lags, int(h.rate / MAX_HZ), expected)
    h.certainty = min(height_at(h.nsdf, lag), 1.0) if lag > 0 else 0.0
    if lag == 0:
        return
    period, multiple = peak_at(h.nsdf, lag), 1
    while 2.0 * multiple * period < min(REFINED_S * h.rate, h.lags - 2.0):
        peak = highest_lag_near(h.nsdf, int(np.rint(2.0 * multiple * period)))
        if h.nsdf[peak] < SAME_PERIOD_RATIO * h.certainty:
            break
        multiple *= 2
        period = peak_at(h.nsdf, peak) / multiple
    h.pitch = 69.0 + 12.0 * log2(h.rate / (period * A4_HZ))


@compiled_exactly
def compare(nsdf: Array, sound: Array, end: int, span: int, lags: int) -> None:
    """Compute the NSDF of the last `span` samples before `end`, for lags up to `lags`."""
    own = product(sound, end, span, 0, 0)
    before = own
    nsdf[0] = 1.0
    for lag in range(1, lags + 1):
        first, last = sound[end - span - lag], sound[end - lag]
        before += first * first - last * last
        power = own + before
        floor = span * SILENCE_POWER
        nsdf[lag] = 2.0 * product(sound, end, span, 0, lag) / (max(power, 0.0) + floor)


@compiled_exactly
def first_peak(nsdf: Array, lags: int, shortest: int, expected: float) -> int:
    """The lag of the period, preferring the `expected` one; 0 for none."""
    highest, at_expected = 0.0, 0.0
    begin = 1
    while begin < lags and nsdf[begin] > 0.0:  # the peak at lag 0 is no period
        begin += 1
    begin = max(begin, shortest)
    for i in range(begin, lags):
        if is_peak(nsdf, i):
            height = height_at(nsdf, i)
            highest = max(highest, height)
            if expected / SAME_PERIOD_WITHIN < peak_at(nsdf, i) < expected * SAME_PERIOD_WITHIN:
                at_expected = max(at_expected, height)
    lasts = at_expected > SAME_PERIOD_RATIO * highest
    for i in range(begin, lags):
        if is_peak(nsdf, i):
            height, lag = height_at(nsdf, i), peak_at(nsdf, i)
            is_shorter = lasts and lag < expected / SAME_PERIOD_WITHIN
            ratio = SAME_PERIOD_RATIO if lasts else FIRST_PEAK_RATIO
            min_height = SHORTER_PERIOD_RATIO * at_expected if is_shorter else ratio * highest
            if height > min_height:
                return i
    return 0


@compiled_exactly
def is_peak(nsdf: Array, lag: int) -> bool:
    """Whether the NSDF has a peak at a lag."""
    here = nsdf[lag]
    return bool(here > 0.0 and here >= nsdf[lag - 1] and here > nsdf[lag + 1])


@compiled_exactly
def highest_lag_near(nsdf: Array, lag: int) -> int:
    """The lag of the highest value within two samples of one."""
    best = lag
    for i in range(lag - 2, lag + 3):
        if nsdf[i] > nsdf[best]:
            best = i
    return best


@compiled_exactly
def peak_at(nsdf: Array, lag: int) -> float:
    """The fractional lag of a peak, by a parabola through three points."""
    below, best, above = nsdf[lag - 1], nsdf[lag], nsdf[lag + 1]
    curvature = below - 2.0 * best + above
    if curvature >= 0.0:
        return float(lag)
    return float(lag + min(max(0.5 * (below - above) / curvature, -0.5), 0.5))


@compiled_exactly
def height_at(nsdf: Array, lag: int) -> float:
    """The height of a peak, by the same parabola: a short period has few samples."""
    below, above = nsdf[lag - 1], nsdf[lag + 1]
    return float(nsdf[lag] - 0.25 * (below - above) * (peak_at(nsdf, lag) - lag))
