"""Ownership of bow and fingers: the player's, or a direct write's."""

import math

import pytest

from yehu_server.errors import ParameterError
from yehu_server.playing.part_state import Key


def key(note: int) -> Key:
    return Key(0, note)


def test_a_direct_write_takes_one_parameter_over_until_the_next_note(player, listener):
    for address, value, players in [
        ("/bow/speed", 0.11, 0.33),
        ("/bow/side", 0.5, -1.0),
        ("/bow/pressure", 1.1, 0.5),
        ("/bow/assist", 0.3, 0.9),
        ("/bow/position", 0.2, 0.13),
    ]:
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
        assert abs(listener[address]) == pytest.approx(abs(players)), address
        player.notes_off(player.held())


def test_a_direct_write_leaves_the_other_parameters_to_the_player_and_outlives_its_note(
    player, listener
):
    player.write("/bow/speed", -0.3)  # of an instrument that is idle
    assert listener["/bow/speed"] == -0.3
    player.note_on(key(75))
    player.write("/bow/speed", 0.11)
    player.write("/playing/press", 2.2)
    player.write("/playing/bend", 1.0)
    player.write("/playing/pressure", 0.5)
    assert listener.press == 2.2
    assert listener.where() == ("C", 4)
    assert listener["/bow/pressure"] == 0.5
    player.note_off(key(75))
    assert listener["/bow/speed"] == 0.11


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


def test_newtons_written_are_newtons_heard_until_the_next_note_and_held_ones_through_it(
    player, listener
):
    player.note_on(key(75))
    player.write("/bow/force", 0.9)
    assert (listener["/bow/force"], listener["/bow/assist"]) == (0.9, 0.0)
    player.write("/playing/assist", 0.8)  # assist limits the player, never a direct write
    assert listener["/bow/assist"] == 0.0
    player.note_on(key(76))
    assert listener["/bow/assist"] == 0.8
    player.write("/bow/force", 0.9, hold=True)
    player.note_on(key(75))
    assert (listener["/bow/force"], listener["/bow/assist"]) == (0.9, 0.0)


def test_a_held_command_stays_until_release_whatever_controllers_say_and_can_be_set_anew(
    player, listener
):
    player.write("/playing/speed", 0.3, hold=True)
    assert player.write("/playing/speed", 0.1) == 0.3
    player.note_on(key(75))
    assert listener["/bow/speed"] == 0.3
    player.write("/playing/speed", 0.25, hold=True)
    assert listener["/bow/speed"] == 0.25
    player.release()
    player.write("/playing/speed", 0.1)
    assert listener["/bow/speed"] == 0.1


# ---------------------------------------------------------------- refusals


def test_what_is_no_finite_number_or_unknown_is_refused_and_changes_nothing(player, listener):
    for value in (math.nan, math.inf, -math.inf, True, "0.3", None):
        for address in ("/bow/speed", "/playing/speed"):
            with pytest.raises(ParameterError, match=address):
                player.write(address, value)
    for call in (lambda: player.write("/bow/sped", 0.1), lambda: player.value("/bow/sped")):
        with pytest.raises(ParameterError, match="/bow/sped"):
            call()
    assert listener.moves == []
    player.note_on(key(75))
    assert listener["/bow/speed"] == 0.2


def test_a_value_out_of_range_is_clamped_and_returned(player, listener):
    assert player.write("/bow/speed", 99.0) == listener["/bow/speed"] == 2.0
    assert player.write("/playing/speed", 99.0) == player.value("/playing/speed") == 0.6
