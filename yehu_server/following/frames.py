"""Analyse a sound in frames, one each 5 ms: level, bands of the spectrum, candidates of the pitch.

The candidates are the tracker's pitch, simple ratios of it, and the first high peak of the
normalised square difference function (NSDF) [McLeod]. Each is refined by that function, at as many
periods as fit. The tracker is [SwiftF0], a small network whose weights come with its package;
docs/decisions/0026-the-tracker.md compares it with others.
"""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from yehu_server.following.recording import RATE
from yehu_server.util.loudness import a_weighting

Array = Any

PERIOD_S = 0.016  # between two estimates of the tracker
HOP = 80  # samples from one frame to the next
HOP_S = HOP / RATE
# Samples of a frame for high pitches and for low ones; the longest lag is a part of them.
SHORT, LONG, LONGEST_LAG = 512, 1024, 5 / 8
SHORT_FROM_HZ = 160.0
HALF = LONG // 2
LOWEST_HZ, HIGHEST_HZ = 50.0, 2200.0
RATIOS = (1.0, 0.5, 2.0, 1.0 / 3.0, 3.0)  # of the tracker's pitch
CANDIDATES = len(RATIOS) + 1
NEARLY_BEST = 0.9  # the first peak this near to the highest is the period, not a multiple of it
FINE_S = 0.009  # about, the lag at which a pitch is refined
SEARCHED = 0.06  # half of the searched range, as a part of the period
SILENCE_DB = -120.0
BATCH = 400  # frames at a time
# Spectral flux: number of bands, and their ends; frames over which a band's rise is taken, and the
# level below which changes do not count.
BANDS, BAND_HZ = 24, (100.0, 7800.0)
FLUX_FRAMES, FLOOR_DB = 4, -70.0

_WINDOW = np.hanning(SHORT + 2)[1:-1]
_SCALE = 2.0 / (SHORT * np.square(_WINDOW).sum())
_A_WEIGHTS = _SCALE * a_weighting(np.fft.rfftfreq(SHORT, 1.0 / RATE)) ** 2
REACH = 40  # lags to either side, at most, of the searched range


def _band_weights() -> Array:
    """The bins of the spectrum in each band: ndarray [shape=(SHORT // 2 + 1, BANDS)]."""
    hz = np.fft.rfftfreq(SHORT, 1.0 / RATE)
    edges = np.geomspace(*BAND_HZ, BANDS + 1)
    weights = ((hz[:, None] >= edges[:-1]) & (hz[:, None] < edges[1:])).astype(np.float64)
    return _SCALE * weights[:, weights.any(axis=0)]


_BANDS = _band_weights()


@dataclass(frozen=True)
class Frames:
    """The analysis of some frames."""

    level_db: Array  # [shape=(frames,)] A-weighted (dB of full scale)
    bands_db: Array  # [shape=(frames, bands)] levels of the bands of the spectrum
    # [shape=(frames, CANDIDATES)] the candidates, the tracker's first, and their clarity: the NSDF
    # at their periods, up to 1; NaN and 0 where there is none.
    pitch_hz: Array
    clarity: Array
    certainty: Array  # [shape=(frames,)] the tracker's


def measured(sound: Array, pitch_hz: Array, certainty: Array) -> Frames:
    """Measure frames whose middles are HALF, HALF + HOP, ... samples into a sound.

    The tracker has `pitch_hz` and `certainty` [shape=(frames,)] there; the sound has the shape
    (samples,).
    """
    count = len(pitch_hz)
    windows = np.lib.stride_tricks.sliding_window_view(sound, LONG)[::HOP][:count]
    long = windows.astype(np.float64)
    short = long[:, (LONG - SHORT) // 2 : (LONG + SHORT) // 2]
    power = np.square(np.abs(np.fft.rfft(short * _WINDOW, axis=1)))
    curves = {False: nsdf(long), True: nsdf(short)}  # by whether they are short
    own = first_peaks_hz(curves[False])
    rough = np.concatenate((pitch_hz[:, None] * np.array(RATIOS), own[:, None]), axis=1)
    found, clarity = np.full(rough.shape, np.nan), np.zeros(rough.shape)
    is_within = (rough >= LOWEST_HZ) & (rough <= HIGHEST_HZ)
    for is_short, of_frames in curves.items():
        row, column = np.nonzero(is_within & ((rough >= SHORT_FROM_HZ) == is_short))
        if len(row):
            refined_hz, peak = refined(of_frames, row, rough[row, column])
            found[row, column], clarity[row, column] = refined_hz, peak
    results = _db(power @ _A_WEIGHTS), _db(power @ _BANDS), found, clarity, certainty
    return Frames(*(each.astype(np.float32) for each in results))  # half the memory of an hour


def _db(power: Array) -> Array:
    return 10.0 * np.log10(np.maximum(power, 10.0 ** (SILENCE_DB / 10.0)))


def nsdf(frames: Array) -> Array:
    """The normalised square difference function of frames, at lags of half samples.

    Of frames [shape=(frames, samples)] an ndarray [shape=(frames, lags)]: 1 where a frame
    repeats itself, 0 where it is unrelated.
    """
    x = frames - frames.mean(axis=1, keepdims=True)
    size = x.shape[1]
    lags = int(LONGEST_LAG * size)
    spectrum = np.square(np.abs(np.fft.rfft(x, 2 * size, axis=1)))
    product = 2.0 * np.fft.irfft(spectrum, 4 * size, axis=1)[:, : 2 * lags - 1]
    squares = np.concatenate((np.zeros((len(x), 1)), np.cumsum(x * x, axis=1)), axis=1)
    at = np.arange(lags)
    energy = squares[:, size - at] + squares[:, -1:] - squares[:, at]
    fine = np.empty(product.shape)
    fine[:, ::2] = energy
    fine[:, 1::2] = 0.5 * (energy[:, :-1] + energy[:, 1:])
    return 2.0 * product / np.maximum(fine, 1e-12)


def first_peaks_hz(curves: Array) -> Array:
    """The pitch (Hz) at the first high peak of each curve of `nsdf`; 0 where there is none."""
    first, last = int(2 * RATE / HIGHEST_HZ), int(2 * RATE / LOWEST_HZ)
    part = curves[:, first : last + 1]
    inner = part[:, 1:-1]
    is_peak = (inner > part[:, :-2]) & (inner >= part[:, 2:])
    peaks = np.where(is_peak, inner, -np.inf)
    highest = peaks.max(axis=1)
    lag = first + 1 + np.argmax(peaks >= NEARLY_BEST * highest[:, None], axis=1)
    return np.where(highest > 0.0, 2.0 * RATE / lag, 0.0)


def refined(curves: Array, row: Array, rough_hz: Array) -> tuple[Array, Array]:
    """The pitches (Hz) of peaks near rough ones, and the NSDF at one period of each.

    `curves` are those of `nsdf`, and `row` [shape=(pitches,)] is the frame of each pitch.
    """
    period = 2.0 * RATE / rough_hz  # lags
    near, clarity = _peak(curves, row, period, np.maximum(SEARCHED * period, 2.0))
    most = np.minimum(2.0 * FINE_S * RATE, curves.shape[1] - 3.0)
    periods = np.maximum(np.floor(most / near), 1.0)
    lag, _ = _peak(curves, row, periods * near, np.clip(0.02 * periods * near, 2.0, 0.3 * near))
    return 2.0 * RATE * periods / lag, clarity


def _peak(curves: Array, row: Array, lag: Array, reach: Array) -> tuple[Array, Array]:
    """The lag of the highest value near one, by a parabola, and that value.

    Where it lies at the end of the searched range there is no peak, and the lag stays.
    """
    offsets = np.arange(-REACH, REACH + 1)
    places = np.rint(lag).astype(np.int64)[:, None] + offsets
    places = np.clip(places, 1, curves.shape[1] - 2)
    values = curves[row[:, None], places]
    values = np.where(np.abs(offsets) <= np.ceil(reach)[:, None], values, -np.inf)
    best = np.argmax(values, axis=1)
    here = places[np.arange(len(row)), best]
    left, middle, right = (curves[row, here + step] for step in (-1, 0, 1))
    bend = left - 2.0 * middle + right
    is_peak = (left <= middle) & (middle >= right) & (bend < 0.0)
    safe = np.where(is_peak, bend, -1.0)
    vertex = here + np.where(is_peak, 0.5 * (left - right) / safe, 0.0)
    return np.where(is_peak, vertex, lag), middle


class Analyser:
    """Analyses a sound that comes in blocks; its memory grows with the number of frames only."""

    def __init__(self) -> None:
        from swift_f0 import SwiftF0

        # One thread: more give the same, and a pool that spins takes the cores of the rendering.
        self._tracker = SwiftF0(threads=1, spin=False).stream()
        self._tracked = np.zeros((2, 0))  # pitches (Hz) and certainties, each PERIOD_S
        self._sound = np.zeros(HALF, np.float32)  # half a frame before the first
        self._samples = self._measured = 0
        self._frames: list[Frames] = []

    @property
    def time_s(self) -> float:
        """Duration of the sound so far (s)."""
        return self._samples / RATE

    def push(self, samples: Array) -> None:
        """Take the next samples [shape=(samples,)] at RATE."""
        if len(samples) == 0:
            return
        self._samples += len(samples)
        self._sound = np.concatenate((self._sound, samples))
        self._take(self._tracker.push(samples, RATE))
        known = int((self._tracked.shape[1] - 1) * PERIOD_S / HOP_S)
        self._measure(min(known, (self._samples - HALF) // HOP))

    def finish(self) -> Frames:
        """Return all frames."""
        self._take(self._tracker.flush())
        self._sound = np.concatenate((self._sound, np.zeros(LONG, np.float32)))
        self._measure(self._samples // HOP)
        names = [each.name for each in fields(Frames)]
        return Frames(*(np.concatenate([getattr(each, n) for each in self._frames]) for n in names))

    def _take(self, new: Any) -> None:
        self._tracked = np.concatenate((self._tracked, (new.pitch_hz, new.confidence)), axis=1)

    def _measure(self, end: int) -> None:
        while self._measured < end:
            count = min(end - self._measured, BATCH)
            times = (self._measured + np.arange(count)) * HOP_S
            self._frames.append(measured(self._sound, *at_times(self._tracked, times)))
            self._sound = self._sound[count * HOP :]
            self._measured += count


def at_times(tracked: Array, times_s: Array) -> tuple[Array, Array]:
    """Pitch (Hz) and certainty [shape=(times,)] at times, interpolated within one note.

    Of the tracker's [shape=(2, estimates)], one each PERIOD_S.
    """
    pitch_hz, certainty = tracked
    place = times_s / PERIOD_S
    last = len(pitch_hz) - 1
    below = np.clip(np.floor(place).astype(np.int64), 0, last)
    above = np.minimum(below + 1, last)
    part = np.clip(place - below, 0.0, 1.0)
    low, high = np.log2(pitch_hz[below]), np.log2(pitch_hz[above])
    is_one = np.abs(high - low) < 1.0 / 12.0
    nearest = np.where(part < 0.5, low, high)
    pitch = np.where(is_one, low + part * (high - low), nearest)
    sure = certainty[below]
    return 2.0**pitch, sure + part * (certainty[above] - sure)
