"""The shelf that makes notes brighter."""

import numpy as np
import pytest

from yehu_server.core.physics.shelf import SHELF, prepare_shelf, shelf_gain, shelved

FRAMES = 4096


def played(rate: float, settings, sound) -> np.ndarray:
    """What a shelf makes of a sound; `settings` has gain (dB) and frequency (Hz) of each frame."""
    shelf = np.recarray(1, SHELF)
    shelf[:] = np.zeros(1, SHELF)
    prepare_shelf(shelf[0], rate)
    return np.array([shelved(shelf[0], x, *now) for x, now in zip(sound, settings, strict=True)])


@pytest.mark.parametrize(
    ("rate", "gain_db", "hz"), [(44100.0, 12.0, 2000.0), (48000.0, -6.0, 700.0)]
)
def test_it_sounds_as_its_closed_form_says(rate, gain_db, hz):
    impulse = np.eye(1, FRAMES)[0]
    heard = np.fft.rfft(played(rate, [(gain_db, hz)] * FRAMES, impulse))[:-1]
    frequencies = np.fft.rfftfreq(FRAMES, 1.0 / rate)[:-1]
    np.testing.assert_allclose(np.abs(heard), shelf_gain(frequencies, rate, gain_db, hz), atol=1e-9)
    db = 20.0 * np.log10(np.abs(heard))
    assert db[0] == pytest.approx(0.0, abs=1e-6)
    assert db[-1] == pytest.approx(gain_db, abs=0.1)
    assert np.interp(hz, frequencies, db) == pytest.approx(0.5 * gain_db, abs=0.05)


def test_without_gain_it_changes_no_bit():
    noise = np.random.default_rng(1).standard_normal(200)
    assert (played(44100.0, [(0.0, 1300.0)] * 200, noise) == noise).all()


def test_gain_and_frequency_may_jump():
    chance = np.random.default_rng(2)
    jumps = list(
        zip(chance.uniform(-24, 24, FRAMES), chance.uniform(200, 8000, FRAMES), strict=True)
    )
    heard = played(44100.0, jumps, chance.uniform(-1.0, 1.0, FRAMES))
    assert np.abs(heard).max() < 1e3
