"""The hands drift and tremble, as far as the variation says."""

import numpy as np
import pytest
from held_notes import HOP, RATE, Playing

from yehu_server.core.controls.record import (
    CENTS_DRIFT,
    FORCE_DRIFT,
    POSITION_DRIFT,
    PRESS_DRIFT,
    SPEED_DRIFT,
)
from yehu_server.core.player.drift import CORRELATION, DRIFT, TREMOR, TREMOR_HZ

LONG_S = 30.0


@pytest.fixture(scope="module")
def drifts() -> np.ndarray:
    """What the hands of a note do for a while, at full variation [shape=(hops, 5)]."""
    playing = Playing(variation=1.0, bow_length=0.0)
    playing.on(74)
    (found,) = playing.play(LONG_S, "drift")
    return found


def power(track: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (Hz) and mean power of a track in windows of 8 s."""
    size = round(8.0 * RATE / HOP)
    parts = [track[at : at + size] for at in range(0, len(track) - size, size // 2)]
    window = np.hanning(size)
    spectra = [np.abs(np.fft.rfft(window * (part - part.mean()))) ** 2 for part in parts]
    return np.fft.rfftfreq(size, HOP / RATE), np.mean(spectra, axis=0)


def test_they_drift_as_far_as_they_are_said_to(drifts):
    wanted = np.hypot(DRIFT, TREMOR)
    assert drifts.std(axis=0) == pytest.approx(wanted, rel=0.35)
    assert np.abs(drifts.mean(axis=0)) == pytest.approx(np.zeros(5), abs=0.4 * wanted.max())


def test_with_phrasing_the_pitch_moves_more_to_and_fro_within_a_second_or_two(drifts):
    playing = Playing(variation=1.0, phrasing=0.5, bow_length=0.0)
    playing.on(74)
    (found,) = playing.play(LONG_S, "drift")
    hz, more = power(found[:, CENTS_DRIFT])
    _, usual = power(drifts[:, CENTS_DRIFT])
    within = (hz > 1.2) & (hz < 2.0)
    assert (more - usual)[within].sum() > 3.0 * (more - usual)[(hz > 0.1) & (hz < 0.8)].sum()
    assert more[within].sum() > 5.0 * usual[within].sum()


def test_the_drift_is_the_stronger_the_slower_and_the_tremor_is_about_ten_hertz(drifts):
    for which in (SPEED_DRIFT, FORCE_DRIFT, CENTS_DRIFT, PRESS_DRIFT):
        hz, found = power(drifts[:, which])
        slow, medium = (found[(hz > lo) & (hz < hi)].mean() for lo, hi in ((0.2, 0.6), (1.5, 4.0)))
        # About 1/f: power falls as the frequency rises, by its first power more or less.
        assert 2.0 < slow / medium < 60.0
        tremor = found[(hz > TREMOR_HZ - 2.0) & (hz < TREMOR_HZ + 2.0)].mean()
        assert tremor > 4.0 * found[(hz > 20.0) & (hz < 40.0)].mean()
        assert tremor > found[(hz > 5.0) & (hz < 7.0)].mean()


def test_what_one_hand_does_goes_together(drifts):
    together = np.corrcoef(drifts.T)
    # Of the drifts CORRELATION, and the tremor is one; the tremor alone would make 0.25 to 0.36.
    for one, other in (
        (SPEED_DRIFT, FORCE_DRIFT),
        (SPEED_DRIFT, POSITION_DRIFT),
        (CENTS_DRIFT, PRESS_DRIFT),
    ):
        parts = CORRELATION * DRIFT[one] * DRIFT[other] + TREMOR[one] * TREMOR[other]
        sizes = np.hypot(DRIFT, TREMOR)
        assert together[one, other] == pytest.approx(parts / (sizes[one] * sizes[other]), abs=0.2)
    assert abs(together[SPEED_DRIFT, CENTS_DRIFT]) < 0.35


def test_without_variation_they_are_still():
    playing = Playing(variation=0.0)
    playing.on(74)
    drift, length, width = playing.play(1.0, "drift", "sounding_drift", "vibrato_depth_factor")
    assert (drift == 0.0).all()
    assert (length == 1.0).all()
    assert (width == 1.0).all()


@pytest.mark.parametrize(
    ("address", "which"),
    [("/bow/speed", SPEED_DRIFT), ("/bow/force", FORCE_DRIFT), ("/bow/position", POSITION_DRIFT)],
)
def test_what_somebody_else_moves_is_steady(address, which):
    playing = Playing(variation=1.0)
    playing.on(74)
    playing.commands.write(address, 0.2)
    drift = playing.play(0.5, "drift")[0][40:]
    assert (drift[:, which] == 0.0).all()
    assert np.abs(drift[:, CENTS_DRIFT]).max() > 0.0


def tracks(sound: np.ndarray, note: int) -> tuple[np.ndarray, np.ndarray]:
    """Pitch (cents) and level (dB) of a note's fundamental, every HOP frames, from 0.3 s on."""
    f = 440.0 * 2.0 ** ((note - 69.0) / 12.0)
    window = np.hanning(round(0.03 * RATE))
    turned = sound * np.exp(-2j * np.pi * f * np.arange(len(sound)) / RATE)
    steady = np.convolve(turned, window, "same")[round(0.3 * RATE) : -round(0.05 * RATE)]
    phase = np.unwrap(np.angle(steady))
    cents = 1200.0 * np.log2(1.0 + np.gradient(phase) * RATE / (2.0 * np.pi * f))
    return cents[::HOP], 20.0 * np.log10(np.abs(steady[::HOP]))


def strokes(note: int, seed: int) -> list[np.ndarray]:
    """Three separate strokes on one note."""
    playing, found = Playing(seed=seed, variation=0.25), []
    playing.commands.write("/body/sway", 0.0)  # of which a stroke makes much of the level
    for _ in range(3):
        playing.on(note)
        found.append(playing.sound(0.9))
        playing.off(note)
        playing.sound(0.15)
    return found


def test_a_note_played_again_differs_as_two_strokes_do_and_the_seed_gives_both_again():
    note = 74
    first, again = strokes(note, 1), strokes(note, 1)
    assert all(np.array_equal(one, other) for one, other in zip(first, again, strict=True))
    heard = [tracks(stroke, note) for stroke in first]
    assert min(cents.std() for cents, _ in heard) > 0.5
    for track in (0, 1):
        alike = np.corrcoef([each[track] for each in heard])[np.triu_indices(3, 1)]
        assert np.abs(alike).max() < 0.8
