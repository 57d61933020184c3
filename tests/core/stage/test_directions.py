"""A body sounds differently to both sides, and the mean of both is what was measured."""

import numpy as np
import pytest
from stages import SMALL, Stage, response, stage_inputs

RATES = [22050.0, 44100.0, 48000.0, 96000.0, 192000.0]


def bands(fraction: int) -> np.ndarray:
    return 100.0 * 2.0 ** np.arange(0.0, 6.6, 1.0 / fraction)


def levels(sound: np.ndarray, rate: float, fraction: int) -> np.ndarray:
    """Energy in bands of a fraction of an octave (dB), where the rate has them."""
    power = np.abs(np.fft.rfft(sound)) ** 2
    hertz = np.fft.rfftfreq(len(sound), 1.0 / rate)
    half = 2.0 ** (0.5 / fraction)
    found = [
        power[(hertz >= centre / half) & (hertz < centre * half)].sum()
        for centre in bands(fraction)
        if centre * half < 0.45 * rate
    ]
    return 10.0 * np.log10(found)


@pytest.mark.parametrize("rate", RATES)
def test_both_sides_sum_to_the_measured_sound(rate):
    rng = np.random.default_rng(4)
    dry = SMALL * rng.normal(size=round(rate))
    stage = Stage(rate)
    asked = {"width": 1.0, "level": 0.0, "distance": 2.0}
    stage.settle(0.1, **asked)
    out = stage.play(dry, stage_inputs(len(dry), **asked))[0].astype(np.float64)
    for fraction in (1, 12):
        heard = levels(out.mean(axis=1), rate, fraction)
        assert np.allclose(heard, levels(dry, rate, fraction), atol=0.1)
        aside = levels(out[:, 0] - out[:, 1], rate, fraction)
        assert np.max(aside - heard) > 0.0  # and both sides differ


def test_low_notes_sound_alike_to_both_sides_and_high_ones_do_not():
    rate = 48000.0
    direct, _ = response(rate, 0.5, width=1.0, level=0.0)
    spectra = np.fft.rfft(direct, axis=0)
    hertz = np.fft.rfftfreq(len(direct), 1.0 / rate)
    ratio = 20.0 * np.log10(np.abs(spectra[:, 0]) / np.abs(spectra[:, 1]))
    assert np.abs(ratio[hertz < 300.0]).max() < 1.0
    assert np.abs(ratio[(hertz > 2000.0) & (hertz < 8000.0)]).max() > 6.0


@pytest.mark.parametrize("rate", RATES[1:])
def test_the_sides_differ_smoothly_and_not_as_a_comb(rate):
    direct, _ = response(rate, 0.5, level=0.0)
    hertz = np.fft.rfftfreq(len(direct), 1.0 / rate)
    for ear in direct.T:
        level = 20.0 * np.log10(np.abs(np.fft.rfft(ear)))[(hertz > 200.0) & (hertz < 16000.0)]
        assert np.ptp(level) < 6.0
        turns = np.sum(np.diff(np.sign(np.diff(level))) != 0)
        assert turns <= 12  # highest and lowest points, over more than six octaves


def test_the_room_answers_to_all_players():
    rate, frames = 48000.0, 9600
    rows = np.array([stage_inputs(frames, level=0.5, pan=pan) for pan in (-0.5, 0.6)])

    def room(*loud: float) -> np.ndarray:
        stage = Stage(rate, 2)
        stage.settle(level=0.5)
        dry = np.zeros((2, frames))
        dry[:, 0] = SMALL * np.array(loud)
        return stage.play(dry, rows)[1][:, -1] / SMALL

    first, second = room(1.0, 0.0), room(0.0, 1.0)
    assert np.allclose(first + second, room(1.0, 1.0), atol=1e-9)
    for heard, own in zip((first, second), rows, strict=True):
        alone = Stage(rate)
        alone.settle(level=0.5)
        dry = np.zeros(frames)
        dry[0] = SMALL
        expected = alone.play(dry, own)[1][:, -1] / SMALL
        assert np.abs(expected).max() > 0.01
        assert np.allclose(heard, expected, atol=1e-9)


def test_a_player_at_twice_the_distance_is_half_as_loud_and_has_more_of_the_room():
    near, far = (response(48000.0, 1.0, distance=distance, width=0.0) for distance in (2.0, 4.0))
    assert np.abs(far[0]).max() == pytest.approx(0.5 * np.abs(near[0]).max(), rel=1e-9)
    late = slice(4800, None)
    assert np.sum(far[1][late] ** 2) == pytest.approx(np.sum(near[1][late] ** 2), rel=0.01)


def test_a_player_on_one_side_sends_its_sound_into_the_room_from_there():
    late = slice(9600, None)  # after 0.2 s no reflection is heard by itself
    left, middle, right = (
        response(48000.0, 0.5, pan=pan, width=0.0)[1][late] for pan in (-1.0, 0.0, 1.0)
    )
    largest = np.abs(middle).max()
    # Of equal power: each side has the root of two more than either side of one in the middle.
    assert np.abs(left + right - np.sqrt(2.0) * middle).max() < 1e-9 * largest
    assert np.abs(left - right).max() > 0.5 * largest
