"""The bowing that each note needs."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hands import HIGH_DB, LOW_DB

from yehu_server.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    EDGE_ON_C,
    EDGE_ON_F,
    FARTHER,
    FIRM,
    FLAUTANDO,
    LEAST_PRESS,
    LIGHT,
    MANNER,
    ORDINARY,
    PLACES,
    TOP_SPEED,
    manner,
    share,
)
from yehu_server.player.practice import MANNERS, bowing_table
from yehu_server.playing.wishes import Key

NOTES = bowing_table()
DIFFICULT = sorted(MANNERS)
PLACE = 0.13


def usual(note: int) -> list[float]:
    """How a note is bowed by the table that ships; below F4 as that, which it sounds as."""
    if max(note, 65) not in MANNERS:
        return list(ORDINARY)
    top_speed, light, firm, farther, press = MANNERS[max(note, 65)]
    # Up to LIGHT the pressure is proportional to the wish.
    return [top_speed, light * FLAUTANDO / LIGHT, light, firm, farther, press]


def bowed(pitch: float, place: float = PLACE) -> list[float]:
    """How a pitch is bowed."""
    return [manner(NOTES, place, pitch, column) for column in range(MANNER)]


def pressure(wish: float, pitch: float) -> float:
    """The bow's pressure at a pitch, for a wish."""
    m = bowed(pitch)
    return share(m[AT_FLAUTANDO], m[AT_LIGHT], m[AT_FIRM], wish, pitch)


def test_most_notes_are_bowed_as_asked():
    assert bowed(74.0) == list(ORDINARY)
    for wish in (0.1, 0.2, 0.25, 0.3, 0.42, 0.55):
        assert share(*ORDINARY[AT_FLAUTANDO : AT_FIRM + 1], wish, 66.0) == pytest.approx(wish)
        assert pressure(wish, 74.0) == pytest.approx(wish)


@pytest.mark.parametrize("note", range(60, 95))
@pytest.mark.parametrize("place", [0.05, 0.1, PLACE, 0.15, 0.3])
def test_a_note_is_bowed_as_its_table_says(note, place):
    assert bowed(float(note), place) == usual(note)


@pytest.mark.parametrize("note", DIFFICULT)
def test_a_difficult_note_leans_between_its_ends(note):
    flautando, light, firm = usual(note)[AT_FLAUTANDO : AT_FIRM + 1]
    assert pressure(FLAUTANDO, float(note)) == pytest.approx(flautando)
    assert pressure(LIGHT, float(note)) == pytest.approx(light)
    assert pressure(FIRM, float(note)) == pytest.approx(firm)
    assert flautando < pressure(0.5 * (FLAUTANDO + LIGHT), float(note)) < light
    assert light < pressure(0.5 * (LIGHT + FIRM), float(note)) < firm


def test_each_of_the_three_shares_counts():
    assert share(0.1, 0.5, 0.6, 0.5 * FLAUTANDO, 70.0) == pytest.approx(0.05)
    assert share(0.1, 0.5, 0.6, 0.5 * (FLAUTANDO + LIGHT), 70.0) == pytest.approx(0.3)
    assert share(0.1, 0.5, 0.6, 0.5 * (LIGHT + FIRM), 70.0) == pytest.approx(0.55)


@pytest.mark.parametrize("note", [66, 70, 74, 88])
def test_pressure_goes_from_flautando_to_scratch_without_a_step(note):
    pressures = [pressure(0.01 * wish, float(note)) for wish in range(201)]
    assert pressures[0] == 0.0
    assert pressures[100] == pytest.approx(EDGE_ON_C if note >= 72 else EDGE_ON_F)
    steps = [after - before for before, after in itertools.pairwise(pressures)]
    assert min(steps) > 0.0
    assert max(steps) < 0.1


def test_between_two_notes_a_pitch_is_bowed_in_between():
    for note in DIFFICULT:
        low, high = usual(note), usual(note + 1)
        middle = [0.5 * (one + other) for one, other in zip(low, high, strict=True)]
        assert bowed(note + 0.5) == pytest.approx(middle)
        assert bowed(note + 0.001)[TOP_SPEED] == pytest.approx(low[TOP_SPEED], abs=1e-3)


def test_between_two_places_a_note_is_bowed_in_between_and_beyond_them_as_at_the_last():
    table = NOTES.copy()
    table[:, :, FARTHER] = np.arange(len(PLACES))[:, None]

    def farther(place: float) -> float:
        return float(manner(table, place, 70.5, FARTHER))

    for row, (near, far) in enumerate(itertools.pairwise(PLACES)):
        assert farther(near) == pytest.approx(row, abs=1e-9)
        assert farther(math.sqrt(near * far)) == pytest.approx(row + 0.5)
    assert farther(PLACES[-1]) == pytest.approx(len(PLACES) - 1)
    assert farther(0.01) == 0.0
    assert farther(1.0) == len(PLACES) - 1


def test_a_difficult_note_is_bowed_no_faster_than_it_bears(player, listener):
    player.write("/playing/speed", 0.3)
    player.note_on(Key(0, 69))
    assert abs(listener["/bow/speed"]) == usual(69)[TOP_SPEED]
    player.note_on(Key(0, 74))
    assert abs(listener["/bow/speed"]) == 0.3


def test_the_bow_moves_farther_for_a_note_that_wants_it_and_back(player, listener):
    player.write("/playing/bow_position", 0.1)
    player.note_on(Key(0, 66))
    assert listener["/bow/position"] == pytest.approx(0.1 * usual(66)[FARTHER])
    player.note_on(Key(0, 74))
    assert listener["/bow/position"] == 0.1


def test_a_bow_position_that_is_held_stays(player, listener):
    player.write("/bow/position", 0.1, hold=True)
    player.note_on(Key(0, 66))
    assert listener["/bow/position"] == 0.1


def test_the_finger_presses_hard_enough_for_its_note(player, listener):
    player.note_on(Key(0, 66))
    assert listener.press == usual(66)[LEAST_PRESS]
    player.write("/playing/press", 5.0)
    assert listener.press == 5.0


def test_a_loud_note_is_turned_down_as_far_as_evenness_is_asked(player, listener):
    player.note_on(Key(0, 74))
    assert listener["/output/balance"] == pytest.approx(HIGH_DB * 0.9)
    player.write("/body/evenness", 0.5)
    assert listener["/output/balance"] == pytest.approx(HIGH_DB * 0.5)
    player.note_on(Key(0, 67))
    assert listener["/output/balance"] == pytest.approx(LOW_DB * 0.5)
    player.write("/playing/bend", 6.0)
    assert listener["/output/balance"] == pytest.approx(HIGH_DB * 0.5)


def test_a_note_that_slides_is_bowed_as_its_new_pitch_wants(player, listener):
    player.note_on(Key(0, 67))
    player.write("/playing/bend", 2.0)
    assert abs(listener["/bow/speed"]) == usual(69)[TOP_SPEED]
    player.write("/playing/bend", 0.0)
    assert abs(listener["/bow/speed"]) == 0.2
    player.slide(69.0)
    assert abs(listener["/bow/speed"]) == usual(69)[TOP_SPEED]


def test_a_bow_position_written_during_a_note_stays_until_the_next(player, listener):
    player.note_on(Key(0, 66))
    player.write("/bow/position", 0.1)
    player.write("/playing/pressure", 0.5)
    assert listener["/bow/position"] == 0.1
    player.note_on(Key(0, 66))
    assert listener["/bow/position"] == pytest.approx(0.13 * usual(66)[FARTHER])
