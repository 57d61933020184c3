"""MPE: zones, and the effect of member and master channels on the player."""

from __future__ import annotations

import mido
import numpy as np
import pytest

from yehu_server.core.midi.channels import bend_range, configure_zone, master_of
from yehu_server.core.midi.record import MIDI, NONE, prepare_midi
from yehu_server.params.table import TABLE
from yehu_server.playing.mapping import load
from yehu_server.playing.midi_poster import MidiPoster
from yehu_server.playing.wishes import Key

# ---------------------------------------------------------------- zones

USUAL = 7.0  # bend range (semitones) of channels outside all zones


class Zones:
    """The zones of the first port of a part."""

    def __init__(self, *, whole: bool = False) -> None:
        values = {param.address: param.default for param in TABLE}
        midi = np.zeros(1, MIDI)
        prepare_midi(midi, 48000.0, values | {"/playing/bend_range": USUAL}, mpe=whole)
        self._record = midi[0]

    def configure(self, channel: int, members: int) -> bool:
        return configure_zone(self._record, channel, members)

    def master(self, channel: int) -> int | None:
        master = master_of(self._record, channel)
        return None if master == NONE else master

    def members(self, channel: int) -> list[int]:
        return [member for member in range(16) if self.master(member) == channel]

    def bend_range(self, channel: int) -> float:
        return bend_range(self._record, channel)


def test_without_a_zone_every_channel_is_its_own():
    zones = Zones()
    assert all(zones.master(channel) is None for channel in range(16))
    assert all(zones.bend_range(channel) == USUAL for channel in range(16))


def test_a_lower_zone_has_the_channels_above_the_first():
    zones = Zones()
    assert zones.configure(0, 5)
    assert [zones.master(channel) for channel in range(16)] == [None, *[0] * 5, *[None] * 10]
    assert zones.members(0) == [1, 2, 3, 4, 5]
    assert (zones.bend_range(0), zones.bend_range(1), zones.bend_range(6)) == (2.0, 48.0, USUAL)


def test_an_upper_zone_has_the_channels_below_the_last():
    zones = Zones()
    assert zones.configure(15, 3)
    assert [channel for channel in range(16) if zones.master(channel) == 15] == [12, 13, 14]
    assert zones.members(15) == [12, 13, 14]
    assert (zones.bend_range(15), zones.bend_range(14), zones.bend_range(11)) == (2.0, 48.0, USUAL)


def test_the_zone_configured_last_takes_the_channels_of_the_other():
    zones = Zones(whole=True)
    assert len(zones.members(0)) == 15
    zones.configure(15, 6)
    assert (len(zones.members(0)), len(zones.members(15))) == (8, 6)
    zones.configure(0, 15)
    assert (len(zones.members(0)), len(zones.members(15))) == (15, 0)
    zones.configure(0, 0)
    assert not zones.members(0)


def test_other_channels_configure_nothing():
    zones = Zones()
    assert not zones.configure(7, 5)
    assert all(zones.master(channel) is None for channel in range(16))


# ---------------------------------------------------------------- playing


class Surface:
    """Sends messages as an MPE controller does, channels counted from 1."""

    def __init__(self, player: MidiPoster) -> None:
        self.player = player

    def send(self, kind: str, channel: int, **fields: int) -> None:
        self.player.receive(mido.Message(kind, channel=channel - 1, **fields))

    def cc(self, channel: int, control: int, value: int) -> None:
        self.send("control_change", channel, control=control, value=value)

    def rpn(self, channel: int, number: int, value: int) -> None:
        for control, data in ((101, 0), (100, number), (6, value)):
            self.cc(channel, control, data)

    def on(self, channel: int, note: int) -> None:
        self.send("note_on", channel, note=note, velocity=80)

    def off(self, channel: int, note: int) -> None:
        self.send("note_off", channel, note=note)

    def bend(self, channel: int, share: float) -> None:
        self.send("pitchwheel", channel, pitch=round(8191 * share))


@pytest.fixture
def surface(player, mapping) -> Surface:
    surface = Surface(MidiPoster(player, mapping))
    surface.rpn(1, 6, 15)
    return surface


def test_a_members_bend_spans_48_semitones_and_the_masters_adds_two(surface, player):
    surface.on(3, 70)
    surface.bend(3, 0.125)
    assert player.pitch == pytest.approx(76.0, abs=0.01)
    surface.bend(1, -0.5)
    assert player.pitch == pytest.approx(75.0, abs=0.01)
    surface.bend(4, 1.0)  # another note's
    assert player.pitch == pytest.approx(75.0, abs=0.01)


def test_a_bend_before_its_note_belongs_to_it(surface, player):
    surface.bend(5, -0.0625)
    surface.on(5, 75)
    assert player.pitch == pytest.approx(72.0, abs=0.01)
    surface.bend(6, 0.0)
    surface.on(6, 75)
    assert player.pitch == pytest.approx(75.0)


def test_what_one_member_is_told_of_its_bend_range_holds_for_all(surface, player):
    surface.rpn(4, 0, 24)
    surface.on(9, 70)
    surface.bend(9, 0.25)
    assert player.pitch == pytest.approx(76.0, abs=0.01)
    surface.bend(1, 1.0)
    assert player.pitch == pytest.approx(78.0, abs=0.01)  # the master keeps its two


def test_pressure_is_each_notes_own_and_the_masters_where_it_has_none(surface, listener):
    surface.send("aftertouch", 1, value=127)
    surface.on(2, 70)
    assert listener.press == pytest.approx(5.0)
    surface.send("aftertouch", 2, value=0)
    assert listener.press == pytest.approx(1.5)
    surface.send("aftertouch", 1, value=64)
    assert listener.press == pytest.approx(1.5)


def test_the_tenth_channel_plays_in_a_zone(surface, player):
    surface.on(10, 70)
    assert player.sounding == Key(9, 70)


def test_the_masters_pedal_holds_the_notes_of_its_zone(surface, player):
    surface.cc(1, 64, 127)
    surface.on(2, 70)
    surface.off(2, 70)
    assert player.sounding == Key(1, 70)
    surface.cc(1, 64, 0)
    assert player.sounding is None


@pytest.mark.parametrize("mode", [120, 123])
def test_the_masters_notes_off_ends_its_zone(surface, player, mode):
    surface.on(2, 70)
    surface.on(10, 74)
    surface.cc(1, mode, 0)
    assert player.sounding is None


def test_a_new_configuration_ends_notes_and_forgets_bends(surface, player):
    surface.bend(2, 0.5)
    surface.on(2, 70)
    surface.rpn(1, 6, 4)
    assert player.sounding is None
    surface.on(2, 70)
    assert player.pitch == pytest.approx(70.0)
    surface.on(10, 74)  # outside the zone: percussion again
    assert player.pitch == pytest.approx(70.0)


def test_another_port_has_zones_of_its_own(surface, player):
    surface.player.receive(mido.Message("note_on", channel=2, note=70, velocity=80), port=1)
    surface.player.receive(mido.Message("pitchwheel", channel=2, pitch=8191), port=1)
    assert player.pitch == pytest.approx(72.0)


def test_the_mpe_preset_begins_as_a_zone(player):
    surface = Surface(MidiPoster(player, load("mpe")))
    surface.on(2, 70)
    surface.bend(2, 0.25)
    assert player.pitch == pytest.approx(82.0, abs=0.01)
    surface.rpn(1, 6, 0)  # and is one no more
    surface.on(2, 70)
    surface.bend(2, 1.0)
    assert player.pitch == pytest.approx(72.0)
