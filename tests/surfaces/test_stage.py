"""The Open Stage Control session, read back."""

import json

import pytest

from yehu_server.params.spec import Curve
from yehu_server.params.table import TABLE
from yehu_server.surfaces import layout, open_stage_control


@pytest.fixture(scope="module")
def session():
    return json.loads(open_stage_control.make(("192.168.1.5", 9001)))


@pytest.fixture(scope="module")
def widgets(session):
    def walk(widget):
        yield widget
        for child in (*widget.get("tabs", ()), *widget.get("widgets", ())):
            yield from walk(child)

    found = list(walk(session["content"]))
    assert len({widget["id"] for widget in found}) == len(found)
    return {widget["id"]: widget for widget in found}


def test_it_is_a_session(session):
    assert (session["type"], session["content"]["type"]) == ("session", "root")


def test_every_parameter_has_one_fader_with_its_range_and_default(widgets):
    faders = {widget["address"]: widget for widget in widgets.values() if widget["type"] == "fader"}
    assert sorted(faders) == sorted(f"/yehu{param.address}" for param in TABLE)
    for param in TABLE:
        fader = faders[f"/yehu{param.address}"]
        assert fader["range"] == {"min": param.lo, "max": param.hi}
        assert fader["default"] == param.default
        assert fader["logScale"] == (param.curve is Curve.EXP)
        assert round(param.default, fader["decimals"]) == param.default
        assert layout.label(param) in fader["html"]
        assert param.range_text in fader["html"]


def test_all_that_sends_speaks_to_the_server(widgets):
    speaking = [
        widget
        for widget in widgets.values()
        if {"address", "onValue", "onTouch", "onCreate"} & set(widget)
    ]
    assert len(speaking) == len(TABLE) + 6  # two pads, keys, two buttons, the root
    assert all(widget["target"] == ["192.168.1.5:9001"] for widget in speaking)


def test_pads_keys_and_buttons_say_the_calls(widgets):
    bow, string, keys = widgets["bow pad"], widgets["string pad"], widgets["keys"]
    assert (bow["rangeX"]["max"], bow["rangeY"]["max"]) == (
        layout.BOW_SPEED.hi,
        layout.BOW_FORCE.hi,
    )
    assert bow["address"] == "/yehu/bow"
    assert "send('/yehu/bow', 0, 0)" in bow["onTouch"]
    assert "send('/yehu/pitch', value[0])" in string["onValue"]
    assert "send('/yehu/press', value[1])" in string["onValue"]
    assert (keys["address"], keys["start"], keys["keys"]) == ("/yehu/note", 65, 25)
    assert (keys["on"], keys["off"]) == (90, 0)
    assert widgets["panic"]["address"] == "/yehu/panic"


def test_the_session_subscribes_by_itself(widgets):
    script = widgets["root"]["onCreate"]
    assert script.startswith("send('/yehu/subscribe', 60)")
    assert f"{1000 * layout.SUBSCRIBE_EVERY_S})" in script
