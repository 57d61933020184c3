"""Soft take-over: a controller moves its target only after reaching its value."""

from __future__ import annotations

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


def test_each_channel_picks_up_for_itself(make, at, player):
    midi = make(SOFT)
    midi.player.set(VOLUME, 0.5)
    midi.on(70)
    assert at(midi, 0, 127, channel=1) == 1.0
    midi.on(72, channel=2)
    assert player.value(VOLUME) == 0.5
    assert at(midi, 127, channel=2) == 0.5
    assert at(midi, 0, channel=2) == 0.0
    midi.off(72, channel=2)
    assert player.value(VOLUME) == 1.0


def test_the_master_of_a_zone_picks_up_for_its_members(make, at, player):
    midi = make(SOFT, mpe=True)
    midi.player.set(VOLUME, 0.5)
    midi.on(70, channel=4)
    assert at(midi, 0, channel=1) == 0.5
    assert at(midi, 127, 10, channel=1) == pytest.approx(10 / 127)
    assert player.value(VOLUME) == pytest.approx(10 / 127)


def test_a_reset_lets_the_controller_wait_again(make, at, player):
    target = "/playing/expression"
    midi = make(Bind("cc 1", target, is_soft=True))
    at(midi, 127, 64)
    assert player.value(target) == pytest.approx(64 / 127)
    at(midi, 0, control=121)
    assert player.value(target) == 1.0
    at(midi, 64)
    assert player.value(target) == 1.0


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


def test_fourteen_bits_are_picked_up_by_either_half(make, at):
    midi = make(Bind("cc 1/33", VOLUME, is_soft=True))
    midi.player.set(VOLUME, 0.5)
    assert at(midi, 60) == 0.5
    assert at(midi, 127, control=33) == 0.5
    assert at(midi, 62) == pytest.approx(62 * 128 / 16383)
    assert at(midi, 5, control=33) == pytest.approx((62 * 128 + 5) / 16383)
