"""A recording and a rendering, laid over each other: spectra, levels and pitches."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from yehu_server.api.checks import PathLike, number, path_of
from yehu_server.errors import ParameterError
from yehu_server.following.recording import recording_of_file
from yehu_server.params.table import HIGHEST_A4, LOWEST_A4
from yehu_server.plot.axes import ABOVE, figure_of
from yehu_server.plot.sound_panels import ASKED, GRID, HEARD, label_notes
from yehu_server.plot.sounds import plot_data_of
from yehu_server.rendering.plot_data import TOP_HZ, PlotData

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from yehu_server.api.rendered import Rendering
    from yehu_server.api.simulated import Simulation

Floats = NDArray[np.float64]

STEP_S = 0.01  # of the times
BANDS_AN_OCTAVE, LOWEST_HZ = 6, 50.0
BELOW_DB = 40.0  # under the loudest moment, beyond which a sound is silent
LONGEST_S = 600.0
SEMITONE = 100.0  # cents
SIZE = (10.0, 8.0)  # inches
NOTHING = -120.0  # dB
BANDS = int(BANDS_AN_OCTAVE * math.log2(TOP_HZ / LOWEST_HZ))
EDGES_HZ = LOWEST_HZ * np.exp2(np.arange(BANDS + 1) / BANDS_AN_OCTAVE)  # between them


@dataclass(frozen=True, eq=False)
class Comparison:
    """How a rendering differs from a recording, after both are put at one time and level.

    Attributes
    ----------
    frequencies : ndarray [shape=(bands,)]
        Middles (Hz) of bands of a sixth of an octave.
    spectra : ndarray [shape=(2, bands)]
        Long-time average of recording and rendering where they sound (dB of all its power).
    times : ndarray [shape=(times,)]
        Seconds of the recording.
    levels : ndarray [shape=(2, times)]
        Of recording and rendering (dB of its loudest moment).
    pitches : ndarray [shape=(2, times)]
        Of recording and rendering (fractional MIDI note); NaN where there is none.
    later : float
        Seconds by which the rendering was moved to meet the recording; above 0 it began too early.
    louder : float
        Decibels by which the rendering is louder, as a whole.
    """

    frequencies: Floats
    spectra: Floats
    times: Floats
    levels: Floats
    pitches: Floats
    later: float
    louder: float

    @property
    def spectrum_db(self) -> float:
        """Difference of both spectra (dB rms over bands within 40 dB of the loudest)."""
        recorded, rendered = self.spectra
        heard = recorded > recorded.max() - BELOW_DB
        return _rms((rendered - recorded)[heard])

    @property
    def level_db(self) -> float:
        """Difference of both levels (dB rms over the time in which the recording sounds)."""
        recorded, rendered = np.maximum(self.levels, -BELOW_DB)
        return _rms((rendered - recorded)[recorded > -BELOW_DB])

    @property
    def pitch_cents(self) -> float:
        """How much higher the rendering is (cents, median); NaN where no pitch is in both."""
        recorded, rendered = self.pitches
        both = np.isfinite(recorded) & np.isfinite(rendered)
        return float(SEMITONE * np.median((rendered - recorded)[both])) if both.any() else math.nan

    def __repr__(self) -> str:
        off = self.pitch_cents
        pitch = f"pitch {off:+.0f} cents" if math.isfinite(off) else "no common pitch"
        return (
            f"<yehu_server.Comparison of {len(self.times) * STEP_S:.2f} s: "
            f"spectrum {self.spectrum_db:.1f} dB, level {self.level_db:.1f} dB, {pitch}>"
        )

    def plot(self, figure: Figure | None = None) -> Figure:
        """Draw both spectra, levels and pitches over each other; needs matplotlib."""
        found = figure_of(figure, *SIZE)
        panels = found.subplots(3, 1, height_ratios=(1.4, 1.0, 1.4))
        for row, (name, colour) in enumerate((("recording", ASKED), ("rendering", HEARD))):
            style: Any = {"color": colour, "lw": 1.6 - 0.6 * row, "label": name}
            panels[0].plot(self.frequencies, self.spectra[row], **style)
            panels[1].plot(self.times, self.levels[row], **style)
            panels[2].plot(self.times, self.pitches[row], ".", ms=3.5 - 1.5 * row, color=colour)
        panels[0].set(
            xscale="log", xlabel="Hz", ylabel="dB of all power",
            ylim=(self.spectra.max() - 2.0 * BELOW_DB, self.spectra.max() + 3.0),
        )  # fmt: skip
        panels[0].legend(**ABOVE)
        panels[0].set_title(repr(self).partition(": ")[2].rstrip(">"), loc="left", fontsize=10)
        panels[1].set(ylabel="dB of the loudest", ylim=(-1.5 * BELOW_DB, 3.0))
        panels[2].set(ylabel="pitch", xlabel="s of the recording", xlim=panels[1].get_xlim())
        known = self.pitches[np.isfinite(self.pitches)]
        if len(known):
            label_notes(panels[2], float(known.min()) - 1.5, float(known.max()) + 1.5)
        for panel in panels[:2]:
            panel.grid(**GRID)
        return found


def compare(
    recording: PathLike | NDArray[Any] | Rendering | Simulation,
    rendering: PathLike | NDArray[Any] | Rendering | Simulation,
    sample_rate: float | None = None,
    *,
    a4: float = 440.0,
) -> Comparison:
    """Lay a rendering over a recording: long-time spectra, levels, pitches.

    The rendering is moved in time to where the course of both spectra agrees best, and each level
    counts from its own loudest moment. It is not stretched: what is played slower drifts away.

    Parameters
    ----------
    recording, rendering : path, Rendering, Simulation or ndarray [shape=(frames,) or (frames, 2)]
        Sounds of up to ten minutes; of a simulation, the radiated pressure.
    sample_rate : float, optional
        Of arrays (Hz).
    a4 : float
        Reference pitch (Hz) of the pitches.

    Returns
    -------
    Comparison

    Raises
    ------
    YehuError
        Where one cannot be read, is no sound, or is silent.

    Examples
    --------
    >>> import numpy as np, yehu_server as yehu
    >>> time = np.arange(22050) / 44100
    >>> partials = [np.sin(2 * np.pi * 440.0 * n * time) / n for n in (1, 2, 3)]
    >>> tone = 0.3 * np.sum(partials, axis=0)
    >>> yehu.compare(tone, 0.5 * tone, 44100)
    <yehu_server.Comparison of 0.50 s: spectrum 0.0 dB, level 0.0 dB, pitch +0 cents>
    """
    a4 = number(a4, "a4", LOWEST_A4, HIGHEST_A4)
    one, other = (
        _track(sound, sample_rate, a4, name)
        for sound, name in ((recording, "recording"), (rendering, "rendering"))
    )
    shift = _best_shift(one.bands, other.bands)
    count = len(one.level)
    levels, pitches = np.full((2, count), NOTHING), np.full((2, count), np.nan)
    levels[0], pitches[0] = one.level, one.pitch
    begin, end = max(shift, 0), min(len(other.level) + shift, count)
    levels[1, begin:end] = other.level[begin - shift : end - shift]
    pitches[1, begin:end] = other.pitch[begin - shift : end - shift]
    sums = np.array([one.long_time, other.long_time])
    wholes = sums.sum(axis=1, keepdims=True)
    return Comparison(
        np.sqrt(EDGES_HZ[1:] * EDGES_HZ[:-1]),
        _db(sums / wholes),
        np.linspace(0.0, STEP_S * (count - 1), count),
        levels,
        pitches,
        shift * STEP_S,
        float(10.0 * np.log10(wholes[1, 0] / wholes[0, 0])),
    )


@dataclass(frozen=True, eq=False)
class _Track:
    """What a sound is each 10 ms: powers [shape=(bands, times)], level (dB), pitch."""

    bands: Floats
    level: Floats
    pitch: Floats

    @property
    def long_time(self) -> Floats:
        """Mean power of each band where the sound is not silent."""
        return np.asarray(self.bands[:, self.level > -BELOW_DB].mean(axis=1))


def _track(sound: Any, sample_rate: float | None, a4: float, name: str) -> _Track:
    """Follow a sound; refuses one that is silent or too long."""
    if isinstance(sound, str | os.PathLike):
        found = recording_of_file(path_of(sound, name), LONGEST_S / 3600.0)
        blocks = [block.mean(axis=1) for block in found.blocks()]
        sound, sample_rate = np.concatenate([np.zeros(0), *blocks]), float(found.rate)
    watch = plot_data_of(sound, sample_rate, a4, step_s=STEP_S)
    if watch.duration_s > LONGEST_S:
        raise ParameterError(f"{name}: lasts {watch.duration_s:.0f} s, more than {LONGEST_S:g}")
    if not np.isfinite(watch.levels_db).all():
        raise ParameterError(f"{name}: holds a sample that is not finite")
    if watch.levels_db.max(initial=NOTHING) <= NOTHING:
        raise ParameterError(f"{name}: is silent")
    times = np.arange(int(watch.times_s[-1] / STEP_S) + 1) * STEP_S
    at = np.rint(times * watch.rate / watch.step).astype(int)  # no whole frames are 10 ms at times
    level = watch.levels_db - watch.levels_db.max()
    return _Track(_bands(watch)[:, at], level[at], watch.pitches[at])


def _bands(watch: PlotData) -> Floats:
    """Power of each band at each time [shape=(bands, times)]."""
    power = 10.0 ** (0.1 * watch.spectra_db.astype(np.float64))
    lines = np.arange(len(power)) * watch.row_hz
    # A band narrower than a line has its part of it.
    summed = np.vstack([np.zeros(power.shape[1]), np.cumsum(power, axis=0)])
    places = np.clip(EDGES_HZ / watch.row_hz + 0.5, 0.0, len(lines))
    below = np.floor(places).astype(int)
    part = (places - below)[:, np.newaxis]
    upto = summed[below] + part * (summed[np.minimum(below + 1, len(lines))] - summed[below])
    return np.asarray(np.diff(upto, axis=0))


def _best_shift(recorded: Floats, rendered: Floats) -> int:
    """Steps by which the rendering is moved so that the course of the spectra agrees best."""
    courses = [
        np.maximum(_db(power / power.max()), -BELOW_DB) + BELOW_DB for power in (recorded, rendered)
    ]
    size = 1 << (courses[0].shape[1] + courses[1].shape[1] - 1).bit_length()
    one, other = (np.fft.rfft(course, size, axis=1) for course in courses)
    match = np.fft.irfft((one * other.conj()).sum(axis=0), size)
    shift = int(match.argmax())
    return shift if shift < courses[0].shape[1] else shift - size


def _db(power: Floats) -> Floats:
    return np.asarray(10.0 * np.log10(np.maximum(power, 10.0 ** (0.1 * NOTHING))))


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
