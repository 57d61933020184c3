"""How the boxes of the Max patch are connected."""

import pytest
from surface_readers import READERS

from yehu_server.params.table import TABLE
from yehu_server.surfaces import common_layout


@pytest.fixture(scope="module")
def patch():
    return READERS["yehu.maxpat"]().file


def test_a_dial_sends_what_is_moved_and_is_set_without_sending(patch):
    dials = {dial["varname"]: dial for dial in patch.all("live.dial")}
    for param in TABLE:
        dial = dials[param.address]
        ((said, _),) = patch.after(dial)
        assert patch.texts_after(said) == ["s yehu.moved"]
        ((quietly, _),) = patch.after(patch.one(f"route /yehu{param.address}"))
        assert quietly["text"] == "prepend set"
        assert [target for target, _ in patch.after(quietly)] == [dial]


def test_it_speaks_to_the_server_and_names_the_port_it_hears_at(patch):
    assert patch.one("udpreceive 7400")
    subscribe = patch.one("/yehu/subscribe 60 7400")
    assert patch.texts_after(subscribe) == ["udpsend 192.168.1.5 9001"]
    metro = patch.one(f"metro {1000 * common_layout.SUBSCRIBE_EVERY_S}")
    assert patch.texts_after(metro) == [subscribe["text"]]


def test_the_panel_ignores_the_server_while_a_dial_is_moved(patch):
    moved = patch.one("r yehu.moved")
    ((order, _),) = [each for each in patch.after(moved) if each[0]["text"] == "t b b"]
    ((close, _),) = patch.after(order, 1)
    ((delay, _),) = patch.after(order, 0)
    ((then, _),) = patch.after(delay)
    ((reopen, _),) = patch.after(then, 1)
    assert (close["text"], reopen["text"]) == ("0", "1")
    assert patch.texts_after(close) == patch.texts_after(reopen) == ["gate 1 1"]
    assert patch.after(patch.one("udpreceive 7400")) == [(patch.one("gate 1 1"), 1)]


def test_the_keyboard_sends_notes_and_their_ends(patch):
    (keys,) = patch.all("kslider")
    assert keys["mode"] == 2  # a touch screen's: the release is sent too
    assert keys["offset"] <= common_layout.KEYS[0]
    assert keys["offset"] + keys["range"] > common_layout.KEYS[-1]
    ((note, first),) = patch.after(keys)
    ((same, second),) = patch.after(keys, 1)
    assert (note, first, second) == (same, 0, 1)
    assert patch.texts_after(note) == ["prepend /yehu/note"]


@pytest.mark.parametrize("pad", common_layout.PADS, ids=lambda pad: pad.name)
def test_a_pad_sends_its_calls(patch, pad):
    (slider,) = (box for box in patch.all("pictslider") if box["varname"] == pad.name)
    found = {}
    for outlet, axis in enumerate(pad.axes):
        ((scale, _),) = patch.after(slider, outlet)
        assert list(map(float, scale["text"].split()[1:])) == [0, 1000, axis.lo, axis.hi]
        ((joined, inlet),) = patch.after(scale)
        (call,) = patch.texts_after(joined)
        found.setdefault(call, {})[inlet] = outlet
    assert found == {
        f"prepend /yehu{call}": dict(enumerate(numbers)) for call, numbers in pad.calls
    }
