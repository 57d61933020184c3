"""A string that slips twice in each period sounds an octave up: the hand brings it back."""

import numpy as np
import pytest

import yehu_server as yehu
from yehu_server.playing.pitch_and_level import pitch_hz

RATE = 44100
A5_HZ, E5_HZ = 880.0, 659.255


def alone(key: int, seed: int) -> np.ndarray:
    """A note far from the bridge, where some begin an octave up, from 0.3 s on."""
    sound = yehu.render(
        [(key, 0.0, 0.8, 80)],
        preset="sul-tasto",
        phrasing=0.0,
        rubato=0.0,
        seed=seed,
        dry=True,
        mono=True,
    ).sound
    return sound[round(0.3 * RATE) : round(0.75 * RATE)]


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize(("key", "hz"), [(81, A5_HZ), (76, E5_HZ)])
def test_no_note_far_from_the_bridge_stays_an_octave_up(key, hz, seed):
    found = pitch_hz(alone(key, seed), RATE, lo=0.4 * hz, hi=3.2 * hz)
    assert found == pytest.approx(hz, rel=0.01)
