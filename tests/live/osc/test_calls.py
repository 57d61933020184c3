"""Calls by OSC: notes, bow, bend, panic, reset, release, ping."""

import numpy as np
import pytest
from sound import rms
from wire import f32, values

HEARD_S = 0.01  # within which what arrives is played: the player's delay and a block


# ---------------------------------------------------------------- notes, bow and finger


def test_pitch_slides_the_sounding_note_steplessly(still):
    still.send("/note", 67, 90)
    still.pass_time(0.1)
    still.events.clear()
    for pitch in np.linspace(67.1, 70.0, 30):
        still.send("/pitch", float(pitch))
        still.pass_time(HEARD_S)
        assert still.player.pitch == pytest.approx(pitch, abs=1e-5)
    assert {address for _, address, _ in still.events} == {
        "/finger/1/position",
        "/output/balance",
        "/body/brilliance",
        "/body/brilliance_frequency",
        "/finger/1/press",  # some notes want it firmer
        "/bow/speed",  # A4 wants it slow
        "/bow/pressure",
        "/bow/position",
    }
    places = [place for _, address, place in still.events if address == "/finger/1/position"]
    assert len(places) == 30
    assert all(np.diff(places) > 0.0)
    still.send("/note/off", 67)
    still.pass_time(HEARD_S)
    assert still.player.pitch is None


def test_pitch_and_bow_alone_make_a_theremin(still):
    still.send("/pitch", 69.0)
    landing = rms(still.pass_time(0.1))
    heard = values(still.ask("/bow", 0.2, 0.6))
    assert heard == {"/yehu/bow/speed": f32(0.2), "/yehu/bow/force": f32(0.6)}
    assert rms(still.pass_time(0.5)[-9600:]) > 5.0 * landing
    assert still.player.pitch == 69.0
    heard = values(still.ask("/bow", -9, 99))
    assert heard == {"/yehu/bow/speed": -2.0, "/yehu/bow/force": 5.0}
    still.send("/bow", 0.0, 0.0)
    still.pass_time(0.1)
    assert still.player.value("/bow/side") == 0.0
    assert still.player.pitch is None


def test_bend_and_press_are_parameters_within_bounds_and_move_the_sounding_note(still):
    for call, address, most in ("/bend", "/playing/bend", 48.0), ("/press", "/playing/press", 6.0):
        assert values(still.ask(call, 1000)) == {"/yehu" + address: most}
        assert values(still.ask(call, 1.5)) == {"/yehu" + address: 1.5}
    still.send("/note", 67, 90)
    still.send("/bend", 2.0)
    still.send("/press", 4.0)
    still.pass_time(0.05)
    assert still.player.pitch == 69.0
    pressed = [value for _, address, value in still.events if address == "/finger/1/press"]
    assert pressed[-1] == 4.0
    still.send("/bend", -3.0)
    still.pass_time(0.05)
    assert still.player.pitch == 65.0  # the open string


# ---------------------------------------------------------------- panic and reset


MESS = [
    ("/note", 67, 90),
    ("/note", 72.25, 127),
    ("/note", 80, 1),
    ("/bow/speed", 0.4),
    ("/bow/side", 1.0),
    ("/finger/1/press", 4.0),
    ("/bow", 0.3, 0.7),
    ("/pitch", 77.3),
    ("/note", 66, 64),
    ("/bend", 3.0),
    ("/playing/volume", 0.7),
]


@pytest.mark.parametrize("order", [1, 4, 5])
@pytest.mark.parametrize("end", ["/panic", "/reset"])
def test_after_panic_or_reset_nothing_is_left(still, wire, order, end):
    mess = MESS[order:] + MESS[:order]
    for address, *arguments in mess[: 5 + order]:
        still.send(address, *arguments)
        still.pass_time(0.02)
    still.take(wire.bundle(still.clock.time() + 0.3, wire.message("/yehu/note", 74, 90)))
    still.send(end)
    assert still.handler.waiting == 0
    still.pass_time(0.05)
    assert still.player.pitch is None
    assert not still.pass_time(0.5).any()
    still.send("/note/off", 67)  # letting go later brings nothing back
    assert not still.pass_time(0.1).any()
    still.send("/note", 69, 90)
    assert rms(still.pass_time(0.5)) > 1e-4


def test_a_release_lifts_a_bow_that_no_note_draws(still):
    still.send("/pitch", 69)
    still.send("/bow", 0.2, 0.5)
    assert rms(still.pass_time(0.5)) > 1e-3
    still.send("/release")
    still.pass_time(1.0)
    assert rms(still.pass_time(0.3)) < 1e-4


def test_a_momentary_button_that_is_let_go_ends_nothing(still):
    still.send("/note", 67, 90)
    still.send("/playing/volume", 0.7)
    for call in ("/panic", "/reset", "/release"):
        for argument in (0, 0.0, False):
            still.send(call, argument)
    still.pass_time(0.1)
    assert still.player.pitch == 67.0
    assert still.player.value("/playing/volume") == pytest.approx(0.7)
    still.send("/panic", 1.0)
    still.pass_time(0.1)
    assert still.player.pitch is None


# ---------------------------------------------------------------- ping


def test_a_ping_comes_back_with_what_it_brought(still):
    for tags, arguments in [
        ("", []),
        ("ifs", [1, 0.5, "a"]),
        ("TFN", [True, False, None]),
        ("hd", [2**62, 1e300]),
        ("bb", [b"\0\1\2", b""]),
        ("i", [-(2**31)]),
    ]:
        assert still.ask("/ping", *arguments, tags=tags) == [("/yehu/pong", arguments)]
    for tags, arguments in ("t", [1]), ("[" * 3000 + "]" * 3000, []):
        assert still.ask("/ping", *arguments, tags=tags)
