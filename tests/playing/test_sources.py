"""Every source of a mapping, moved by MIDI messages to both its ends."""

import pytest

from yehu_server.errors import ParameterError
from yehu_server.params.spec import Curve
from yehu_server.params.table import find
from yehu_server.playing.bind import Bind
from yehu_server.playing.sources import canonical

VOLUME = "/playing/volume"


@pytest.fixture
def playing(make, player):
    """Send MIDI to a player with these binds, and controllers; return the volume."""

    def play(*binds: Bind):
        midi = make(*binds)

        def cc(*moves: tuple[int, int], channel: int = 1) -> float:
            for control, value in moves:
                midi.cc(control, value, channel)
            return player.value(VOLUME)

        return midi, cc

    return play


# ---------------------------------------------------------------- names


def test_each_source_has_one_name():
    same = ("cc 0", "cc 119", "cc 0/32", "cc 31/63", "nrpn 0", "nrpn 16382", "note")
    same += ("/fader1", "/1/xy.2/a-b", "/yehus")
    other = {"nrpn 0/0": "nrpn 0", "nrpn 2/44": "nrpn 300", "nrpn 127/126": "nrpn 16382"}
    other |= {"CC 1": "cc 1", "cc74": "cc 74", "CC1/33": "cc 1/33", "NRPN2/44": "nrpn 300"}
    names = {text: text for text in same} | other
    assert {text: canonical(text) for text in names} == names


NO_SOURCES = [
    *("cc", "Cc 1", "cc 01", "cc \uff11", "cc 120", "cc 128", "cc 6", "cc 98", "cc  1"),
    *("cc 1/34", "cc 1/1", "cc 32/64", "cc 33/1", "cc 6/38", "cc 1/", "cc 1/033"),
    *("nrpn", "nrpn 16383", "nrpn 127/127", "nrpn 128/0", "nrpn 0/128", "nrpn 300/1", "nrpn 99999"),
    *("rpn 0", "note 3", "breath", ""),
    *("/", "//a", "/a/", "/a b", "/a*", "/a?", "/{a,b}", "/[a]", "/a#", "/å", "/" + 300 * "a"),
    *("/yehu", "/yehu/note"),
]


def test_what_is_no_source_is_refused_in_one_line(subtests):
    for text in NO_SOURCES:
        with subtests.test(text=text):
            with pytest.raises(ParameterError) as caught:
                canonical(text)
            assert str(caught.value).isprintable()


# ---------------------------------------------------------------- 14 bits


def test_two_controls_make_fourteen_bits(playing):
    """The coarse half acts at once; the fine one is nothing then, and never changes it."""
    _, cc = playing(Bind("cc 1/33", VOLUME))
    for coarse in range(128):
        assert round(cc((1, coarse)) * 16383) == coarse * 128
        for fine in (0, 1, 126, 127):
            assert round(cc((33, fine)) * 16383) == coarse * 128 + fine


# ---------------------------------------------------------------- NRPN


def test_an_nrpn_moves_in_fourteen_bits(playing):
    _, cc = playing(Bind("nrpn 300", VOLUME))
    assert cc((99, 2), (98, 44), (6, 0)) == 0.0
    assert cc((6, 127), (38, 127)) == 1.0
    assert cc((6, 64)) == pytest.approx(64 * 128 / 16383)
    assert cc((38, 9)) == pytest.approx((64 * 128 + 9) / 16383)


def test_data_entry_for_anything_else_moves_no_nrpn(playing):
    _, cc = playing(Bind("nrpn 300", VOLUME))
    anything = [
        [(6, 0)],
        [(99, 2), (6, 0)],  # only half of a number
        [(98, 44), (6, 0)],
        [(99, 2), (98, 45), (6, 0)],
        [(99, 44), (98, 2), (6, 0)],
        [(99, 2), (98, 44), (99, 127), (98, 127), (6, 0)],
        [(99, 2), (98, 44), (101, 0), (100, 0), (6, 0)],  # data entry is the bend range's
        [(99, 2), (98, 44), (38, 0)],
        [(101, 2), (100, 44), (6, 0)],
        [(101, 2), (98, 44), (6, 0)],  # halves of two numbers
        [(99, 2), (100, 44), (98, 44), (6, 0)],
    ]
    for channel, moves in zip((*range(1, 10), 11, 12), anything, strict=True):
        assert cc(*moves, channel=channel) == 1.0, moves


def test_an_nrpn_is_stepped_from_where_it_or_its_target_is(playing):
    midi, cc = playing(Bind("nrpn 300", VOLUME))
    midi.player.set(VOLUME, 0.5)
    assert cc((99, 2), (98, 44), (96, 0)) == pytest.approx(0.5 + 1 / 127)
    assert cc((97, 0), (97, 0)) == pytest.approx(0.5 - 1 / 127)
    assert cc(*[(96, 0)] * 127) == 1.0
    assert cc(*[(97, 0)] * 127) == pytest.approx(0.0, abs=1e-12)


# ---------------------------------------------------------------- terms


def test_a_bind_hears_only_its_channels(playing, player):
    midi, cc = playing(
        Bind("cc 1", VOLUME, channels=(2, 3)),
        Bind("cc 1", "/playing/expression", channels=(4,)),
        Bind("velocity", "/playing/attack", channels=(2,)),
    )
    midi.on(70)
    assert cc((1, 0)) == 1.0
    assert player.value("/playing/attack") == 40.0
    midi.on(71, 127, channel=2)
    assert player.value("/playing/attack") == 500.0
    assert cc((1, 0), channel=2) == 0.0
    midi.on(72, channel=3)
    assert cc((1, 127), channel=2) == 1.0  # that of a channel that does not sound
    assert cc((1, 0), channel=3) == 0.0
    midi.on(72, channel=4)
    assert cc((1, 0), channel=4) == 1.0
    assert player.value("/playing/expression") == 0.0


def test_a_wheel_may_be_inverted_or_curved_and_still_ends_at_the_range(make, player):
    for how, top in (({"invert": True}, -2.0), ({"curve": Curve.S}, 2.0)):
        midi = make(Bind("bend", "/playing/bend", **how))
        midi.on(77)
        for pitch, bend in ((8191, top), (0, 0.0), (-8192, -top)):
            midi.bend(pitch)
            assert player.value("/playing/bend") == bend
    midi.bend(4096)
    assert player.value("/playing/bend") > 1.1


# ---------------------------------------------------------------- smoothing


def test_a_smoothed_move_takes_its_time_at_least_and_is_no_quicker_than_the_hand(make, listener):
    midi = make(
        Bind("cc 74", "/playing/bow_position", smoothing_ms=50.0),
        Bind("cc 72", "/playing/bow_position", smoothing_ms=1.0),
        Bind("cc 71", "/playing/bow_position"),
        Bind("bend", "/playing/bend", smoothing_ms=80.0),
    )
    midi.on(77)
    for control, ramp_ms in ((74, 50.0), (72, 20.0), (71, find("/bow/position").smooth_ms)):
        midi.cc(control, control)
        assert listener.of("/bow/position")[-1].ramp_ms == ramp_ms
    midi.bend(1000)
    assert listener.of(f"/finger/{listener.finger}/position")[-1].ramp_ms == 80.0


def test_whatever_comes_next_need_not_wait_for_the_glide(playing, listener):
    midi, cc = playing(Bind("cc 1", "/playing/speed", smoothing_ms=900.0))
    midi.on(70)
    cc((1, 20))
    assert listener.of("/bow/speed")[-1].ramp_ms == 900.0
    heard = len(listener.moves)
    midi.on(74)
    assert all(move.ramp_ms != 900.0 for move in listener.moves[heard:])
    midi.player.set("/playing/speed", 0.15)
    assert listener.of("/bow/speed")[-1][1:] == (0.15, None, find("/bow/speed").smooth_ms)


# ---------------------------------------------------------------- OSC addresses


def test_an_osc_address_moves_its_targets_on_all_channels(playing, player):
    midi, cc = playing(
        Bind("/fader", VOLUME, input_range=(0.0, 127.0)),
        Bind("/fader", "/playing/attack", (10.0, 110.0), invert=True),
        Bind("cc 7", VOLUME),
    )
    midi.player.move("/fader", 127)
    assert (player.value(VOLUME), player.value("/playing/attack")) == (1.0, 10.0)
    midi.player.move("/fader", 0)
    assert (player.value(VOLUME), player.value("/playing/attack")) == (0.0, 110.0)
    for channel in (1, 5):
        midi.on(70, channel=channel)
        assert player.value(VOLUME) == 0.0
    assert cc((7, 64), channel=5) == pytest.approx(64 / 127)  # moved last
    midi.player.move("/fader", 127)
    assert player.value(VOLUME) == 1.0
    midi.player.move("/else", 0)
    assert player.value(VOLUME) == 1.0


# ---------------------------------------------------------------- output, body, strings


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
