"""How far sounds are from recordings in spectrum and in modulation, in place of ears.

Both are differences (dB, rms) of a sound from the mean of the recordings: the spectrum in third
octaves, and how much each octave's envelope moves at 0.5 to 16 Hz, beside its mean, as in the
modulation spectra of [HoutgastSteeneken]. The level is left out. Recordings themselves, each beside
the others, say what is near. What is compared is dry, or stands in a room, alike.
"""

import argparse

import numpy as np

from listening.sounds import Array, Group, read

THIRDS_HZ = 1000.0 * 2.0 ** (np.arange(-7, 12) / 3.0)  # 200 Hz to 12.7 kHz
OCTAVES_HZ = 250.0 * 2.0 ** np.arange(6)  # to 8 kHz
MOVES_HZ = 0.5 * 2.0 ** np.arange(6)  # to 16 Hz
SIZE, HOP_S = 4096, 0.01
FLOOR_DB = -60.0  # below the strongest band, where recordings have their own noise


def powers(sound: Array, rate: int) -> tuple[Array, Array]:
    """Power of each frame and frequency [shape=(frames, bins)], and the frequencies (Hz)."""
    size = round(SIZE * rate / 44100.0)
    starts = np.arange(0, max(1, len(sound) - size), round(HOP_S * rate))
    window = np.hanning(size)
    mean = sound.mean(axis=1)
    rows = [np.abs(np.fft.rfft(mean[at : at + size] * window, size)) ** 2 for at in starts]
    return np.array(rows), np.fft.rfftfreq(size, 1.0 / rate)


def bands(power: Array, hz: Array, middles: Array, width: float) -> Array:
    """Power of each frame in bands so many octaves wide: (frames, bands)."""
    edge = 2.0 ** (width / 2.0)
    return np.stack(
        [power[:, (hz >= f / edge) & (hz < f * edge)].sum(axis=1) for f in middles], axis=1
    )


def decibels(power: Array) -> Array:
    """Levels, no lower than FLOOR_DB below the strongest."""
    return 10.0 * np.log10(np.maximum(power, power.max() * 10.0 ** (FLOOR_DB / 10.0)))


def spectrum_db(power: Array, hz: Array) -> Array:
    """The mean spectrum in third octaves, about its mean."""
    levels = decibels(bands(power, hz, THIRDS_HZ, 1.0 / 3.0).mean(axis=0))
    return levels - levels.mean()


def modulation_db(power: Array, hz: Array) -> Array:
    """How much each octave's envelope moves at each rate, beside its mean: (octaves, rates)."""
    envelope = np.sqrt(bands(power, hz, OCTAVES_HZ, 1.0))
    moving = (envelope - envelope.mean(axis=0)) * np.hanning(len(envelope))[:, None]
    squared = np.abs(np.fft.rfft(moving, axis=0)).T ** 2
    rates = np.fft.rfftfreq(len(envelope), HOP_S)
    found = bands(squared, rates, MOVES_HZ, 1.0)
    whole = (envelope.mean(axis=0)[:, None] * len(envelope) / 2.0) ** 2
    return 10.0 * np.log10(found / (whole + 1e-30) + 1e-6)


def features(group: Group) -> list[tuple[Array, Array]]:
    """Spectrum and modulation of each sound."""
    found = []
    for file in group.files():
        power, hz = powers(*read(file))
        found.append((spectrum_db(power, hz), modulation_db(power, hz)))
    return found


def distance(one: Array, others: list[Array]) -> float:
    """The rms difference (dB) from the mean of others."""
    return float(np.sqrt(np.mean(np.square(one - np.mean(others, axis=0)))))


def print_distances(options: argparse.Namespace) -> None:
    """Print medians over sounds, of each group and of the recordings beside each other."""
    recorded = features(options.recordings)
    print(f"{'medians, dB':24} spectrum  modulation  sounds")

    def line(name: str, sounds: list[tuple[Array, Array]], *, own: bool = False) -> None:
        apart = []
        for number, sound in enumerate(sounds):
            beside = [other for at, other in enumerate(recorded) if not own or at != number]
            apart.append(
                [distance(each, [o[kind] for o in beside]) for kind, each in enumerate(sound)]
            )
        spectrum, modulation = np.median(apart, axis=0)
        print(f"{name:24} {spectrum:8.1f} {modulation:11.1f} {len(sounds):7}")

    if len(recorded) > 1:
        line(f"{options.recordings.name}, each beside the others", recorded, own=True)
    for group in options.groups:
        line(group.name, features(group))
