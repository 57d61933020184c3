"""OSC addresses that the user's mapping binds to parameters."""

from __future__ import annotations

import pytest

from yehu_server.playing.binds import Bind
from yehu_server.playing.mapping import Mapping

VOLUME = "/playing/volume"
OWN = Mapping(
    "own",
    (
        Bind("/fader1", VOLUME, input_range=(0.0, 127.0)),
        Bind("/fader2", "/playing/expression", invert=True),
        Bind("/1/push", "/playing/pizzicato"),
    ),
)


@pytest.fixture
def own_stage(stage):
    stage.player.remap(OWN, frame=0)
    return stage


def say(stage, wire, address: str, *arguments, tags: str | None = None) -> list[str]:
    """Send a message without the prefix; return the errors answered."""
    stage.ear.heard()
    stage.take(wire.message(address, *arguments, tags=tags))
    return [" ".join(heard.arguments) for heard in stage.ear.heard()]


def test_an_address_of_ones_own_moves_what_it_is_bound_to(own_stage, wire):
    for sent, volume in ((0.0, 0.0), (63.5, 0.5), (127, 1.0), (900.0, 1.0), (-1, 0.0)):
        assert say(own_stage, wire, "/fader1", sent) == []
        assert own_stage.value(VOLUME) == volume
    assert say(own_stage, wire, "/1/push", tags="T") == []
    assert own_stage.value("/playing/pizzicato") == 1.0


def test_patterns_reach_ones_own_addresses_too(own_stage, wire):
    assert say(own_stage, wire, "/fader[12]", 0) == []
    assert own_stage.value(VOLUME) == 0.0
    assert own_stage.value("/playing/expression") == 1.0
    assert say(own_stage, wire, "/fader{2,3}", 1) == []
    assert own_stage.value("/playing/expression") == 0.0
    assert own_stage.value(VOLUME) == 0.0
    assert say(own_stage, wire, "/fadr*", 1) == ["/fadr* the pattern matches no address"]


@pytest.mark.parametrize(
    ("address", "arguments", "reason"),
    [
        ("/fader1", (), "expected 1 argument, got 0"),
        ("/fader1", (0.5, 0.5), "expected 1 argument, got 2"),
        ("/fader1", ("loud",), "expected a number, got a string"),
        ("/fader1", (float("nan"),), "nan is not finite"),
        ("/fader3", (0.5,), "unknown address (all begin with /yehu/)"),
        ("/yehu/fader1", (0.5,), "unknown parameter"),
    ],
)
def test_what_ones_own_address_cannot_mean_is_answered(own_stage, wire, address, arguments, reason):
    (error,) = say(own_stage, wire, address, *arguments)
    assert error.startswith(f"{address} {reason}")
    assert own_stage.value(VOLUME) == 1.0


def test_an_address_that_the_mapping_gives_up_is_unknown(own_stage, wire):
    own_stage.player.remap(Mapping("other", ()), frame=0)
    (error,) = say(own_stage, wire, "/fader1", 1)
    assert "unknown address" in error


def test_ones_own_address_is_heard_at_the_time_of_its_tag(own_stage, wire):
    due = own_stage.clock.time() + 0.1
    bundle = wire.bundle(due, wire.message("/fader1", 0.0))
    own_stage.take(bundle)
    assert own_stage.player.value(VOLUME) == 1.0
    own_stage.pass_time(0.15)
    assert own_stage.player.value(VOLUME) == 0.0
    (frame,) = own_stage.frames("/output/level")
    assert frame == pytest.approx(0.1 * own_stage.RATE, abs=own_stage.RATE * 0.002)


def test_subscribers_hear_of_what_ones_own_address_moves(own_stage, wire):
    own_stage.ask("/subscribe")
    own_stage.take(wire.message("/fader1", 0.0))
    own_stage.pass_time(0.05)
    assert ("/yehu/playing/volume", 0.0) in [
        (heard.address, *heard.arguments) for heard in own_stage.ear.heard()
    ]


def test_a_faders_burst_costs_no_note(own_stage, wire):
    own_stage.tell("/note", 67.0, 90.0)
    for step in range(200):
        say(own_stage, wire, "/fader1", step % 128)
    own_stage.pass_time(0.01)
    assert own_stage.player.pitch is not None
    assert own_stage.handler.counts.errors == 0
