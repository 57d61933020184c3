"""Loudness, by the test signals of the standard and of broadcasters."""

import math

import numpy as np
import pytest

from yehu_server.rendering.loudness import loudness_lufs


def sine(level_db: float, seconds: float, rate: float, hz: float = 997.0):
    times = np.arange(round(seconds * rate)) / rate
    return 10.0 ** (level_db / 20.0) * np.sin(2.0 * np.pi * hz * times)


@pytest.mark.parametrize("rate", [32000.0, 44100.0, 48000.0, 96000.0])
def test_a_full_sine_in_one_channel_has_the_loudness_of_the_standard(rate):
    assert loudness_lufs([sine(0.0, 5.0, rate)], rate) == pytest.approx(-3.01, abs=0.03)


def test_two_channels_add_up():
    x = sine(-23.0, 5.0, 48000.0, 1000.0)
    both = np.column_stack((x, x))
    assert loudness_lufs([both], 48000.0) == pytest.approx(-23.0, abs=0.05)


def test_what_is_much_quieter_does_not_count():
    quiet, loud = (  # of a second, which is whole periods
        np.column_stack(2 * [sine(level, 1.0, 48000.0, 1000.0)]) for level in (-36.0, -23.0)
    )
    blocks = 5 * [quiet] + 30 * [loud] + 5 * [quiet]
    assert loudness_lufs(blocks, 48000.0) == pytest.approx(-23.0, abs=0.1)


def test_low_sounds_count_less_and_high_ones_more():
    low, mid, high = (
        loudness_lufs([sine(-20.0, 3.0, 48000.0, hz)], 48000.0) for hz in (40, 1000, 8000)
    )
    assert low < mid - 5.0
    assert mid + 2.5 < high < mid + 4.0


def test_the_pieces_do_not_matter():
    x = np.random.default_rng(1).normal(0.0, 0.1, (100_000, 2))
    whole = loudness_lufs([x], 44100.0)
    for size in (777, 65536):
        pieces = [x[at : at + size] for at in range(0, len(x), size)]
        assert loudness_lufs(pieces, 44100.0) == pytest.approx(whole, abs=1e-9)


@pytest.mark.parametrize("seconds", [0.0, 0.3, 3.0])
def test_silence_and_what_is_too_short_have_none(seconds):
    assert loudness_lufs([np.zeros(round(seconds * 44100))], 44100.0) == -math.inf
    assert loudness_lufs([], 44100.0) == -math.inf
