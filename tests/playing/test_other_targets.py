"""Binds to parameters that the player does not move: output, body, strings."""

from __future__ import annotations

import mido
import pytest

from yehu_server.playing.bind import Bind
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.midi_poster import MidiPoster


def cc(house: MidiPoster, control: int, value: int, channel: int = 1) -> None:
    house.receive(mido.Message("control_change", control=control, value=value, channel=channel - 1))


def key(house: MidiPoster, kind: str, channel: int = 1) -> None:
    house.receive(mido.Message(kind, note=70, velocity=127, channel=channel - 1))


@pytest.fixture
def house(player) -> MidiPoster:
    binds = (
        Bind("cc 20", "/output/gain", (-12.0, 12.0), smoothing_ms=300.0),
        Bind("cc 21", "/string/inner/tuning"),
        Bind("velocity", "/body/blend"),
    )
    return MidiPoster(player, Mapping("house", binds))


def test_what_the_player_does_not_move_is_bound_as_well(house, listener, player):
    cc(house, 20, 127, 1)
    assert listener.of("/output/gain")[-1][1:] == (12.0, None, 300.0)
    assert player.value("/output/gain") == 12.0
    cc(house, 21, 0, 1)
    assert listener["/string/inner/tuning"] == -200.0
    key(house, "note_on", 1)
    assert listener["/body/blend"] == 1.0


def test_what_is_held_is_not_moved_by_a_bind(house, listener, player):
    player.write("/output/gain", -6.0, hold=True)
    cc(house, 20, 127, 1)
    key(house, "note_on", 1)
    assert listener["/output/gain"] == -6.0
    assert player.value("/output/gain") == -6.0


def test_one_channels_gain_comes_with_its_notes(house, listener):
    cc(house, 20, 127, 1)
    cc(house, 20, 0, 2)
    key(house, "note_on", 2)
    assert listener["/output/gain"] == -12.0
    key(house, "note_off", 2)
    key(house, "note_on", 1)
    assert listener["/output/gain"] == 12.0
