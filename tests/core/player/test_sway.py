"""A player sways while notes sound, and turns the body with it."""

import numpy as np
import pytest
from held_notes import Playing

from yehu_server.core.player.sway import FARTHEST


def swayed(seconds: float = 2.0, notes: tuple[float, ...] = (74,), *, seed: int = 0, **values):
    """How far the body is turned in both directions, every 5 ms; notes follow each other."""
    sway = values.pop("sway", 0.5)
    playing = Playing(seed=seed, phrasing=0.5, listening=0.0, **values)
    playing.commands.write("/body/sway", sway)
    found = []
    for note in notes:
        playing.on(note)
        found.append(playing.play(seconds / len(notes), "turned")[0])
        playing.off(note)
    return np.concatenate(found), playing


@pytest.mark.parametrize("values", [{"sway": 0.0}, {"variation": 0.0}])
def test_who_is_to_be_still_is(values):
    assert (swayed(1.0, **values)[0] == 0.0).all()


def test_both_angles_move_smoothly_within_a_note_and_go_their_own_ways():
    moves = np.array([swayed(seed=seed)[0] for seed in range(6)])
    inner = moves[:, 80:320]
    assert (inner.std(axis=1) > 0.03).mean() > 0.8
    assert np.abs(moves).max() < FARTHEST
    assert np.abs(np.diff(moves[:, 2:], axis=1)).max() < 0.04  # in 5 ms
    alike = [np.corrcoef(each[:, 0], each[:, 1])[0, 1] for each in inner]
    assert np.ptp(alike) > 0.5


def test_a_down_bow_swings_to_one_side_and_an_up_bow_back():
    notes = (74, 76, 74, 76)
    swings = np.array([swayed(3.2, notes, seed=seed)[0] for seed in range(8)])
    down, up, again, last = np.split(swings.mean(axis=0), len(notes))
    for stroke, sign in ((down, 1.0), (up, -1.0), (again, 1.0), (last, -1.0)):
        assert sign * (stroke[-1, 0] - stroke[20, 0]) > 0.2
        assert sign * (stroke[-1, 1] - stroke[20, 1]) < -0.1


def test_a_seed_says_which_way_and_in_silence_the_player_stays():
    one, playing = swayed(0.5, seed=1)
    assert (one == swayed(0.5, seed=1)[0]).all()
    assert np.abs(one - swayed(0.5, seed=2)[0]).max() > 0.05
    (rest,) = playing.play(0.3, "turned")
    assert (np.diff(rest[2:], axis=0) == 0.0).all()
