"""The OSC messages that pages begin with, in the order in which they stand there."""

import pytest
from pages import page
from sound import rms


def number(word: str) -> int | float:
    return int(word) if word.lstrip("-").isdigit() else float(word)


@pytest.mark.parametrize("name", ["README.md", "docs/osc.md"])
def test_the_five_messages_begin_move_and_end_a_note(still, name):
    block = next(each for each in page(name).blocks("") if each.startswith("/yehu"))
    lines = [line.partition("   ")[0].split() for line in block.splitlines()]
    messages = [(line[0].removeprefix("/yehu"), *map(number, line[1:])) for line in lines]
    sounding = [None, 67.0, 71.0, 71.0, None]
    for message, pitch in zip(messages, sounding, strict=True):
        still.send(*message)
        heard = still.pass_time(0.5)
        assert still.player.pitch == pytest.approx(pitch)
        assert (rms(heard[-4800:]) > 1e-3) == (pitch is not None), message
    address, wanted = messages[3]
    assert still.value(address) == pytest.approx(wanted)
    assert still.peer.received() != []
