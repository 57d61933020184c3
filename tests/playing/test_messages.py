"""What MIDI channel messages mean to the player, with the shipped keyboard mapping."""

from __future__ import annotations

import mido
import pytest

from yehu_server.playing.mapping import load
from yehu_server.playing.messages import MidiPlayer
from yehu_server.playing.performer import Key

PRESS, HARDEST = 1.5, 5.0  # N, as in mappings/keyboard.toml
SLOWEST, FASTEST = 0.08, 0.35  # m/s
FIRMEST = 0.55


class Midi:
    """A keyboard: methods send messages, on channel 1 unless told."""

    def __init__(self, player: MidiPlayer) -> None:
        self._player = player

    def send(self, kind: str, **fields) -> None:
        self._player.receive(mido.Message(kind, **fields))

    def on(self, note: int, velocity: int = 64, channel: int = 1) -> None:
        self.send("note_on", note=note, velocity=velocity, channel=channel - 1)

    def off(self, note: int, channel: int = 1) -> None:
        self.send("note_off", note=note, channel=channel - 1)

    def cc(self, control: int, value: int, channel: int = 1) -> None:
        self.send("control_change", control=control, value=value, channel=channel - 1)

    def bend(self, pitch: int, channel: int = 1) -> None:
        self.send("pitchwheel", pitch=pitch, channel=channel - 1)

    def touch(self, value: int, channel: int = 1) -> None:
        self.send("aftertouch", value=value, channel=channel - 1)

    def rpn(self, msb: int, lsb: int, *data: tuple[int, int], channel: int = 1) -> None:
        for control, value in ((101, msb), (100, lsb), *data):
            self.cc(control, value, channel)


@pytest.fixture
def midi(player) -> Midi:
    return Midi(MidiPlayer(player, load("keyboard")))


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


def test_velocity_sets_the_bow_force_and_not_its_speed(midi, listener):
    midi.on(75, velocity=127)
    assert listener["/bow/pressure"] == pytest.approx(FIRMEST)
    midi.on(76, velocity=1)
    assert listener["/bow/pressure"] == pytest.approx(0.3 + 0.25 / 127)
    assert {abs(move.value) for move in listener.of("/bow/speed")} == {0.2}


def test_all_channels_but_the_tenth_play_on_the_one_instrument(midi, player):
    for channel in range(1, 17):
        midi.on(75, channel=channel)
        midi.off(75, channel=channel)
    assert player.notes_played == 15


def test_the_tenth_channel_moves_nothing(midi, listener):
    midi.on(75)
    heard = len(listener.moves)
    midi.on(40, channel=10)
    midi.bend(8191, channel=10)
    midi.touch(127, channel=10)
    for control in (1, 7, 11, 64, 120, 121, 123):
        midi.cc(control, 127, channel=10)
    assert len(listener.moves) == heard
    assert not listener.silenced


def test_only_the_channels_chosen_play(player):
    chosen = MidiPlayer(player, load("keyboard"), {2, 9})
    for channel in range(16):
        chosen.receive(mido.Message("note_on", note=75, channel=channel))
        chosen.receive(mido.Message("note_off", note=75, channel=channel))
    assert player.notes_played == 2
    assert chosen.notes_by_channel == {2: 1, 9: 1}


def test_notes_are_counted_by_channel(player):
    midi = MidiPlayer(player, load("keyboard"))
    for channel, note in ((0, 66), (4, 70), (0, 20), (4, 71), (4, 71)):
        midi.receive(mido.Message("note_on", note=note, channel=channel))
    assert midi.notes_by_channel == {0: 2, 4: 3}


def test_messages_that_are_none_of_the_players_business_change_nothing(player, listener):
    midi = MidiPlayer(player, load("keyboard"))
    heard = len(listener.moves)
    for message in (
        mido.Message("program_change", program=40),
        mido.Message("clock"),
        mido.Message("sysex", data=(1, 2, 3)),
        mido.Message("control_change", control=20, value=99),
        mido.MetaMessage("set_tempo", tempo=400_000),
    ):
        midi.receive(message)
    assert len(listener.moves) == heard


def test_a_message_acts_at_its_frame(player, listener):
    midi = MidiPlayer(player, load("keyboard"))
    heard = len(listener.moves)
    midi.receive(mido.Message("note_on", note=75), frame=321)
    midi.receive(mido.Message("control_change", control=120), frame=321)
    assert {move.frame for move in listener.moves[heard:]} == {321}
    assert listener.silenced == [321]


# ---------------------------------------------------------------- pitch bend


@pytest.mark.parametrize(("pitch", "semitones"), [(8191, 2), (-8192, -2), (0, 0)])
def test_the_ends_of_the_wheel_are_the_whole_bend_range(midi, listener, pitch, semitones):
    midi.on(77)
    midi.bend(pitch)
    assert listener.where() == ("C", 5 + semitones)


def test_the_wheel_bends_in_fourteen_bits(midi, player):
    midi.on(77)
    midi.bend(1)
    assert player.value("/playing/bend") == pytest.approx(2 / 8191)
    midi.bend(4096)
    assert player.value("/playing/bend") == pytest.approx(1.0, abs=2e-4)


def test_a_wheel_moved_between_notes_bends_the_next_one(midi, listener):
    midi.bend(8191)
    midi.on(77)
    assert listener.where() == ("C", 7)


@pytest.mark.parametrize(
    ("data", "semitones"),
    [
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
    ],
)
def test_rpn_0_sets_the_bend_range(midi, player, data, semitones):
    midi.on(77)
    midi.bend(8191)
    midi.rpn(0, 0, *data)
    assert player.value("/playing/bend") == pytest.approx(semitones)


def test_a_new_bend_range_is_heard_at_once_and_in_later_notes(midi, listener):
    midi.on(77)
    midi.bend(-8192)
    midi.rpn(0, 0, (6, 3))
    assert listener.where() == ("C", 2)
    midi.off(77)
    midi.on(80)
    assert listener.where() == ("C", 5)


@pytest.mark.parametrize(
    "preamble",
    [
        [],  # nothing selected yet
        [(101, 0), (100, 0), (101, 127), (100, 127)],  # RPN null
        [(101, 0), (100, 1)],  # fine tuning
        [(101, 1), (100, 0)],
        [(101, 0), (100, 0), (99, 1), (98, 8)],  # an NRPN takes data entry away
        [(99, 0), (98, 0)],
        [(101, 0), (100, 0), (98, 0)],
    ],
)
def test_data_entry_for_anything_else_leaves_the_bend_range_alone(midi, player, preamble):
    midi.on(77)
    midi.bend(8191)
    for control, value in [*preamble, (6, 12), (38, 50), (96, 0), (97, 0), (97, 0)]:
        midi.cc(control, value)
    assert player.value("/playing/bend") == 2.0


def test_each_channel_has_its_own_bend_and_bend_range(midi, listener):
    midi.rpn(0, 0, (6, 12), channel=2)
    midi.bend(8191, channel=1)
    midi.bend(4096, channel=2)
    midi.on(77, channel=1)
    assert listener.where() == ("C", 7)
    midi.on(77, channel=2)
    assert listener.where()[1] == pytest.approx(11, abs=0.01)
    midi.off(77, channel=2)  # back to the held one
    assert listener.where() == ("C", 7)


def test_the_wheel_of_another_channel_does_not_bend_the_note(midi, listener):
    midi.on(77, channel=1)
    midi.bend(8191, channel=2)
    assert listener.where() == ("C", 5)


def test_the_bend_of_one_channel_does_not_choose_the_string_for_another(midi, listener):
    midi.bend(-8192, channel=1)
    midi.on(77, channel=1)
    midi.off(77, channel=1)
    midi.on(72, channel=2)
    assert listener.where() == ("C", None)


# ---------------------------------------------------------------- pressure


def test_channel_pressure_presses_the_finger(midi, listener):
    midi.on(75)
    assert listener["/finger/1/press"] == PRESS
    midi.touch(127)
    assert listener["/finger/1/press"] == HARDEST
    midi.touch(0)
    assert listener["/finger/1/press"] == PRESS


def test_channel_pressure_lasts_through_the_next_note(midi, listener):
    midi.on(75)
    midi.touch(127)
    midi.off(75)
    midi.on(77)
    assert listener["/finger/1/press"] == HARDEST


def test_the_pressure_of_another_channel_does_not_press_the_finger(midi, listener):
    midi.on(75, channel=1)
    midi.touch(127, channel=2)
    assert listener["/finger/1/press"] == PRESS


def test_the_pressure_of_one_channel_stays_on_it(midi, listener):
    midi.on(75, channel=1)
    midi.touch(127, channel=1)
    midi.off(75, channel=1)
    midi.on(77, channel=2)
    assert listener["/finger/1/press"] == PRESS


def test_poly_pressure_presses_the_finger_of_its_own_note_only(midi, listener):
    midi.on(75)
    midi.on(77)
    midi.send("polytouch", note=75, value=127)
    assert listener["/finger/1/press"] == PRESS
    midi.send("polytouch", note=77, value=127)
    assert listener["/finger/1/press"] == HARDEST


def test_poly_pressure_ends_with_its_note(midi, listener):
    midi.on(75)
    midi.send("polytouch", note=75, value=127)
    midi.off(75)
    midi.on(77)
    assert listener["/finger/1/press"] == PRESS


# ---------------------------------------------------------------- controllers


def test_the_mod_wheel_draws_the_bow_faster_by_equal_ratios(midi, listener):
    midi.on(75)
    assert listener["/bow/speed"] == 0.2
    midi.cc(1, 0)
    assert listener["/bow/speed"] == pytest.approx(SLOWEST)
    midi.cc(1, 127)
    assert listener["/bow/speed"] == pytest.approx(FASTEST)
    speeds = []
    for value in range(0, 121, 40):
        midi.cc(1, value)
        speeds.append(listener["/bow/speed"])
    assert speeds[1] / speeds[0] == pytest.approx(speeds[2] / speeds[1])
    assert speeds[2] / speeds[1] == pytest.approx(speeds[3] / speeds[2])


def test_volume_and_expression_set_the_level(midi, listener):
    midi.cc(7, 64)
    assert listener["/output/level"] == pytest.approx((64 / 127) ** 2)
    midi.cc(11, 64)
    assert listener["/output/level"] == pytest.approx((64 / 127) ** 4)
    midi.cc(7, 0)
    assert listener["/output/level"] == 0.0


# ---------------------------------------------------------------- the pedal


def test_the_pedal_holds_a_note_until_it_comes_up(midi, listener, player):
    midi.cc(64, 127)
    midi.on(75)
    midi.off(75)
    assert player.sounding == Key(0, 75)
    midi.cc(64, 0)
    assert silent(listener, player)


@pytest.mark.parametrize(("value", "down"), [(0, False), (63, False), (64, True), (127, True)])
def test_the_pedal_is_down_from_64(midi, player, value, down):
    midi.cc(64, value)
    midi.on(75)
    midi.off(75)
    assert (player.sounding is not None) == down


def test_the_pedal_does_not_end_a_key_that_is_still_down(midi, player):
    midi.cc(64, 127)
    midi.on(75)
    midi.on(77)
    midi.off(77)
    midi.cc(64, 0)
    assert player.sounding == Key(0, 75)


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


def test_a_key_let_go_twice_and_pressed_again_under_the_pedal_is_held_by_the_hand(midi, player):
    midi.cc(64, 127)
    midi.on(75)
    midi.off(75)
    midi.off(75)
    midi.on(75)
    midi.cc(64, 0)
    assert player.sounding == Key(0, 75)


def test_a_pedal_pressed_again_does_not_bring_notes_back(midi, player):
    midi.cc(64, 127)
    midi.on(75)
    midi.off(75)
    midi.cc(64, 0)
    midi.cc(64, 127)
    assert player.sounding is None


def test_a_pedal_told_twice_that_it_is_down_still_holds(midi, player):
    midi.cc(64, 127)
    midi.on(75)
    midi.off(75)
    midi.cc(64, 100)
    assert player.sounding == Key(0, 75)


def test_each_channel_has_its_own_pedal(midi, player):
    midi.cc(64, 127, channel=2)
    midi.on(75, channel=1)
    midi.off(75, channel=1)
    assert player.sounding is None
    midi.on(77, channel=2)
    midi.off(77, channel=2)
    midi.cc(64, 0, channel=1)
    assert player.sounding == Key(1, 77)
    midi.cc(64, 0, channel=2)
    assert player.sounding is None


def test_many_notes_under_the_pedal_all_end_with_it(midi, player, listener):
    midi.cc(64, 127)
    for note in (66, 70, 75, 80, 70):
        midi.on(note)
        midi.off(note)
    assert player.sounding == Key(0, 70)
    midi.cc(64, 0)
    assert silent(listener, player)


# ---------------------------------------------------------------- channel modes


@pytest.mark.parametrize("control", [120, 123, 124, 125, 126, 127])
@pytest.mark.parametrize("pedal", [0, 127])
def test_mode_messages_end_every_note(midi, player, listener, control, pedal):
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


@pytest.mark.parametrize("control", [120, 123])
def test_a_mode_message_leaves_the_notes_of_other_channels(midi, player, listener, control):
    midi.on(75, channel=1)
    midi.cc(control, 0, channel=2)
    assert player.sounding == Key(0, 75)
    assert listener["/bow/side"] == -1.0
    assert not listener.silenced


def test_reset_all_controllers_puts_back_all_but_the_volume(midi, player, listener):
    midi.rpn(0, 0, (6, 12))
    midi.cc(7, 64)
    midi.cc(11, 64)
    midi.cc(1, 127)
    midi.cc(64, 127)
    midi.on(77)
    midi.bend(8191)
    midi.touch(127)
    midi.cc(121, 0)
    assert listener.where() == ("C", 5)
    assert listener["/finger/1/press"] == PRESS
    assert listener["/bow/speed"] == 0.2
    assert listener["/output/level"] == pytest.approx((64 / 127) ** 2)
    midi.off(77)
    assert player.sounding is None  # the pedal is up
    midi.on(77)
    assert listener.where() == ("C", 5)
    assert listener["/finger/1/press"] == PRESS


def test_reset_all_controllers_keeps_the_bend_range_but_closes_data_entry(midi, player):
    midi.rpn(0, 0, (6, 12))
    midi.cc(121, 0)
    midi.cc(6, 5)
    midi.on(77)
    midi.bend(8191)
    assert player.value("/playing/bend") == 12.0


def test_reset_all_controllers_ends_what_only_the_pedal_held(midi, player):
    midi.cc(64, 127)
    midi.on(75)
    midi.off(75)
    midi.cc(121, 0)
    assert player.sounding is None


def test_reset_all_controllers_does_not_bend_the_note_of_another_channel(midi, listener):
    midi.on(77, channel=1)
    midi.bend(8191, channel=1)
    midi.touch(127, channel=1)
    midi.cc(121, 0, channel=2)
    assert listener.where() == ("C", 7)
    assert listener["/finger/1/press"] == HARDEST


# ---------------------------------------------------------------- skipped notes


def test_a_skipped_note_leaves_the_sounding_one_alone(listener, ruler):
    from yehu_server.playing.fingering import RangePolicy
    from yehu_server.playing.performer import Performer

    player = Performer(listener, ruler, RangePolicy.SKIP)
    midi = MidiPlayer(player, load("keyboard"))
    midi.receive(mido.Message("note_on", note=75, velocity=30))
    heard = list(listener.moves)
    midi.receive(mido.Message("note_on", note=40, velocity=127))
    midi.receive(mido.Message("note_off", note=40))
    assert listener.moves == heard
    assert player.sounding == Key(0, 75)
