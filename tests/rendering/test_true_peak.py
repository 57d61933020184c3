"""True peaks, of waves whose own are known; and integrated loudness."""

import itertools
import math

import numpy as np
import pytest
from measures.bs1770 import lufs

from yehu_server.rendering.to_files import PHASES, TAPS, TruePeak
from yehu_server.util.loudness import IntegratedLoudness


def peak_of(sound: np.ndarray, block: int = 1000) -> float:
    meter = TruePeak()
    for at in range(0, len(sound), block):
        meter.add(sound[at : at + block])
    return meter.finish()


def sine(share: float, phase: float, frames: int = 4000) -> np.ndarray:
    """A sine of amplitude 1 at a share of the sample rate, that comes and goes."""
    wave = np.sin(2.0 * np.pi * share * np.arange(frames) + phase)
    return wave * np.hanning(frames)


@pytest.mark.parametrize("share", [0.01, 0.125, 0.25, 0.3])
@pytest.mark.parametrize("phase", [0.0, 0.25 * math.pi])
def test_a_sine_has_its_amplitude_wherever_it_is_sampled(share, phase):
    # The standard allows 0.69 dB less up to 0.45 of the rate, and 0.2 to 0.4 dB more.
    within = 0.2 if share <= 0.25 else 0.6
    assert 20.0 * math.log10(peak_of(sine(share, phase))) == pytest.approx(0.0, abs=within)


def test_it_is_as_without_blocks_and_without_leaving_anything_out():
    # Between its samples it is higher than at any.
    sound = np.column_stack([sine(0.25, phase, 3000) for phase in (0.25 * math.pi, 0.8)])
    padded = np.concatenate((np.zeros((TAPS, 2)), sound, np.zeros((TAPS, 2))))
    whole = max(
        np.abs(np.convolve(channel, phase)).max() for channel in padded.T for phase in PHASES
    )
    assert whole > 1.1 * np.abs(sound).max()
    for block, start in itertools.product((7, 100, 3000), range(20)):  # blocks end at any place
        assert peak_of(sound[start:], block) == pytest.approx(whole, rel=1e-12)


def test_what_the_last_samples_lead_to_counts():
    sound = np.array([0.0, 0.5, 1.0, 1.0])
    assert 1.05 < peak_of(sound) == peak_of(np.concatenate((sound, np.zeros(30))))


def test_loudness_is_that_of_filters_with_a_memory():
    rng = np.random.default_rng(1)
    for rate, share in ((44100, 0.02), (96000, 0.005)):
        frames = np.arange(3 * rate)
        loud = np.where(frames < 2 * rate, 0.2, 0.002)  # the end is below the gate
        wave = np.sin(2.0 * np.pi * share * frames)
        sound = np.column_stack([wave, rng.normal(size=len(frames))]) * loud[:, None]
        meter = IntegratedLoudness(rate)
        for block in np.array_split(sound, 50):
            meter.add(block)
        assert meter.lufs(0.5) == pytest.approx(lufs(0.5 * sound, rate), abs=0.1)
    assert IntegratedLoudness(44100).lufs() is None
