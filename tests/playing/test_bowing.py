"""The bowing that each note needs."""

import itertools
import math

import numpy as np
import pytest
from hands import HIGH_DB, LOW_DB, Watched, ideal

from yehu_server.core.player.bowing import (
    AT_FIRM,
    AT_FLAUTANDO,
    AT_LIGHT,
    BOW_POSITIONS,
    BOWING_SIZE,
    DEFAULT_BOWING,
    DISTANCE_FACTOR,
    FIRM,
    FIRST_NOTE,
    FLAUTANDO,
    LIGHT,
    MIN_PRESS,
    TOP_SPEED,
    bow_pressure_for,
    bowing_value,
    default_bowing_table,
)
from yehu_server.playing.bowing_tables import shipped_bowing_table
from yehu_server.playing.part_state import Key

SHIPPED = shipped_bowing_table(44100.0)
STOPS = [*((0, note) for note in range(65, 78)), *((1, note) for note in range(72, 90))]
PLACE = 0.13


def usual(string: int, note: int) -> list[float]:
    """How a note is bowed by the table that ships."""
    return list(SHIPPED[string, BOW_POSITIONS.index(PLACE), note - FIRST_NOTE])


def bowed(string: int, pitch: float, place: float = PLACE) -> list[float]:
    """How a pitch is bowed."""
    return [bowing_value(SHIPPED, string, place, pitch, column) for column in range(BOWING_SIZE)]


def pressure(string: int, command: float, pitch: float) -> float:
    """The bow's pressure at a pitch, for a command."""
    m = bowed(string, pitch)
    return bow_pressure_for(m[AT_FLAUTANDO], m[AT_LIGHT], m[AT_FIRM], command, string)


def test_ordinarily_notes_are_bowed_as_asked_and_on_the_f_string_not_near_the_bridge():
    table = default_bowing_table()
    assert np.all(table[1] == DEFAULT_BOWING)
    assert np.all(
        np.delete(table[0], DISTANCE_FACTOR, axis=-1) == np.delete(DEFAULT_BOWING, DISTANCE_FACTOR)
    )
    positions = table[0, ..., DISTANCE_FACTOR] * np.array(BOW_POSITIONS)[:, None]
    assert positions.min() == pytest.approx(0.17)
    assert np.all(table[0, BOW_POSITIONS.index(0.25), :, DISTANCE_FACTOR] == 1.0)
    for command in (0.1, 0.2, 0.25, 0.3, 0.42, 0.55):
        assert bow_pressure_for(
            *DEFAULT_BOWING[AT_FLAUTANDO : AT_FIRM + 1], command, 0
        ) == pytest.approx(command)


def test_a_note_is_bowed_as_its_table_says_and_leans_between_its_ends(subtests):
    for string, note in STOPS:
        with subtests.test(string=string, note=note):
            assert bowed(string, float(note)) == usual(string, note)
            flautando, light, firm = usual(string, note)[AT_FLAUTANDO : AT_FIRM + 1]
            commands = (0.5 * FLAUTANDO, FLAUTANDO, LIGHT, 0.5 * (LIGHT + FIRM), FIRM)
            assert [
                pressure(string, command, float(note)) for command in commands
            ] == pytest.approx([0.5 * flautando, flautando, light, 0.5 * (light + firm), firm])
    assert bowed(0, 30.0) == bowed(0, 64.0) == usual(0, 65)  # beyond the table as the last
    assert bowed(1, 120.0) == bowed(1, 91.0)


def test_pressure_goes_from_flautando_to_scratch_without_a_step():
    shares = DEFAULT_BOWING[AT_FLAUTANDO : AT_FIRM + 1]
    for string, edge in ((0, 1.3), (1, 4.0)):
        pressures = [bow_pressure_for(*shares, 0.01 * command, string) for command in range(201)]
        assert (pressures[0], pressures[100]) == (0.0, pytest.approx(edge))
        assert 0.0 < np.diff(pressures).min() < np.diff(pressures).max() < 0.1


def test_between_two_places_a_note_is_bowed_in_between_and_beyond_them_as_at_the_last():
    table = default_bowing_table()
    table[0, :, :, DISTANCE_FACTOR] = np.arange(len(BOW_POSITIONS))[:, None]

    def farther(place: float) -> float:
        return float(bowing_value(table, 0, place, 70.5, DISTANCE_FACTOR))

    for row, (near, far) in enumerate(itertools.pairwise(BOW_POSITIONS)):
        assert farther(near) == pytest.approx(row, abs=1e-9)
        assert farther(math.sqrt(near * far)) == pytest.approx(row + 0.5)
    assert farther(BOW_POSITIONS[-1]) == pytest.approx(len(BOW_POSITIONS) - 1)
    assert farther(0.01) == 0.0
    assert farther(1.0) == len(BOW_POSITIONS) - 1


SLOWEST, FARTHEST, HARDEST = 0.1, 1.7, 3.0


@pytest.fixture
def listener() -> Watched:
    """A player for whom A4 bears no fast bow; F sharp 4 wants one far away, and a firm finger."""
    bowing = default_bowing_table()
    bowing[0, :, 69 - FIRST_NOTE, TOP_SPEED] = SLOWEST
    bowing[0, :, 66 - FIRST_NOTE, DISTANCE_FACTOR] = FARTHEST
    bowing[0, :, 66 - FIRST_NOTE, MIN_PRESS] = HARDEST
    return Watched(calibration=ideal(), bowing=bowing)


def test_the_bow_moves_farther_for_a_note_that_wants_it_and_back_unless_it_is_held(
    player, listener
):
    player.write("/playing/bow_position", 0.1)
    player.note_on(Key(0, 66))
    assert listener["/bow/position"] == pytest.approx(0.1 * FARTHEST)
    player.note_on(Key(0, 74))
    assert listener["/bow/position"] == 0.1
    player.write("/bow/position", 0.12, hold=True)
    player.note_on(Key(0, 66))
    assert listener["/bow/position"] == 0.12


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
    assert abs(listener["/bow/speed"]) == SLOWEST
    player.write("/playing/bend", 0.0)
    assert abs(listener["/bow/speed"]) == 0.2
    player.slide(69.0)
    assert abs(listener["/bow/speed"]) == SLOWEST
