"""Ownership of bow and fingers: the player's, or a direct write's."""

from __future__ import annotations

import math

import pytest

from yehu_server.errors import ParameterError
from yehu_server.playing.wishes import Key


def key(note: int) -> Key:
    return Key(0, note)


@pytest.mark.parametrize(
    ("address", "value", "players"),
    [
        ("/bow/speed", 0.11, 0.33),
        ("/bow/side", 0.5, -1.0),
        ("/bow/pressure", 1.1, 0.5),
        ("/bow/assist", 0.3, 0.9),
        ("/bow/position", 0.2, 0.13),
        ("/finger/1/press", 4.0, 0.0),  # the next note has the next finger
    ],
)
def test_a_direct_write_takes_one_parameter_over_until_the_next_note(
    player, listener, address, value, players
):
    player.note_on(key(75))
    assert player.write(address, value) == value
    player.write("/playing/speed", 0.33)
    player.write("/playing/pressure", 0.5)
    player.write("/playing/assist", 0.9)
    player.write("/playing/press", 2.2)
    player.write("/playing/bend", -4.0)  # moves the finger, and the bow to the F string
    player.write("/playing/bend", 0.0)
    assert listener[address] == value
    player.note_on(key(77))
    assert listener[address] == pytest.approx(players)


def test_a_direct_write_leaves_the_other_parameters_to_the_player(player, listener):
    player.note_on(key(75))
    player.write("/bow/speed", 0.11)
    player.write("/playing/press", 2.2)
    player.write("/playing/bend", 1.0)
    player.write("/playing/pressure", 0.5)
    assert listener.press == 2.2
    assert listener.where() == ("C", 4)
    assert listener["/bow/pressure"] == 0.5
    assert listener["/bow/speed"] == 0.11


def test_a_direct_write_outlives_the_end_of_the_note(player, listener):
    player.note_on(key(75))
    player.write("/bow/speed", 0.11)
    player.note_off(key(75))
    assert listener["/bow/speed"] == 0.11


def test_a_direct_write_on_an_idle_instrument_just_moves_it(player, listener):
    player.write("/bow/speed", -0.3)
    assert listener["/bow/speed"] == -0.3


def test_release_gives_the_bow_back_to_the_player(player, listener):
    player.note_on(key(75))
    player.write("/bow/speed", 0.11)
    player.release()
    player.write("/playing/speed", 0.33)
    assert listener["/bow/speed"] == 0.33


def test_a_held_write_stays_through_notes_until_release(player, listener):
    player.write("/bow/speed", 0.11, hold=True)
    for note in (66, 80):
        player.note_on(key(note))
        assert listener["/bow/speed"] == 0.11
        player.note_off(key(note))
        assert listener["/bow/speed"] == 0.11
    player.release()
    player.note_on(key(66))
    assert abs(listener["/bow/speed"]) == 0.2


def test_newtons_written_are_newtons_heard_until_the_next_note(player, listener):
    player.note_on(key(75))
    player.write("/bow/force", 0.9)
    assert (listener["/bow/force"], listener["/bow/assist"]) == (0.9, 0.0)
    player.write("/playing/assist", 0.8)  # assist limits the player, never a direct write
    assert listener["/bow/assist"] == 0.0
    player.note_on(key(76))
    assert listener["/bow/assist"] == 0.8


def test_newtons_held_are_heard_through_notes(player, listener):
    player.write("/bow/force", 0.9, hold=True)
    player.note_on(key(75))
    assert (listener["/bow/force"], listener["/bow/assist"]) == (0.9, 0.0)


def test_the_next_note_takes_the_level_back_too(player, listener):
    player.write("/playing/volume", 0.5)
    player.note_on(key(75))
    player.write("/output/level", 1.0)
    player.write("/playing/volume", 0.25)
    assert listener["/output/level"] == 1.0
    player.note_on(key(76))
    assert listener["/output/level"] == pytest.approx(0.0625)


def test_what_the_player_never_moves_stays_as_written(player, listener):
    player.write("/output/gain", 0.3)
    player.note_on(key(75))
    assert [move.value for move in listener.of("/output/gain")] == [0.3]


def test_a_held_wish_stays_whatever_controllers_say_until_release(player, listener):
    player.write("/playing/speed", 0.3, hold=True)
    assert player.write("/playing/speed", 0.1) == 0.3
    player.note_on(key(75))
    assert listener["/bow/speed"] == 0.3
    player.release()
    player.write("/playing/speed", 0.1)
    assert listener["/bow/speed"] == 0.1


def test_a_held_wish_can_be_set_anew(player, listener):
    player.write("/playing/pressure", 0.3, hold=True)
    player.write("/playing/pressure", 0.5, hold=True)
    player.note_on(key(75))
    assert listener["/bow/pressure"] == 0.5


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, True, "0.3", None])
@pytest.mark.parametrize("address", ["/bow/speed", "/playing/speed"])
def test_what_is_no_finite_number_is_refused_and_changes_nothing(player, listener, address, value):
    with pytest.raises(ParameterError, match=address):
        player.write(address, value)
    assert listener.moves == []
    player.note_on(key(75))
    assert listener["/bow/speed"] == 0.2


def test_a_value_out_of_range_is_clamped_and_returned(player, listener):
    assert player.write("/bow/speed", 99.0) == 2.0
    assert listener["/bow/speed"] == 2.0
    assert player.write("/playing/speed", 99.0) == 0.6
    assert player.value("/playing/speed") == 0.6


def test_an_unknown_parameter_is_refused_by_name(player):
    with pytest.raises(ParameterError, match="/bow/sped"):
        player.write("/bow/sped", 0.1)
    with pytest.raises(ParameterError, match="/bow/sped"):
        player.value("/bow/sped")


def test_what_bow_and_fingers_are_told_is_where_a_write_or_a_note_moved_them_last(player):
    assert player.value("/bow/speed") == 0.0
    player.note_on(key(75))
    assert player.value("/bow/speed") == 0.2
    player.write("/bow/speed", 0.11)
    assert player.value("/bow/speed") == 0.11
    player.note_on(key(77))
    assert player.value("/bow/speed") == 0.2
    player.note_off(key(77))
    player.note_off(key(75))
    assert player.value("/bow/speed") == 0.0
