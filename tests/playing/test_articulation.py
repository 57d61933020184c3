"""The player's hands in dynamics, vibrato, tremolo, pizzicato, portamento."""

import pytest
from hands import Checked

from yehu_server.params.articulations import NUMBER
from yehu_server.playing.part_state import Key
from yehu_server.playing.tuning import KEYS, Tuning


def key(note: float) -> Key:
    return Key(0, note)


# ---------------------------------------------------------------- dynamics


def test_without_dynamics_the_bow_leaves_the_string_and_comes_back_with_them(player, listener):
    player.write("/playing/attack", 33.0)
    player.write("/playing/release", 77.0)
    player.note_on(key(75))
    player.write("/playing/dynamics", 0.0)
    assert (listener["/bow/speed"], listener["/bow/side"]) == (0.0, 0.0)
    assert listener.of("/bow/speed")[-1].ramp_ms == 77.0
    player.write("/playing/dynamics", 0.4)
    assert listener["/bow/side"] == -1.0
    assert listener["/bow/speed"] > 0.0
    assert listener.of("/bow/speed")[-1].ramp_ms == 33.0


def test_a_note_without_dynamics_is_fingered_and_waits_for_the_breath(player, listener):
    player.write("/playing/dynamics", 0.0)
    player.note_on(key(75))
    assert listener.press == 1.5
    assert not listener.of("/bow/side")
    player.note_on(key(70))
    assert not listener.of("/bow/side")
    player.write("/playing/dynamics", 0.5)
    assert listener.where() == ("F", 5)


# ---------------------------------------------------------------- pizzicato


def test_a_plucked_note_is_not_bowed(player, listener):
    player.write("/playing/pizzicato", 1.0)
    player.note_on(key(75))
    assert listener.press == 1.5
    assert listener["/pluck/force"] < 0.0  # the outer string
    assert not any(move.value for move in listener.of("/bow/side"))
    player.note_on(key(68))
    assert listener["/pluck/force"] > 0.0
    for note in (75, 68):
        player.note_off(key(note))
    assert len(listener.of("/pluck/force")) == 2
    for pizzicato, side in ((0.0, -1.0), (1.0, 0.0), (0.0, -1.0)):
        player.write("/playing/pizzicato", pizzicato)
        player.note_on(key(77))
        assert listener["/bow/side"] == side


def test_a_finger_of_the_left_hand_plucks_farther_from_the_bridge_and_softer(player, listener):
    place, force = "/pluck/position", "/pluck/force"
    plucked = []
    for name in ("pizzicato", "left-hand-pizzicato", "pizzicato"):
        player.write("/playing/articulation", float(NUMBER[name]))
        player.note_on(key(75))
        plucked.append((listener.target(place), listener[force]))
        player.note_off(key(75))
    right, left, again = plucked
    assert again == right
    assert left[0] == pytest.approx(2.0 ** (-5.0 / 12.0), abs=0.01)  # a fourth above the stop
    assert 0.5 * abs(right[1]) < abs(left[1]) < abs(right[1])


def test_more_pressure_plucks_harder_and_as_hard_again_where_it_is_sent(player, listener):
    player.write("/playing/pizzicato", 1.0)
    player.write("/pluck/position", 0.5)
    for pressure in (0.3, 0.6, 0.6):
        player.write("/playing/pressure", pressure)
        player.note_on(key(68))
        assert listener.target("/pluck/position") == 0.5
        player.note_off(key(68))
    soft, hard, again = (move.value for move in listener.of("/pluck/force"))
    assert hard == again == pytest.approx(2.0 * soft)


# ---------------------------------------------------------------- tunings


def hands(listener, tune) -> Checked:
    """A player whose keys have other pitches."""
    player = Checked(listener, tuning=Tuning("test", tuple(map(tune, KEYS))))
    player.write("/playing/variation", 0.0)
    return player


def test_a_tuning_a_little_below_the_open_string_is_that_and_one_far_below_moved_by_octaves(
    listener,
):
    for below, where, outside in (
        (1e-4, ("F", None), 0),
        (0.4, ("F", None), 0),
        (0.5, ("C", 4.5), 1),
    ):
        player = hands(listener, lambda note, by=below: note - by)
        before = player.notes_out_of_range
        player.note_on(key(65))
        assert listener.where() == where
        assert player.notes_out_of_range - before == outside
        player.note_off(key(65))
