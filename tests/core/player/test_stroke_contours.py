"""A stroke has curves of the bow's speed, force and place, as far as phrasing says."""

import numpy as np
import pytest
from held_notes import Playing

from yehu_server.core.controls.record import FORCE_DRIFT, POSITION_DRIFT, SPEED_DRIFT
from yehu_server.core.controls.slots import SLOTS

BOW = [SPEED_DRIFT, FORCE_DRIFT, POSITION_DRIFT]
STILL = {"variation": 0.0, "listening": 0.0, "bow_length": 0.0}


def stroke(seconds: float = 2.0, *, note: float = 74, then: float = 0.0, **values: float):
    """Factors less 1 on the bow's speed, force and place, and on the level, every 5 ms."""
    seed = int(values.pop("seed", 0))
    playing = Playing(seed=seed, **STILL | {"phrasing": 0.5} | values)
    playing.on(note)
    found = [playing.play(seconds, "drift", "swell")]
    if then > 0.0:
        playing.off(note)
        found.append(playing.play(then, "drift", "swell"))
    drifts, swells = (np.concatenate(part) for part in zip(*found, strict=True))
    return drifts[:, BOW], swells


def test_without_phrasing_nothing_moves():
    drift, swell = stroke(phrasing=0.0)
    assert (drift == 0.0).all()
    assert (swell == 0.0).all()


@pytest.mark.parametrize("length", [0.0, 2.0])
def test_each_of_speed_force_place_and_level_moves_by_itself(length):
    moves = np.array([stroke(note_length=length, seed=seed)[0] for seed in range(6)])
    inner = moves[:, 80:320]
    assert (inner.std(axis=1) > (0.02, 0.05, 0.03)).mean() > 0.8
    for one, other in ((0, 1), (0, 2), (1, 2)):  # they are no copies of each other
        alike = [np.corrcoef(each[:, one], each[:, other])[0, 1] for each in inner]
        assert np.abs(alike).mean() < 0.85


def test_a_stroke_opens_to_its_peak_and_eases_off():
    speeds = np.mean([stroke(2.0, note_length=2.0, seed=s)[0][:, 0] for s in range(12)], axis=0)
    first, middle, last = speeds[2], speeds[120:220].max(), speeds[-1]
    assert first < middle - 0.12
    assert last < middle - 0.15


def test_nothing_jumps_while_the_bow_is_on_the_string():
    for length in (0.0, 1.0):
        for seed in range(4):
            drift, swell = stroke(1.0, then=0.045, note_length=length, seed=seed)
            assert np.abs(np.diff(drift[2:], axis=0)).max() < 0.07  # in 5 ms
            assert np.abs(np.diff(swell[2:])).max() < 0.05


def test_a_slur_goes_on_with_the_curves_of_its_bow():
    playing = Playing(phrasing=0.5, **STILL)
    playing.on(74)
    before = playing.play(0.6, "drift")[0][:, BOW]
    playing.on(76)
    playing.off(74)
    after = playing.play(0.3, "drift")[0][:, BOW]
    joined = np.concatenate((before[-8:], after[:8]))
    assert np.abs(np.diff(joined, axis=0)).max() < 0.03
    assert np.abs(np.diff(joined, n=2, axis=0)).max() < 0.01  # nor has it a corner


def test_a_release_bends_the_curve_from_where_it_is():
    speeds = [stroke(0.5, then=0.05, seed=seed)[0][:, 0] for seed in range(8)]
    held = np.mean([each[99] for each in speeds])
    assert np.mean([each[-1] for each in speeds]) < held - 0.03
    assert all(abs(each[101] - each[99]) < 0.06 for each in speeds)


def test_it_is_the_seeds_in_any_block_and_the_same_live_and_in_a_file():
    def heard(seed: int, block: int, **values: float) -> bytes:
        playing = Playing(seed=seed, **STILL | {"phrasing": 0.5} | values)
        playing.on(74)
        return playing.sound(0.7, block).tobytes()

    assert heard(5, 64) == heard(5, 1000)
    assert heard(5, 64) == heard(6, 64)  # without variation there is no chance
    assert heard(5, 64, variation=1.0, vibrato=20.0) == heard(5, 1000, variation=1.0, vibrato=20.0)
    assert heard(5, 64, variation=0.1) != heard(6, 64, variation=0.1)
    assert heard(5, 64, note_length=0.7) == heard(5, 511, note_length=0.7)


def test_the_curves_stay_within_what_the_note_bears():
    playing = Playing(phrasing=1.0, seed=3, **STILL)
    playing.on(69)  # a note that is bowed with care
    values, drift = playing.play(4.0, "value", "drift")
    _, _, _, firm, _, _ = playing.player["bowing"]
    flautando = playing.player["bowing"][1]
    share = values[40:, SLOTS.bow_pressure] * (1.0 + drift[40:, FORCE_DRIFT])
    usual = values[40:, SLOTS.bow_pressure]
    assert (share >= np.minimum(flautando, usual) - 0.02).all()
    assert (share <= np.maximum(firm, usual) + 0.02).all()


def test_plucked_notes_and_strokes_of_their_own_have_none():
    for values in ({"pizzicato": 1.0}, {"tremolo": 8.0}):
        assert (stroke(0.5, **values)[0] == 0.0).all()


@pytest.mark.parametrize("phrasing", [0.0, 0.5])
def test_louder_is_heavier_and_nearer_to_the_bridge_within_the_note(phrasing):
    playing = Playing(phrasing=phrasing, dynamics=0.5, **STILL)
    playing.on(76)
    soft = playing.play(0.6, "value")[0][-1]
    playing.commands.write("/playing/dynamics", 1.0)
    loud = playing.play(0.3, "value")[0][-1]
    if phrasing > 0.0:
        assert loud[SLOTS.bow_pressure] > 1.1 * soft[SLOTS.bow_pressure]
        assert loud[SLOTS.bow_position] < 0.93 * soft[SLOTS.bow_position]
    else:
        assert loud[SLOTS.bow_pressure] == soft[SLOTS.bow_pressure]
        assert loud[SLOTS.bow_position] == soft[SLOTS.bow_position]


def test_most_notes_begin_on_their_pitch_and_some_a_little_below():
    def bend(seed: int, left_hand: float = 1.0) -> float:
        playing = Playing(
            seed=seed, phrasing=0.5, left_hand=left_hand, note_length=1.0, variation=0.001
        )
        playing.on(76)
        playing.play(0.01)
        return float(playing.player["gesture"]["bend"])

    bends = np.array([bend(seed) for seed in range(30)])
    assert 0.1 < np.mean(bends < 0.0) < 0.6
    assert bends.min() > -0.21
    assert (np.array([bend(seed, 0.0) for seed in range(5)]) == 0.0).all()
