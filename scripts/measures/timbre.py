"""Loudness, brightness and attack of a sound."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from measures.take import Setup, Sound, Take
from yehu_server.playing.mapping import DEFAULT
from yehu_server.playing.pitch_and_level import a_weighted_db

STEADY_S, END_S = 0.3, 0.8
RMS_S = 0.01


@dataclass(frozen=True)
class Timbre:
    """What a note sounds like."""

    level_db: float  # A-weighted, from 0.3 s on
    centroid_hz: float  # from 0.3 s on
    attack_ms: float
    peak: float  # largest sample


def centroid_hz(sound: Sound, rate: float) -> float:
    """Return the spectral centroid (Hz): the mean frequency, by power."""
    heard = sound.astype(np.float64)
    power = np.abs(np.fft.rfft(heard * np.hanning(len(heard)))) ** 2
    return float((np.fft.rfftfreq(len(heard), 1.0 / rate) * power).sum() / power.sum())


def attack_ms(sound: Sound, rate: float) -> float:
    """Return the time (ms) to within 6 dB of the steady level: the middle of 10 ms of sound."""
    window = round(RMS_S * rate)
    energy = np.cumsum(np.concatenate(([0.0], sound.astype(np.float64) ** 2)))
    level = np.sqrt((energy[window:] - energy[:-window]) / window)
    steady = math.sqrt(float(np.mean(sound[round(STEADY_S * rate) :].astype(np.float64) ** 2)))
    first = int(np.argmax(level >= 0.5 * steady))
    return 1e3 * (first + 0.5 * window) / rate


def timbre(
    setup: Setup, note: int, wheel: int | None, velocity: int, mapping: str = DEFAULT
) -> Timbre:
    """Play a note and return what it sounds like."""
    take = Take(setup, mapping=mapping)
    take.wheel(wheel)
    take.on(0.0, note, velocity)
    sound = take.play(END_S)
    steady = sound[round(STEADY_S * setup.rate) :]
    return Timbre(
        a_weighted_db(steady, setup.rate),
        centroid_hz(steady, setup.rate),
        attack_ms(sound, setup.rate),
        float(np.abs(sound).max()),
    )
