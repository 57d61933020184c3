"""`life`: how much held notes vary, as a person's do: neither a machine's nor rough."""

from typing import Any

import numpy as np
from scipy.signal import fftconvolve

from measures.shares import Share, share_line
from measures.take import NOTES, Setup, held, in_parallel
from yehu_server.core.player.note_tables import OPEN_NOTES, frequency_hz

Array = Any

VELOCITIES = (40, 80, 120)
FROM_S, END_S = 0.7, 3.0  # of the steady part; on an endless bow
WINDOW_S, HOP_S, APART_S = 0.02, 0.005, 0.002
MAX_HZ, MAX_HARMONICS = 6000.0, 12
BAND_HZ = (100.0, 10_000.0)
SPECTRUM_S, HALF_WIDTH_HZ = 0.1, 60.0  # of a spectrum, and of a harmonic in it
# What counts as alive: cents in 20 ms, per cent from period to period, dB.
PITCH_CENTS, SHIMMER_PERCENT, HARMONICS_DB = (0.7, 3.0), (0.5, 4.0), (20.0, 42.0)


def pitch_track(sound: Array, rate: float, frequency: float) -> Array:
    """Return how far (cents) the pitch is from a frequency (Hz), every HOP_S.

    Each harmonic is brought down to 0 Hz and averaged in a window of WINDOW_S; the turning of its
    phase gives its frequency. Strong and high harmonics count most.
    """
    size = round(2 * WINDOW_S * rate)  # a Hann window's effective width is half its length
    window = np.hanning(size)
    apart, hop = round(APART_S * rate), round(HOP_S * rate)
    time = np.arange(len(sound)) / rate
    total, weights = 0.0, 0.0
    for k in range(1, min(MAX_HARMONICS, int(MAX_HZ / frequency)) + 1):
        turned = sound * np.exp(-2j * np.pi * k * frequency * time)
        mean = fftconvolve(turned, window, "valid")
        angle = np.angle(mean[apart:] * np.conj(mean[:-apart]))[::hop]
        weight = k * k * np.abs(mean[:-apart:hop]) ** 2
        total = total + weight * angle * rate / (2.0 * np.pi * apart * k)
        weights = weights + weight
    return 1200.0 * np.log2(1.0 + total / weights / frequency)


def mean_frequency(sound: Array, rate: float, frequency: float) -> float:
    """Return the mean frequency (Hz) of a sound of about this one."""
    for _ in range(3):
        frequency *= 2.0 ** (float(pitch_track(sound, rate, frequency).mean()) / 1200.0)
    return frequency


def shimmer(sound: Array, rate: float, frequency: float) -> float:
    """Return the mean difference (%) of peak-to-peak amplitudes of periods in a row."""
    starts = (np.arange(int(len(sound) * frequency / rate)) * rate / frequency).astype(int)
    periods = [sound[start : start + int(rate / frequency) + 1] for start in starts]
    sizes = np.array([float(np.ptp(period)) for period in periods])
    return float(100.0 * np.abs(np.diff(sizes)).mean() / sizes.mean())


def harmonics_to_noise(sound: Array, rate: float, frequency: float) -> float:
    """Return the level (dB) of the harmonics above that of all between them, within BAND_HZ."""
    size = round(SPECTRUM_S * rate)
    window = np.blackman(size)
    f = np.fft.rfftfreq(4 * size, 1.0 / rate)
    inside = (f > BAND_HZ[0]) & (f < BAND_HZ[1])
    is_near = np.abs(f - frequency * np.rint(f / frequency)) < HALF_WIDTH_HZ
    is_near &= f > frequency / 2.0
    harmonics, rest = 0.0, 0.0
    for start in range(0, len(sound) - size, size // 2):
        power = np.abs(np.fft.rfft(sound[start : start + size] * window, 4 * size)) ** 2
        harmonics += float(power[inside & is_near].sum())
        rest += float(power[inside & ~is_near].sum())
    rest *= frequency / (frequency - 2.0 * HALF_WIDTH_HZ)  # as much lies under the harmonics
    return float(10.0 * np.log10(harmonics / rest))


def variation_of(setup: Setup, note: int, velocity: int) -> tuple[float, float, float]:
    """Return pitch deviation (cents), shimmer (per cent) and harmonics to noise (dB) of a note."""
    whole, _ = held(setup, note, velocity, END_S, settings={"/playing/bow_length": 0.0})
    sound = whole[round(FROM_S * setup.rate) :].astype(float)
    frequency = mean_frequency(sound, setup.rate, frequency_hz(note, 440.0))
    deviation = float(pitch_track(sound, setup.rate, frequency).std())
    at = (sound, setup.rate, frequency)
    return deviation, shimmer(*at), harmonics_to_noise(*at)


def life(setup: Setup) -> list[Share]:
    """Print how much the steady part of each note varies; use it with ``--variation default``."""
    jobs = [(note, velocity) for note in NOTES for velocity in VELOCITIES]
    found = np.array(in_parallel(setup, variation_of, jobs))
    table = found.reshape(len(NOTES), len(VELOCITIES), 3)
    print(f"at velocities {VELOCITIES}: pitch (cents), shimmer (%), harmonics to noise (dB)")
    for note, row in zip(NOTES, table, strict=True):
        columns = (" ".join(f"{value:6.2f}" for value in row[:, i]) for i in range(3))
        print(f"{note}: {'   '.join(columns)}")
    is_stopped = np.array([note not in OPEN_NOTES for note, _ in jobs])
    words = np.array([f"{note} at {velocity}" for note, velocity in jobs])

    def part(what: str, values: Array, lo: float, hi: float, of: Array) -> Share:
        said = [f"{word} {value:.2f}" for word, value in zip(words[of], values[of], strict=True)]
        right = (values[of] >= lo) & (values[of] <= hi)
        return share_line(f"{what} {lo:g} to {hi:g}", right, said)

    anywhere = np.ones(len(jobs), bool)
    return [
        part("pitch of stopped notes (cents)", found[:, 0], *PITCH_CENTS, is_stopped),
        part("shimmer (%)", found[:, 1], *SHIMMER_PERCENT, anywhere),
        part("harmonics to noise (dB)", found[:, 2], *HARMONICS_DB, anywhere),
    ]
