"""Gathers what a picture of a rendering shows, as it is rendered, in bounded memory."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from yehu_server.playing.pitch_and_level import pitch_hz

Array = Any

COLUMNS = 3000  # of the picture, at most
STEP_S = 0.01  # between two columns, at least
WINDOW_S = 0.046  # of which each column is
TOP_HZ = 8000.0
SILENT_DB = -120.0
HEARD_DB = -60.0  # below, no pitch is searched


class PlotData:
    """Level, spectrum and pitch of a sound at up to `COLUMNS` times, and the pitches asked for.

    Rate and A4 are in Hz; the pitch of a sound is searched where there is one voice. Between two
    columns there are `step` frames.
    `step_s` sets their distance; by default it is such that there are not too many.
    """

    def __init__(
        self,
        rate: float,
        duration_s: float,
        voices: int,
        a4: float = 440.0,
        step_s: float | None = None,
    ) -> None:
        self.rate, self.a4, self.voices = rate, a4, voices
        self.window = round(WINDOW_S * rate)
        usual = max(round(STEP_S * rate), math.ceil(duration_s * rate / COLUMNS))
        self.step = usual if step_s is None else round(step_s * rate)
        self.rows = min(math.ceil(TOP_HZ * self.window / rate), self.window // 2)
        self._shape = np.hanning(self.window)
        self._kept = np.zeros(self.window // 2)  # half a window before the first column
        self._peaks: list[float] = []
        self._powers: list[float] = []
        self._spectra: list[Array] = []
        self._pitches: list[float] = []
        self._asked: list[tuple[float, ...]] = []
        self._asked_at: list[float] = []
        self._frames = 0

    def take(self, samples: Array, asked: Sequence[float | None]) -> None:
        """Take the next samples [shape=(frames,) or (frames, channels)].

        `asked` is the pitch that each instrument is asked for at their end (fractional MIDI note).
        """
        sound = np.asarray(samples, np.float64)
        self._frames += len(sound)
        self._asked_at.append(self._frames / self.rate)
        self._asked.append(tuple(math.nan if each is None else each for each in asked))
        self._add(sound if sound.ndim == 1 else sound.mean(axis=1))

    def finish(self) -> None:
        """Measure the last half window, which silence follows."""
        self._add(np.zeros(self.window // 2))

    def _add(self, mono: Array) -> None:
        middle = max((self.window - self.step) // 2, 0)
        self._kept = np.concatenate((self._kept, mono))
        while len(self._kept) >= max(self.window, self.step):
            self._measure(self._kept[: self.window], self._kept[middle : middle + self.step])
            self._kept = self._kept[self.step :]

    def _measure(self, part: Array, step: Array) -> None:
        self._peaks.append(float(np.abs(step).max(initial=0.0)))
        self._powers.append(float(np.mean(np.square(part))))
        spectrum = np.abs(np.fft.rfft(part * self._shape)[: self.rows])
        full = 0.5 * self._shape.sum()  # what a sine of full scale gives
        self._spectra.append((spectrum / full).astype(np.float32))
        pitch = math.nan
        if self.voices == 1 and self.levels_of(self._powers[-1:])[0] > HEARD_DB:
            found = pitch_hz(part, self.rate)
            pitch = 69.0 + 12.0 * math.log2(found / self.a4) if math.isfinite(found) else math.nan
        self._pitches.append(pitch)

    @staticmethod
    def levels_of(powers: Sequence[float]) -> Array:
        """Powers in dB of full scale."""
        return 10.0 * np.log10(np.maximum(powers, 10.0 ** (SILENT_DB / 10.0)))

    @property
    def duration_s(self) -> float:
        """How much was taken."""
        return self._frames / self.rate

    @property
    def times_s(self) -> Array:
        """The middle of each column."""
        return np.arange(len(self._powers)) * self.step / self.rate

    @property
    def levels_db(self) -> Array:
        """Root mean square of each column (dB of full scale)."""
        return self.levels_of(self._powers)

    @property
    def peaks_db(self) -> Array:
        """Largest sample of each column (dB of full scale)."""
        return self.levels_of(np.square(self._peaks).tolist())

    @property
    def pitches(self) -> Array:
        """Pitch heard in each column (fractional MIDI note); NaN for none."""
        return np.array(self._pitches)

    @property
    def asked(self) -> tuple[Array, Array]:
        """Times (s), and the pitches asked for then: ndarray [shape=(times, voices)]."""
        return np.array(self._asked_at), np.array(self._asked).reshape(-1, self.voices)

    @property
    def spectra_db(self) -> Array:
        """Spectrum of each column (dB of a sine of full scale): ndarray [shape=(rows, columns)]."""
        if not self._spectra:
            return np.zeros((self.rows, 0))
        return 20.0 * np.log10(np.maximum(np.array(self._spectra).T, 1e-6))

    @property
    def row_hz(self) -> float:
        """Frequency from one row of the spectra to the next."""
        return self.rate / self.window
