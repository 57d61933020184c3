"""What a body radiates into other directions than the measured one."""

import numpy as np
import pytest

from yehu_server.core.physics.lobes import FROM_HZ, LOBES, clear_lobes, prepare_lobes, radiate_aside

RINGS_S = 0.15


def made(rate: float):
    lobes = np.recarray(1, LOBES)
    lobes[:] = np.zeros(1, LOBES)
    prepare_lobes(lobes, rate)
    return lobes[0]


def responses(rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (Hz), and complex responses of both directions [shape=(2, frequencies)]."""
    lobes, impulse = made(rate), np.eye(1, round(RINGS_S * rate))[0]
    heard = np.array([radiate_aside(lobes, x) for x in impulse]).T
    return np.fft.rfftfreq(len(impulse), 1.0 / rate), np.fft.rfft(heard)


@pytest.mark.parametrize("rate", [22050.0, 44100.0, 192000.0])
def test_other_directions_have_as_much_of_high_sound_and_less_of_low(rate):
    hz, heard = responses(rate)
    inside = slice(1, -1)
    bent = np.tan(np.pi * FROM_HZ / rate) / np.tan(np.pi * hz[inside] / rate)
    wanted = np.broadcast_to(1.0 / (1.0 + bent * bent), (2, len(bent)))
    np.testing.assert_allclose(np.abs(heard[:, inside]), wanted, atol=1e-6)


def test_their_phases_go_round_within_a_few_hundred_hertz_each_its_own_way():
    hz, heard = responses(44100.0)
    high = (hz > 1500.0) & (hz < 6000.0)
    turns = -np.unwrap(np.angle(heard[:, high])) / (2.0 * np.pi)
    first, second = np.ptp(turns, axis=1)
    assert 200.0 < 4500.0 / first < 300.0
    assert 80.0 < 4500.0 / second < 120.0


def test_a_cleared_body_is_silent():
    lobes = made(44100.0)
    for x in np.random.default_rng(3).standard_normal(2000):
        radiate_aside(lobes, x)
    clear_lobes(lobes)
    assert all(radiate_aside(lobes, 0.0) == (0.0, 0.0) for _ in range(400))
