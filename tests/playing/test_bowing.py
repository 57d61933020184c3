"""The bowing that each note needs."""

from __future__ import annotations

import itertools

import pytest

from yehu_server.playing.bowing import EDGES, FIRM, LIGHT, MANNERS, ORDINARY, manner
from yehu_server.playing.performer import Key


def test_most_notes_are_bowed_as_asked():
    assert manner(74.0) is ORDINARY
    for wish in (0.1, 0.3, 0.42, 0.55):
        assert ORDINARY.pressure(wish, 66.0) == pytest.approx(wish)


@pytest.mark.parametrize("note", MANNERS)
def test_a_difficult_note_leans_between_its_two_ends(note):
    bowing = manner(float(note))
    light, firm = bowing.lean
    assert bowing.pressure(LIGHT, note) == pytest.approx(light)
    assert bowing.pressure(FIRM, note) == pytest.approx(firm)
    assert light < bowing.pressure(0.5 * (LIGHT + FIRM), note) < firm


@pytest.mark.parametrize("note", [66, 70, 74, 88])
def test_pressure_goes_from_flautando_to_scratch_without_a_step(note):
    bowing = manner(note)
    pressures = [bowing.pressure(0.01 * wish, note) for wish in range(201)]
    assert pressures[0] == 0.0
    assert pressures[100] == pytest.approx(EDGES[note >= 72])
    steps = [after - before for before, after in itertools.pairwise(pressures)]
    assert min(steps) > 0.0
    assert max(steps) < 0.1


def test_between_two_notes_a_pitch_is_bowed_in_between():
    for note in MANNERS:
        low, high = manner(note), manner(note + 1)
        middle = manner(note + 0.5)
        assert middle.farther == pytest.approx(0.5 * (low.farther + high.farther))
        assert middle.lean[0] == pytest.approx(0.5 * (low.lean[0] + high.lean[0]))
        assert manner(note + 0.001).top_speed == pytest.approx(low.top_speed, abs=1e-3)


def test_a_difficult_note_is_bowed_no_faster_than_it_bears(player, listener):
    player.write("/playing/speed", 0.3)
    player.note_on(Key(0, 69))
    assert abs(listener["/bow/speed"]) == MANNERS[69].top_speed
    player.note_on(Key(0, 74))
    assert abs(listener["/bow/speed"]) == 0.3


def test_the_bow_moves_farther_for_a_note_that_wants_it_and_back(player, listener):
    player.write("/playing/bow_position", 0.1)
    player.note_on(Key(0, 66))
    assert listener["/bow/position"] == pytest.approx(0.1 * MANNERS[66].farther)
    player.note_on(Key(0, 74))
    assert listener["/bow/position"] == 0.1


def test_a_bow_position_that_is_held_stays(player, listener):
    player.write("/bow/position", 0.1, hold=True)
    player.note_on(Key(0, 66))
    assert listener["/bow/position"] == 0.1


def test_the_finger_presses_hard_enough_for_its_note(player, listener):
    player.note_on(Key(0, 66))
    assert listener.press == MANNERS[66].press
    player.write("/playing/press", 5.0)
    assert listener.press == 5.0


def test_a_loud_note_is_turned_down_as_far_as_evenness_is_asked(player, listener):
    player.note_on(Key(0, 74))
    assert listener["/output/balance"] == pytest.approx(-6.0 * 0.9)
    player.write("/body/evenness", 0.5)
    assert listener["/output/balance"] == pytest.approx(-3.0)
    player.note_on(Key(0, 67))
    assert listener["/output/balance"] == 0.0
    player.write("/playing/bend", 6.0)
    assert listener["/output/balance"] == pytest.approx(-3.0)


def test_a_note_that_slides_is_bowed_as_its_new_pitch_wants(player, listener):
    player.note_on(Key(0, 67))
    player.write("/playing/bend", 2.0)
    assert abs(listener["/bow/speed"]) == MANNERS[69].top_speed
    player.write("/playing/bend", 0.0)
    assert abs(listener["/bow/speed"]) == 0.2
    player.slide(69.0)
    assert abs(listener["/bow/speed"]) == MANNERS[69].top_speed


def test_a_bow_position_written_during_a_note_stays_until_the_next(player, listener):
    player.note_on(Key(0, 66))
    player.write("/bow/position", 0.1)
    player.write("/playing/pressure", 0.5)
    assert listener["/bow/position"] == 0.1
    player.note_on(Key(0, 66))
    assert listener["/bow/position"] == pytest.approx(0.13 * MANNERS[66].farther)
