"""The effect of MIDI channel messages on the player: notes, pedal, channel modes."""

import mido
import pytest

from yehu_server.playing.part_state import Key


def silent(listener, player) -> bool:
    return player.sounding is None and listener["/bow/speed"] == listener["/bow/side"] == 0.0


# ---------------------------------------------------------------- notes


def test_a_note_on_without_velocity_is_a_note_off(midi, player, listener):
    midi.on(75)
    assert player.sounding == Key(0, 75)
    midi.on(75, velocity=0)
    assert silent(listener, player)
    midi.on(76, velocity=0)
    assert player.notes_played == 1


def test_velocity_sets_the_bow_force_and_not_its_speed_also_of_a_note_that_returns(midi, listener):
    midi.on(75, velocity=127)
    assert listener["/bow/pressure"] == pytest.approx(0.55)
    midi.on(76, velocity=1)
    assert listener["/bow/pressure"] == pytest.approx(0.3 + 0.25 / 127)
    midi.off(76)
    assert listener["/bow/pressure"] == pytest.approx(0.55)
    assert {abs(move.value) for move in listener.of("/bow/speed")} == {0.2}


@pytest.mark.parametrize(("chosen", "playing"), [((), {*range(16)} - {9}), (({2, 9},), {2, 9})])
def test_all_channels_but_the_tenth_play_or_those_chosen(player, mapping, chosen, playing):
    midi = player.mapped(mapping, *chosen)
    for channel in range(16):
        for velocity in (64, 64, 0):
            midi.receive(mido.Message("note_on", note=75, velocity=velocity, channel=channel))
    assert midi.notes_by_channel == dict.fromkeys(playing, 2)
    assert player.notes_played == 2 * len(playing)


def test_a_message_acts_at_its_frame(player, listener, mapping):
    midi = player.mapped(mapping)
    heard = len(listener.moves)
    midi.receive(mido.Message("note_on", note=75), frame=321)
    midi.receive(mido.Message("control_change", control=120), frame=321)
    assert {move.frame for move in listener.moves[heard:]} == {321}
    assert listener.silenced == [321]


# ---------------------------------------------------------------- the pedal


def test_a_key_pressed_again_under_the_pedal_is_held_by_the_hand(midi, player, listener):
    midi.cc(64, 127)
    midi.on(75)
    midi.off(75)
    midi.on(75)
    assert listener["/bow/speed"] == -0.2  # struck again: a new stroke
    midi.cc(64, 0)
    assert player.sounding == Key(0, 75)
    midi.off(75)
    assert player.sounding is None


# ---------------------------------------------------------------- channel modes


@pytest.mark.parametrize("control", [120, 123, 124, 125, 126, 127])
def test_mode_messages_end_every_note(midi, player, listener, control):
    for pedal in (0, 127):
        midi.cc(64, pedal)
        midi.on(75)
        midi.on(77)
        midi.off(77)
        midi.cc(control, 0)
        midi.cc(64, 0)
        assert silent(listener, player)
        assert bool(listener.silenced) == (control == 120)
        midi.off(75)
        midi.on(80)
        assert player.sounding == Key(0, 80)
        midi.off(80)
