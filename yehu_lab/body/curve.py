"""A measured response over frequency, and how certain each of its values is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

Floats = np.ndarray[Any, np.dtype[np.float64]]
Complexes = np.ndarray[Any, np.dtype[np.complex128]]

# Response per force, by what the response is; each is brought to mobility by powers of j omega.
KINDS = {"mobility": 0, "receptance": 1, "accelerance": -1}
RADIATION = "radiation"
OTHER_NAMES = {
    "admittance": "mobility", "velocity": "mobility", "compliance": "receptance",
    "displacement": "receptance", "inertance": "accelerance", "acceleration": "accelerance",
    "pressure": RADIATION,
}  # fmt: skip
GROUP = 1.0 / 250.0  # of the frequency: lines that are taken as one
AROUND = 25  # lines to each side, over which scatter is measured


@dataclass(frozen=True)
class Curve:
    """A complex response at rising frequencies, each array [shape=(lines,)].

    Admittance is in s/kg (velocity per force), radiation in Pa/N (pressure per force).
    """

    frequency_hz: Floats
    values: Complexes
    coherence: Floats | None = None  # 0 to 1, of several taps
    taps: int = 1  # that were averaged

    def within(self, lo_hz: float, hi_hz: float) -> Curve:
        """The lines from one frequency to another."""
        return self.at((self.frequency_hz >= lo_hz) & (self.frequency_hz <= hi_hz))

    def at(self, lines: Any) -> Curve:
        """Some lines, by their places or a mask."""
        return self._each(lambda values: values[lines])

    def grouped(self) -> Curve:
        """The means of neighbouring lines, as many as are neither heard nor seen apart."""
        number = np.floor(np.log(self.frequency_hz) / GROUP).astype(int)
        _, first = np.unique(number, return_index=True)
        counts = np.diff(np.append(first, len(number)))
        return self._each(lambda values: np.add.reduceat(values, first) / counts)

    def _each(self, change: Callable[[Any], Any]) -> Curve:
        coherence = None if self.coherence is None else change(self.coherence)
        return Curve(change(self.frequency_hz), change(self.values), coherence, self.taps)

    @property
    def deviation(self) -> Floats:
        """Standard deviation of each value, by how values scatter about their neighbours.

        The median of second differences, so that a resonance of some lines does not count.
        """
        if len(self.values) < 5:
            return np.zeros(len(self.values))
        bend = np.abs(self.values[2:] - 2.0 * self.values[1:-1] + self.values[:-2])
        # Of complex normal numbers the median of |x| is sqrt(ln 2) deviations, here of sqrt(6).
        scatter = running_median(bend) / np.sqrt(6.0 * np.log(2.0))
        return np.concatenate([scatter[:1], scatter, scatter[-1:]])


def running_median(values: Floats, around: int = AROUND) -> Floats:
    """Median of each value and its neighbours [shape=(values,)]."""
    around = min(around, (len(values) - 1) // 2)
    padded = np.pad(values, around, mode="reflect")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * around + 1)
    return np.asarray(np.median(windows, axis=1))


def interpolated(at_hz: Floats, frequency_hz: Floats, values: Complexes, **ends: float) -> Any:
    """Values between frequencies; beyond them the outermost, or as `ends` say (`numpy.interp`)."""
    real, imag = (
        np.interp(at_hz, frequency_hz, part, **ends) for part in (values.real, values.imag)
    )
    return real + 1j * imag


def to_mobility(
    frequency_hz: Floats, values: Complexes, kind: str, *, back: bool = False
) -> Complexes:
    """Bring a receptance (m/N) or accelerance (1/kg) to mobility (s/kg); or `back` from it."""
    power = -KINDS[kind] if back else KINDS[kind]
    return np.asarray(values * (2j * np.pi * frequency_hz) ** power)


def as_db(values: Any) -> Any:
    """Level of magnitudes (dB), never below -300."""
    return 20.0 * np.log10(np.maximum(np.abs(values), 1e-15))
