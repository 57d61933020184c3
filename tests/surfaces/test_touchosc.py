"""The TouchOSC layout, read back."""

import re

import pytest
from surface_readers import READERS, sent, start

from yehu_server.params.table import BY_ADDRESS, offered
from yehu_server.playing.pitch_and_level import note_name
from yehu_server.surfaces import common_layout


@pytest.fixture(scope="module")
def document():
    return READERS["yehu.tosc"]().file


def test_a_fader_sends_its_value_and_takes_what_it_receives_without_sending_it(document):
    for fader in document.find_all(type="FADER"):
        param = offered(BY_ADDRESS[fader.get("tag")])
        (message,) = fader.messages
        assert message.receive
        assert not message.feedback
        script = fader.get("script")
        lo, hi = re.search(r"local lo, hi = (\S+), (\S+)", script).groups()
        formula = re.search(r"'%.5g', (.*)\)\n", script).group(1).replace("^", "**")
        names = {"lo": float(lo), "hi": float(hi)}
        for unit in (0.0, 0.2, 0.5, 0.9, 1.0):
            shown = eval(formula, {}, names | {"x": unit})  # noqa: S307
            assert shown == pytest.approx(param.from_unit(unit))
        (value,) = document.find(param.address).find_all("value")
        assert float(start(value, "text")) == pytest.approx(param.default, rel=1e-3)


def test_the_string_pad_slides_and_presses(document):
    (pad,) = document.find_all("string", type="XY")
    pitch, press = common_layout.STRING_PITCH, common_layout.STRING_PRESS
    assert [sent(message) for message in pad.messages] == [
        ("/yehu/pitch", [("VALUE", "x", pitch.lo, pitch.hi)], [("x", "ANY")]),
        ("/yehu/press", [("VALUE", "y", press.lo, press.hi)], [("y", "ANY")]),
    ]


def test_the_bow_pad_draws_and_lifts_at_its_release(document):
    (pad,) = document.find_all("bow", type="XY")
    speed, force = common_layout.BOW_SPEED, common_layout.BOW_FORCE
    draw, lift = (sent(message) for message in pad.messages)
    assert draw == (
        "/yehu/bow",
        [("VALUE", "x", speed.lo, speed.hi), ("VALUE", "y", force.lo, force.hi)],
        [("x", "ANY"), ("y", "ANY"), ("touch", "RISE")],
    )
    assert lift[0] == "/yehu/bow"
    assert [argument[:2] for argument in lift[1]] == [("CONSTANT", "0"), ("CONSTANT", "0")]
    assert lift[2] == [("touch", "FALL")]
    assert (start(pad), start(pad, "y")) == (0.5, 0.0)  # at rest


def test_a_key_sends_its_velocity_and_then_0(document):
    for key in common_layout.KEYS:
        (button,) = document.find_all(note_name(key), type="BUTTON")
        (message,) = button.messages
        address, (note, velocity), triggers = sent(message)
        assert (address, triggers) == ("/yehu/note", [("x", "ANY")])
        assert note[:2] == ("CONSTANT", str(key))
        assert velocity == ("VALUE", "x", 0.0, 90.0)


@pytest.mark.parametrize("name", ["release", "panic"])
def test_a_button_says_its_call_once_when_pressed(document, name):
    (button,) = document.find_all(name, type="BUTTON")
    assert [sent(message) for message in button.messages] == [
        (f"/yehu/{name}", [], [("x", "RISE")])
    ]


def test_the_layout_subscribes_by_itself(document):
    script = document.root.get("script")
    assert "sendOSC('/yehu/subscribe/unit')" in script
    assert f"> {1000 * common_layout.SUBSCRIBE_EVERY_S} then" in script


def test_bar_pages_and_tabs_lie_above_each_other(any_table):
    document = READERS["yehu.tosc"]().file
    assert len(document.find_all(type="FADER")) == len(any_table)
    (pager,) = document.find_all(type="PAGER")
    for page in pager.children:
        assert page.frame.y == pager.get("tabbarSize")
        assert page.frame.y + page.frame.h == pager.frame.h
    assert pager.frame.y + pager.frame.h == document.root.frame.h
    bar = [child for child in document.root.children if child is not pager]
    assert all(child.frame.y + child.frame.h <= pager.frame.y for child in bar)


def test_py2tosc_finds_nothing_wrong_and_ids_differ(document):
    assert [str(issue) for issue in document.validate()] == []
    ids = [control.id for control in document.walk()]
    assert len(set(ids)) == len(ids)
