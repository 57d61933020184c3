"""MPE: zones, and the effect of member and master channels on the player."""

import numpy as np
import pytest

from yehu_server.core.midi.channels import bend_range, configure_zone, master_of
from yehu_server.core.midi.record import MIDI, NONE, prepare_midi
from yehu_server.params.table import TABLE
from yehu_server.playing.mapping import load
from yehu_server.playing.part_state import Key

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


def test_without_a_zone_every_channel_is_its_own_and_most_configure_none():
    zones = Zones()
    assert not zones.configure(7, 5)
    assert all(zones.master(channel) is None for channel in range(16))
    assert all(zones.bend_range(channel) == USUAL for channel in range(16))


def test_a_lower_zone_has_the_channels_above_the_first_and_an_upper_one_those_below_the_last():
    for master, members, expected in ((0, 5, [1, 2, 3, 4, 5]), (15, 3, [12, 13, 14])):
        zones = Zones()
        assert zones.configure(master, members)
        assert zones.members(master) == expected
        ranges = [zones.bend_range(channel) for channel in range(16)]
        usual = [48.0 if channel in expected else USUAL for channel in range(16)]
        assert ranges == [2.0 if n == master else each for n, each in enumerate(usual)]


def test_the_zone_configured_last_takes_the_channels_of_the_other():
    zones = Zones(whole=True)
    assert len(zones.members(0)) == 15
    zones.configure(15, 6)
    assert (len(zones.members(0)), len(zones.members(15))) == (8, 6)
    zones.configure(0, 15)
    assert (len(zones.members(0)), len(zones.members(15))) == (15, 0)
    zones.configure(0, 0)
    assert not zones.members(0)


# ---------------------------------------------------------------- playing


@pytest.fixture
def zone(midi):
    midi.rpn(0, 6, (6, 15))
    return midi


def test_a_members_bend_spans_48_semitones_and_the_masters_adds_two(zone, player):
    zone.on(70, channel=3)
    zone.bend(1024, channel=3)
    assert player.pitch == pytest.approx(76.0, abs=0.01)
    zone.bend(-4096)
    assert player.pitch == pytest.approx(75.0, abs=0.01)
    zone.bend(-512, channel=5)  # of a note that is to come
    assert player.pitch == pytest.approx(75.0, abs=0.01)
    zone.on(75, channel=5)
    assert player.pitch == pytest.approx(71.0, abs=0.01)


def test_pressure_is_each_notes_own_and_the_masters_where_it_has_none(zone, listener):
    zone.touch(127)
    zone.on(70, channel=2)
    assert listener.press == pytest.approx(5.0)
    zone.touch(0, channel=2)
    assert listener.press == pytest.approx(1.5)
    zone.touch(64)
    assert listener.press == pytest.approx(1.5)


def test_the_master_holds_and_ends_the_notes_of_its_zone_also_on_the_tenth_channel(zone, player):
    zone.cc(64, 127)
    zone.on(70, channel=10)
    zone.off(70, channel=10)
    assert player.sounding == Key(9, 70)
    zone.cc(64, 0)
    assert player.sounding is None
    for mode in (120, 123):
        zone.on(70, channel=2)
        zone.on(74, channel=10)
        zone.cc(mode, 0)
        assert player.sounding is None


def test_a_new_configuration_ends_notes_and_forgets_bends(zone, player):
    zone.bend(4096, channel=2)
    zone.on(70, channel=2)
    zone.rpn(0, 6, (6, 4))
    assert player.sounding is None
    zone.on(70, channel=2)
    assert player.pitch == pytest.approx(70.0)
    zone.on(74, channel=10)  # outside the zone: percussion again
    assert player.pitch == pytest.approx(70.0)


def test_the_mpe_preset_begins_as_a_zone(make, player):
    preset = load("mpe")
    zone = make(*preset.binds, start=preset.start, mpe=preset.mpe)
    zone.on(70, channel=2)
    zone.bend(2048, channel=2)
    assert player.pitch == pytest.approx(82.0, abs=0.01)
    zone.rpn(0, 6, (6, 0))  # and is one no more
    zone.on(70, channel=2)
    zone.bend(8191, channel=2)
    assert player.pitch == pytest.approx(72.0)
