"""What is heard of notes: pitch and level each 5 ms, and figures of how each note moves.

This knows when notes begin, how long they are and their pitches, as who reads a score does, and
nothing of bow or fingers. The pitch is that of the first high peak of the normalised square
difference [McLeod]; where every second or third harmonic alone has all but a little of the power,
an octave or a twelfth higher, since a string that rings a fifth above makes both repeat later.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import binary_opening
from scipy.signal import find_peaks, resample_poly

from yehu_server.following.frames import HIGHEST_HZ, first_peaks_hz, nsdf, refined
from yehu_server.util.loudness import a_weighting

Array = Any

RATE, HOP, HOP_S = 16000, 80, 0.005
SIZE, LEVEL_SIZE = 512, 256  # samples of a window for the pitch, and for the level
HARMONICS, FEW = 12, 0.03  # share of the power that the others must have
CLEAR = 0.75  # clarity from which there is a pitch
LOUD_DB, SOUNDING_DB = 15.0, 20.0  # below the loudest moment of a note
STROKE_DB, BEAT_SEMITONES = 3.0, 0.12  # least height of a peak of the level, and of the pitch
ON_PITCH = 0.4  # semitones
ENDS_S, LATEST_S, AFTER_S, LASTING_S = 0.03, 0.06, 0.03, 0.04


@dataclass(frozen=True)
class Track:
    """Of each 5 ms: level (dB, A-weighted), pitch (MIDI note; NaN for none). Shapes (frames,)."""

    level_db: Array
    pitch: Array

    def part(self, begin_s: float, end_s: float) -> Track:
        """What lies between two times."""
        here = slice(round(begin_s / HOP_S), round(end_s / HOP_S))
        return Track(self.level_db[here], self.pitch[here])


def heard(sound: Array, rate: float) -> Track:
    """Listen to a sound of one voice, ndarray [shape=(samples,)] at a rate (Hz)."""
    common = math.gcd(round(rate), RATE)
    low = resample_poly(np.asarray(sound, np.float64), RATE // common, round(rate) // common)
    frames = _frames(low)
    middle = frames[:, (SIZE - LEVEL_SIZE) // 2 : (SIZE + LEVEL_SIZE) // 2]
    window = np.hanning(LEVEL_SIZE)
    power = np.abs(np.fft.rfft(middle * window, axis=1)) ** 2
    weights = a_weighting(np.fft.rfftfreq(LEVEL_SIZE, 1.0 / RATE)) ** 2
    level = 10.0 * np.log10(power @ weights / np.square(window).sum() / LEVEL_SIZE * 2.0 + 1e-14)
    return Track(level, _pitches(frames))


def _frames(sound: Array) -> Array:
    padded = np.pad(sound, SIZE // 2)
    return np.lib.stride_tricks.sliding_window_view(padded, SIZE)[::HOP]


def _pitches(frames: Array) -> Array:
    """The pitch (MIDI note) of each frame; NaN where it has none."""
    curves = nsdf(frames)
    rough = first_peaks_hz(curves)
    found, like = refined(curves, np.arange(len(curves)), np.maximum(rough, 160.0))
    pitch = np.where((rough > 0.0) & (like > CLEAR), _not_too_low(frames, found), np.nan)
    return 69.0 + 12.0 * np.log2(pitch / 440.0)


def _not_too_low(frames: Array, found_hz: Array) -> Array:
    """Pitches (Hz), higher where only every second or third of their harmonics sounds."""
    spectrum = np.abs(np.fft.rfft(frames * np.hanning(SIZE), 8 * SIZE, axis=1)) ** 2
    orders = np.arange(1, HARMONICS + 1)
    places = np.rint(found_hz[:, None] * orders * 8 * SIZE / RATE).astype(int)
    power = np.take_along_axis(spectrum, np.minimum(places, spectrum.shape[1] - 1), axis=1)
    power *= places < spectrum.shape[1]
    total = power.sum(axis=1) + 1e-30
    higher = found_hz.copy()
    for n in (2, 3):
        alone = power[:, orders % n != 0].sum(axis=1) < FEW * total
        is_lower = alone & (higher == found_hz) & (n * found_hz < HIGHEST_HZ)
        higher = np.where(is_lower, n * found_hz, higher)
    return higher


@dataclass(frozen=True)
class Figures:
    """How one note moved. Pitches in semitones from its own; times in ms.

    `rise`: until the level is within 3 dB of its highest in the first 0.3 s.
    `lasts`: how long the level is within SOUNDING_DB of the loudest moment.
    `sounds`: the same as a share (%) of the note's length.
    `strokes`, `stroke_rate`, `dip`: peaks of the level within LOUD_DB that stand out by STROKE_DB;
    how many come in a second; how deep the level falls between them (dB).
    `begins`, `ends`, `low`, `high`: pitch at the beginning and before the end, and the 3rd and 97th
    of a hundred.
    `arrives`: from when on the first half of the note is on its pitch; NaN if never.
    `beats`, `beat_rate`, `width`: the same of the pitch: peaks, how many in a second, their height
    (cents).
    `swell`, `loudest`: level of the loudest moment over those of both ends (dB); when it is (share
    of the length).
    `fade`: level of the first 60 ms that sound over the last 60 ms of the note (dB).
    `off`: of the loud time from 30 ms on, the share (%) without a pitch or outside of where it may
    be, for LASTING_S or longer: a window on the step to another pitch has both, and so none.
    `level`: of all of the note (dB).
    """

    rise: float
    lasts: float
    sounds: float
    strokes: float
    stroke_rate: float
    dip: float
    begins: float
    ends: float
    low: float
    high: float
    arrives: float
    beats: float
    beat_rate: float
    width: float
    swell: float
    loudest: float
    fade: float
    off: float
    level: float


def figures(track: Track, begin_s: float, length_s: float, pitch: float, may: Array) -> Figures:
    """Return the figures of a note.

    `may`: between which pitches (semitones from its own) it may be.
    """
    note = track.part(begin_s, begin_s + length_s)
    level, tone = note.level_db, note.pitch - pitch
    loudest = float(level.max())
    is_loud = (level > loudest - LOUD_DB) & np.isfinite(tone)
    early = level[: round(0.3 / HOP_S)]
    rise = int(np.argmax(early > early.max() - 3.0))
    sounding = float((level > loudest - SOUNDING_DB).sum())
    strokes, height = _peaks(np.maximum(level, loudest - 40.0), STROKE_DB)
    struck = level[strokes] > loudest - LOUD_DB  # a beat in what rings is no stroke
    strokes, height = strokes[struck], height[struck]
    steady = np.where(is_loud, tone, np.nan)
    beats, width = _peaks(_joined(steady), BEAT_SEMITONES)
    inside = steady[np.isfinite(steady)]
    if not len(inside):
        inside = np.full(3, np.nan)
    clear = tone[level > loudest - 10.0]
    clear = clear[np.isfinite(clear)]
    few, late = round(ENDS_S / HOP_S), round(LATEST_S / HOP_S)
    half = np.abs(tone[: len(tone) // 2 + late]) < ON_PITCH
    after = slice(round(AFTER_S / HOP_S), None)
    counted = level[after] > loudest - LOUD_DB
    right = (tone[after] > may[0] - ON_PITCH) & (tone[after] < may[1] + ON_PITCH)
    smooth = _smooth(level)
    at = int(np.argmax(smooth))
    return Figures(
        rise=1e3 * HOP_S * rise,
        lasts=1e3 * HOP_S * sounding,
        sounds=100.0 * sounding / len(level),
        strokes=float(len(strokes)),
        stroke_rate=_rate(strokes),
        dip=float(np.median(height)) if len(height) > 1 else 0.0,
        begins=float(np.median(clear[:few])),
        ends=float(np.median(clear[-few:])),
        low=float(np.quantile(inside, 0.03)),
        high=float(np.quantile(inside, 0.97)),
        arrives=1e3 * HOP_S * _lasting(half),
        beats=float(len(beats)),
        beat_rate=_rate(beats),
        width=100.0 * float(np.median(width)) if len(width) else 0.0,
        swell=float(smooth[at] - max(smooth[rise : rise + late].mean(), smooth[-late:].mean())),
        loudest=at / len(level),
        fade=float(smooth[rise : rise + late].mean() - smooth[-late:].mean()),
        off=100.0 * float(_long(~right & counted).sum() / max(counted.sum(), 1)),
        level=float(10.0 * np.log10(np.mean(10.0 ** (level / 10.0)))),
    )


def _peaks(curve: Array, least: float) -> tuple[Array, Array]:
    """Places of the peaks of a curve that stand out, ends counted, and how much they do."""
    padded = np.concatenate(([curve.min() - least], curve, [curve.min() - least]))
    places, found = find_peaks(padded, prominence=least)
    sides = found["left_bases"], np.minimum(found["right_bases"], len(curve))
    heights = [
        padded[at] - max(padded[max(left, 1) : at + 1].min(), padded[at : right + 1].min())
        for at, left, right in zip(places, *sides, strict=True)
    ]
    return places - 1, np.array(heights)


def _joined(curve: Array) -> Array:
    """A curve without its gaps, smoothed over 15 ms; zeros where it has nothing."""
    known = np.flatnonzero(np.isfinite(curve))
    if not len(known):
        return np.zeros(len(curve))
    whole = np.interp(np.arange(len(curve)), known, curve[known])
    return np.array([np.median(whole[max(i - 1, 0) : i + 2]) for i in range(len(whole))])


def _smooth(level: Array) -> Array:
    return np.convolve(np.pad(level, 4, mode="edge"), np.full(9, 1 / 9), "valid")


def _long(is_off: Array) -> Array:
    """Of what is true, the runs that last for LASTING_S."""
    size = round(LASTING_S / HOP_S)
    return binary_opening(is_off, np.ones(size))


def _rate(places: Array) -> float:
    """How many peaks come in a second; 0 for fewer than three."""
    return 1.0 / (HOP_S * float(np.median(np.diff(places)))) if len(places) > 2 else 0.0


def _lasting(is_right: Array) -> float:
    """The first frame from which on five in a row are right; NaN if there is none."""
    runs = np.convolve(is_right, np.ones(5), "valid") > 4.5
    return float(np.argmax(runs)) if runs.any() else math.nan
