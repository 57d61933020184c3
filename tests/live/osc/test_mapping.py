"""OSC addresses that the user's mapping binds to parameters."""

import pytest

from yehu_server.playing.bind import Bind
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
def own_still(still):
    still.player.remap(OWN, frame=0)
    return still


def say(still, wire, address: str, *arguments, tags: str | None = None) -> list[str]:
    """Send a message without the prefix; return the errors answered."""
    still.peer.received()
    still.take(wire.message(address, *arguments, tags=tags))
    return [" ".join(heard.arguments) for heard in still.peer.received()]


def test_an_address_of_ones_own_moves_what_it_is_bound_to(own_still, wire):
    for sent, volume in ((0.0, 0.0), (63.5, 0.5), (127, 1.0), (900.0, 1.0), (-1, 0.0)):
        told = say(own_still, wire, "/fader1", sent)
        assert [words.partition(";")[0] for words in told] == (
            ["/fader1 900 is outside 0 to 127"] if sent == 900.0 else []
        )
        assert own_still.value(VOLUME) == volume
    assert say(own_still, wire, "/1/push", tags="T") == []
    assert own_still.value("/playing/pizzicato") == 1.0


def test_patterns_reach_ones_own_addresses_too(own_still, wire):
    assert say(own_still, wire, "/fader[12]", 0) == []
    assert own_still.value(VOLUME) == 0.0
    assert own_still.value("/playing/expression") == 1.0
    assert say(own_still, wire, "/fader{2,3}", 1) == []
    assert own_still.value("/playing/expression") == 0.0
    assert own_still.value(VOLUME) == 0.0
    assert say(own_still, wire, "/fadr*", 1) == [
        "/fadr* the pattern matches no address; * ends at a /"
    ]


def test_what_ones_own_address_cannot_mean_is_answered(own_still, wire):
    for address, arguments, reason in [
        ("/fader1", (), "expected 1 argument, got 0"),
        ("/fader1", (0.5, 0.5), "expected 1 argument, got 2"),
        ("/fader1", ("loud",), "expected a number, got a string"),
        ("/fader1", (float("nan"),), "nan is not finite"),
        ("/fader3", (0.5,), "unknown address (all but learned ones begin with /yehu/)"),
        ("/yehu/fader1", (0.5,), "unknown address"),
        (
            "/fadr1",
            (0.5,),
            "unknown address (all but learned ones begin with /yehu/); did you mean /fader1?",
        ),
        (
            "/YEHU/note",
            (67, 90),
            "unknown address (all but learned ones begin with /yehu/); did you mean /yehu/note?",
        ),
    ]:
        (error,) = say(own_still, wire, address, *arguments)
        assert error.startswith(f"{address} {reason}")
    assert own_still.value(VOLUME) == 1.0
    own_still.player.remap(Mapping("other", ()), frame=0)
    (error,) = say(own_still, wire, "/fader1", 1)
    assert "unknown address" in error
