"""Binds to parameters that the player does not move: output, body, strings."""

from __future__ import annotations

import pytest

from yehu_server.playing.bind import Bind


@pytest.fixture
def house(make):
    return make(
        Bind("cc 20", "/output/gain", (-12.0, 12.0), smoothing_ms=300.0),
        Bind("cc 21", "/string/inner/tuning"),
        Bind("velocity", "/body/blend"),
    )


def test_what_the_player_does_not_move_is_bound_as_well(house, listener, player):
    house.cc(20, 127)
    assert listener.of("/output/gain")[-1][1:] == (12.0, None, 300.0)
    assert player.value("/output/gain") == 12.0
    house.cc(21, 0)
    assert listener["/string/inner/tuning"] == -200.0
    house.on(70, 127)
    assert listener["/body/blend"] == 1.0


def test_what_is_held_is_not_moved_by_a_bind(house, listener, player):
    player.write("/output/gain", -6.0, hold=True)
    house.cc(20, 127)
    house.on(70, 127)
    assert listener["/output/gain"] == -6.0
    assert player.value("/output/gain") == -6.0


def test_one_channels_gain_comes_with_its_notes(house, listener):
    house.cc(20, 127)
    house.cc(20, 0, channel=2)
    house.on(70, 127, channel=2)
    assert listener["/output/gain"] == -12.0
    house.off(70, channel=2)
    house.on(70, 127)
    assert listener["/output/gain"] == 12.0
