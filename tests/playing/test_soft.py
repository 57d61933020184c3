"""Soft take-over: a controller moves its target only after reaching its value."""

import pytest

from yehu_server.playing.bind import Bind

VOLUME = "/playing/volume"
SOFT = Bind("cc 1", VOLUME, is_soft=True)


@pytest.fixture
def at(player):
    """Move a control; return the volume."""

    def move(midi, *values: int, control: int = 1, channel: int = 1) -> float:
        for value in values:
            midi.cc(control, value, channel)
        return player.value(VOLUME)

    return move


def test_a_controller_waits_until_it_comes_to_its_target_or_jumps_over_its_place(make, at):
    midi = make(SOFT)
    midi.player.set(VOLUME, 0.5)
    assert [at(midi, value) for value in (0, 40, 61)] == [0.5] * 3
    assert at(midi, 62) == pytest.approx(62 / 127)  # 1/64 of the way is two steps
    assert at(midi, 0) == 0.0
    midi.player.set(VOLUME, 0.5)
    assert at(midi, 127) == 1.0


def test_whoever_moves_the_target_takes_it_from_the_controller(make, at):
    midi = make(SOFT, Bind("cc 2", VOLUME), Bind("/fader", VOLUME))
    midi.player.set(VOLUME, 0.0)
    assert at(midi, 0, 100) == pytest.approx(100 / 127)
    at(midi, 20, control=2)
    assert at(midi, 101) == pytest.approx(20 / 127)  # waits
    assert at(midi, 19) == pytest.approx(19 / 127)  # passed
    midi.player.move("/fader", 0.9)
    assert at(midi, 20) == 0.9
    midi.player.set(VOLUME, 0.2)
    assert at(midi, 30) == pytest.approx(30 / 127)  # passed, from 20 to 30


def test_hard_and_soft_targets_of_one_controller_do_not_disturb_each_other(make, at, player):
    midi = make(SOFT, Bind("cc 1", "/playing/expression"))
    midi.player.set(VOLUME, 0.5)
    assert at(midi, 10) == 0.5
    assert player.value("/playing/expression") == pytest.approx(10 / 127)
    value = at(midi, 100)
    midi.player.set(VOLUME, value)  # where it was: it is not taken
    assert at(midi, 20) == pytest.approx(20 / 127)


def test_the_master_of_a_zone_picks_up_for_its_members(make, at, player):
    midi = make(SOFT, mpe=True)
    midi.player.set(VOLUME, 0.5)
    midi.on(70, channel=4)
    assert at(midi, 0, channel=1) == 0.5
    assert at(midi, 127, 10, channel=1) == pytest.approx(10 / 127)
    assert player.value(VOLUME) == pytest.approx(10 / 127)


def test_an_osc_fader_waits_too(make, player):
    midi = make(Bind("/fader", VOLUME, input_range=(0.0, 10.0), is_soft=True))
    midi.player.set(VOLUME, 0.5)
    midi.player.move("/fader", 1.0)
    assert player.value(VOLUME) == 0.5
    midi.player.move("/fader", 9.0)
    assert player.value(VOLUME) == 0.9
    midi.player.set(VOLUME, 0.1)
    midi.player.move("/fader", 8.0)
    assert player.value(VOLUME) == 0.1
    midi.player.move("/fader", 1.1)
    assert player.value(VOLUME) == pytest.approx(0.11)
