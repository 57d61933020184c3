"""The effect of MIDI controllers on the player: bend, pressure, wheels, and their reset."""

import pytest

PRESS, HARDEST = 1.5, 5.0  # N, by the mapping of conftest.py


# ---------------------------------------------------------------- pitch bend


def test_the_wheel_bends_by_its_range_in_fourteen_bits_also_between_notes(midi, player, listener):
    midi.on(77)
    for pitch, semitones in ((8191, 2), (-8192, -2), (0, 0)):
        midi.bend(pitch)
        assert listener.where() == ("C", 5 + semitones)
    midi.bend(1)
    assert player.value("/playing/bend") == pytest.approx(2 / 8191)
    midi.bend(4096)
    assert player.value("/playing/bend") == pytest.approx(1.0, abs=2e-4)
    midi.off(77)
    midi.bend(8191)
    midi.on(77)
    assert listener.where() == ("C", 7)


def test_a_port_that_plays_several_channels_but_its_first_seems_to_be_mpe(midi, player):
    for channel in (2, 3):
        midi.on(70, channel=channel)
    midi.on(70, channel=4, port=1)
    assert not player.seems_mpe
    midi.on(70, channel=4)
    assert player.seems_mpe
    midi.on(70)
    assert not player.seems_mpe
    midi.rpn(0, 6, (6, 15), port=2)
    for channel in (2, 3, 4):
        midi.on(70, channel=channel, port=2)
    assert not player.seems_mpe


def test_rpn_0_sets_the_bend_range(midi, player):
    midi.on(77)
    midi.bend(8191)
    for data, semitones in [
        ([(6, 12)], 12),
        ([(6, 0)], 0),
        ([(38, 50)], 2.5),
        ([(6, 3), (38, 25)], 3.25),
        ([(38, 25), (6, 3)], 3.25),
        ([(38, 127)], 2.99),
        ([(96, 0)], 3),
        ([(96, 0), (96, 0)], 4),
        ([(97, 0)], 1),
        ([(97, 0)] * 5, 0),
        ([(38, 50), (96, 0)], 3.5),
        ([(6, 48)], 48),
        ([(6, 127)], 48),
    ]:
        midi.rpn(0, 0, (6, 2), (38, 0), *data)
        assert player.value("/playing/bend") == pytest.approx(semitones), data


def test_data_entry_for_anything_else_leaves_the_bend_range_alone(midi, player):
    midi.on(77)
    midi.bend(8191)
    for preamble in [
        [],  # nothing selected yet
        [(101, 0), (100, 0), (101, 127), (100, 127)],  # RPN null
        [(101, 0), (100, 1)],  # fine tuning
        [(101, 1), (100, 0)],
        [(101, 0), (100, 0), (99, 1), (98, 8)],  # an NRPN takes data entry away
        [(99, 0), (98, 0)],
        [(101, 0), (100, 0), (98, 0)],
    ]:
        for control, value in [*preamble, (6, 12), (38, 50), (96, 0), (97, 0), (97, 0)]:
            midi.cc(control, value)
        assert player.value("/playing/bend") == 2.0, preamble


# ---------------------------------------------------------------- pressure


def test_channel_pressure_presses_the_fingers_of_its_channel(midi, listener):
    midi.on(75)
    midi.touch(127, channel=2)
    assert listener.press == PRESS
    midi.touch(0)
    assert listener.press == PRESS
    midi.touch(127)
    assert listener.press == HARDEST
    midi.off(75)
    midi.on(75)
    assert listener.press == HARDEST
    midi.off(75)
    midi.on(75, channel=3)
    assert listener.press == PRESS


def test_poly_pressure_presses_the_finger_of_its_own_note_only_and_ends_with_it(midi, listener):
    midi.on(75)
    midi.on(77)
    midi.send("polytouch", note=75, value=127)
    assert listener.press == PRESS
    midi.send("polytouch", note=77, value=127)
    assert listener.press == HARDEST
    midi.off(75)
    midi.off(77)
    for note in (77, 79):
        midi.on(note)
        assert listener.press == PRESS


# ---------------------------------------------------------------- reset all controllers


def test_reset_all_controllers_puts_back_all_but_volume_and_pan(midi, player, listener):
    midi.rpn(0, 0, (6, 12))
    midi.cc(7, 64)
    midi.cc(11, 64)
    midi.cc(1, 127)
    midi.cc(64, 127)
    midi.on(77)
    midi.cc(10, 127)
    midi.bend(8191)
    midi.touch(127)
    midi.cc(121, 0)
    assert listener.where() == ("C", 5)
    assert listener.press == PRESS
    assert listener["/bow/speed"] == 0.2
    assert listener["/output/level"] == pytest.approx((64 / 127) ** 2)
    assert listener["/room/pan"] == 1.0
    midi.off(77)
    assert player.sounding is None  # the pedal is up
    midi.on(77)
    assert listener.where() == ("C", 5)
    assert listener.press == PRESS


def test_reset_all_controllers_ends_poly_pressure_and_what_only_the_pedal_held(
    midi, player, listener
):
    midi.cc(64, 127)
    midi.on(75)
    midi.on(77)
    midi.off(75)
    midi.send("polytouch", note=77, value=127)
    midi.cc(121, 0)
    assert listener.press == PRESS
    midi.off(77)
    assert player.sounding is None


def test_rpn_1_and_2_tune_the_notes_of_a_channel(midi, listener):
    midi.rpn(0, 2, (6, 64 + 3))
    midi.rpn(0, 1, (6, 96), (38, 0))  # half a semitone
    midi.on(70)
    assert listener.where() == ("C", 1.5)
    midi.off(70)
    midi.on(75, channel=2)
    assert listener.where() == ("C", 3.0)
