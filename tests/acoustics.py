"""Measures of rooms, taken of their impulse responses."""

from typing import Any

import numpy as np
import scipy

OCTAVES = (125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0)


def octave(sound: Any, rate: float, centre: float) -> Any:
    """The sound of one octave band, filtered forward and backward, so without delay."""
    edges = centre / np.sqrt(2.0), min(centre * np.sqrt(2.0), 0.49 * rate)
    sections = scipy.signal.butter(3, edges, "bandpass", fs=rate, output="sos")
    return scipy.signal.sosfiltfilt(sections, sound, axis=0, padlen=0)


def energy_left(response: Any) -> Any:
    """Schroeder's integral: the energy of all columns that is still to come at each frame."""
    power = np.sum(np.square(response), axis=1)
    return np.cumsum(power[::-1])[::-1]


def from_first_sound(response: Any) -> Any:
    """The response from its first sound on: 20 dB below the highest peak [ISO3382]."""
    power = np.sum(np.square(response), axis=1)
    return response[int(np.argmax(power > 1e-2 * power.max())) :]


def clarity_db(response: Any, rate: float) -> float:
    """C80: energy of the first 80 ms from the first sound on, over all that follows (dB)."""
    power = np.sum(np.square(from_first_sound(response)), axis=1)
    early, late = np.split(power, [round(0.08 * rate)])
    return float(10.0 * np.log10(early.sum() / late.sum()))


def early_decay_time(response: Any, rate: float) -> float:
    """EDT: the time of a decay by 60 dB (s), by the first 10 dB [ISO3382]."""
    return -60.0 / decay_line(from_first_sound(response), rate, 0.0, -10.0)[0]


def early_correlation(response: Any, rate: float) -> float:
    """IACC of the first 80 ms: the highest correlation of both ears within 1 ms [ISO3382]."""
    left, right = from_first_sound(response)[: round(0.08 * rate)].T
    within = round(1e-3 * rate)
    middle = len(left) - 1
    products = scipy.signal.correlate(left, right)[middle - within : middle + within + 1]
    energies = np.sum(np.square(left)) * np.sum(np.square(right))
    return float(np.max(np.abs(products)) / np.sqrt(energies))


def octaves_from(response: Any, rate: float, centres: tuple[float, ...]) -> list[Any]:
    """Octave bands of a response, filtered forward only: nothing sounds before it."""
    bands = []
    for centre in centres:
        edges = centre / np.sqrt(2.0), centre * np.sqrt(2.0)
        sections = scipy.signal.butter(3, edges, "bandpass", fs=rate, output="sos")
        bands.append(scipy.signal.sosfilt(sections, response, axis=0))
    return bands


def decay_line(response: Any, rate: float, from_db: float, to_db: float) -> tuple[float, float]:
    """Slope (dB/s), and level at the start (dB), of a line through a part of the decay curve."""
    left = energy_left(response)
    curve = 10.0 * np.log10(np.maximum(left, 1e-30))
    begin, end = (int(np.argmax(curve <= curve[0] + db)) for db in (from_db, to_db))
    slope, start = np.polyfit(np.arange(begin, end) / rate, curve[begin:end], 1)
    return float(slope), float(start)


def decay_time(response: Any, rate: float) -> float:
    """Time (s) of a decay by 60 dB, by the decay from -5 dB to -65 dB."""
    return -60.0 / decay_line(response, rate, -5.0, -65.0)[0]


def echo_density(response: Any, rate: float, at_s: float, window_s: float = 0.03) -> float:
    """Share of samples beyond a standard deviation about a time, over that of noise [Abel].

    The mean over all columns.
    """
    half, middle = round(window_s * rate / 2.0), round(at_s * rate)
    weights = np.hanning(2 * half + 1)[:, None]
    weights /= weights.sum()
    part = response[middle - half : middle + half + 1]
    deviation = np.sqrt(np.sum(weights * np.square(part), axis=0))
    shares = np.sum(weights * (np.abs(part) > deviation), axis=0)
    return float(np.mean(shares) / scipy.special.erfc(1.0 / np.sqrt(2.0)))


def highest_mode_db(tail: Any, rate: float, lo: float = 100.0, hi: float = 8000.0) -> float:
    """How far the highest peak of any 1/24 octave stands out of the half octave about it (dB).

    Of the power spectra of all columns together: a mode that rings is in all of them.
    """
    power = np.abs(np.fft.rfft(tail * np.hanning(len(tail))[:, None], axis=0)) ** 2
    power = power.mean(axis=1)
    hertz = np.fft.rfftfreq(len(tail), 1.0 / rate)
    summed = np.concatenate([[0.0], np.cumsum(power)])
    highest = 0.0
    for centre in lo * 2.0 ** np.arange(0.0, np.log2(hi / lo), 1.0 / 24.0):
        begin, end = np.searchsorted(hertz, centre * 2.0 ** np.array([-1 / 48, 1 / 48]))
        first, last = np.searchsorted(hertz, centre * 2.0 ** np.array([-1 / 4, 1 / 4]))
        if end > begin:
            mean = (summed[last] - summed[first]) / (last - first)
            highest = max(highest, power[begin:end].max() / mean)
    return float(10.0 * np.log10(highest))
