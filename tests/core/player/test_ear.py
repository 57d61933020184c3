"""The ear hears period, certainty and slips of pulse trains, which are known in closed form."""

from itertools import product

import numpy as np
import pytest
from pitch import cents, hertz

from yehu_server.core.player.ear import (
    DELAY_FRAMES,
    EAR,
    EAR_SAMPLES,
    PITCH_CERTAINTY,
    hear,
    prepare_ear,
    remember,
)

RATES = (44100.0, 48000.0, 96000.0)
NOTES = (65, 67, 69, 72, 76, 81, 85, 89)  # F4 to F6
OFFSETS = (-50.0, -20.0, 0.0, 5.0, 50.0)  # cents
SLIP = 0.12  # of a period
FIRST = 3 * EAR_SAMPLES + 1234  # the frame of the first hearing: what is heard has gone round


def pulses(phase: np.ndarray, at: float = 0.0) -> np.ndarray:
    """A slip once in a period of the phase: a smooth pulse, and 0 while the string sticks."""
    since = (phase - at) % 1.0 / SLIP
    return np.where(since < 1.0, np.sin(np.pi * since) ** 2, 0.0)


class Ear:
    """An ear that hears a sound, from its first frame on."""

    def __init__(self, rate: float) -> None:
        self.rate = rate
        self.record = np.zeros(1, EAR)[0]
        prepare_ear(self.record, rate)
        self._kept = np.zeros(2 * EAR_SAMPLES)
        self._frame = 0

    def listen(self, sound: np.ndarray) -> None:
        """Remember a sound."""
        for sample in sound:
            remember(self._kept, self._frame, sample)
            self._frame += 1

    def hear(self, expected_hz: float) -> tuple[float, float, float]:
        """The error (cents), certainty and slips of what was remembered last."""
        hear(self.record, self._kept, self._frame + DELAY_FRAMES, self.rate / expected_hz)
        return self.error, float(self.record["certainty"]), float(self.record["slips"])

    @property
    def error(self) -> float:
        return float(self.record["error"])


def phases(rate: float, frequency: float, frames: int = 0) -> np.ndarray:
    """The phase of a tone (periods), whose last frames fill an ear's memory."""
    return np.arange(frames or EAR_SAMPLES) * frequency / rate


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("slips", [1, 2])
def test_a_slipping_string_is_heard_within_half_a_cent(rate, slips, everything):
    for note in NOTES if everything else NOTES[::3]:
        for off in OFFSETS:
            sounding = hertz(note + off / 100.0)
            phase = phases(rate, sounding)
            sound = pulses(phase) + (0.6 * pulses(phase, 0.42) if slips == 2 else 0.0)
            ear = Ear(rate)
            ear.listen(sound)
            error, certainty, heard = ear.hear(hertz(note))
            assert abs(error - cents(sounding, hertz(note))) < 0.5, (note, off)
            assert certainty > 0.85, (note, off)  # the shortest slips are four samples long
            # one slip more or less, in what has its length within one period of the span
            periods = float(ear.record["span"]) * hertz(note) / rate - 1.0
            assert abs(heard - slips * sounding / hertz(note)) < 1.0 / periods, (note, off)


@pytest.mark.parametrize("rate", RATES)
def test_what_was_remembered_long_ago_is_forgotten(rate):
    ear = Ear(rate)
    ear.listen(np.random.default_rng(1).normal(size=FIRST))
    ear.listen(pulses(phases(rate, hertz(74.2))))
    error, certainty, slips = ear.hear(hertz(74))
    assert abs(error - 20.0) < 0.5
    assert certainty > 0.95
    assert slips == pytest.approx(1.0, abs=0.25)


@pytest.mark.parametrize("rate", RATES)
def test_a_pitch_that_moves_slowly_is_followed_and_one_that_jumps_is_found_again(rate):
    ear = Ear(rate)
    hop = int(ear.record["hop"])
    assert hop == round(0.005 * rate)
    phase = 0.0
    glide = [*np.linspace(0.0, 40.0, 100), *[40.0] * 20, *[-45.0] * 20]
    errors, certainties = [], []
    for off in glide:
        frequency = hertz(70 + off / 100.0)
        ear.listen(pulses(phase + phases(rate, frequency, hop)))
        phase += hop * frequency / rate
        error, certainty, _ = ear.hear(hertz(70))
        errors.append(error)
        certainties.append(certainty)
    # It lags by half of two spans of 7 ms, and 0.4 cents go by in each hop of 5 ms.
    assert np.abs(np.array(errors[20:100]) - glide[20:100]).max() < 1.5
    assert np.abs(np.array(errors[110:120]) - 40.0).max() < 0.5
    assert np.abs(np.array(errors[130:]) + 45.0).max() < 0.5
    assert min(certainties[20:120] + certainties[130:]) > PITCH_CERTAINTY


@pytest.mark.parametrize("rate", RATES)
def test_noise_has_no_certain_pitch(rate):
    for seed, note in product(range(5), NOTES):
        ear = Ear(rate)
        ear.listen(np.random.default_rng(seed).normal(size=EAR_SAMPLES))
        assert ear.hear(hertz(note))[1] < 0.8, (seed, note)
