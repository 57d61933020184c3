"""The Open Stage Control session: who is spoken to, and what is said."""

import pytest
from surface_readers import READERS

from yehu_server.params.table import TABLE
from yehu_server.surfaces import common_layout


@pytest.fixture(scope="module")
def widgets():
    return READERS["open-stage-control.json"]().file


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
    ends = bow["rangeX"]["max"], bow["rangeY"]["max"]
    assert ends == (common_layout.BOW_SPEED.hi, common_layout.BOW_FORCE.hi)
    assert bow["address"] == "/yehu/bow"
    assert "send('/yehu/bow', 0, 0)" in bow["onTouch"]
    assert "send('/yehu/pitch', value[0])" in string["onValue"]
    assert "send('/yehu/press', value[1])" in string["onValue"]
    assert (keys["address"], keys["start"], keys["keys"]) == ("/yehu/note", 65, 25)
    assert (keys["on"], keys["off"]) == (90, 0)
    assert widgets["release"]["address"] == "/yehu/release"
    assert widgets["panic"]["address"] == "/yehu/panic"


def test_the_session_subscribes_by_itself(widgets):
    script = widgets["root"]["onCreate"]
    assert script.startswith("send('/yehu/subscribe', 60)")
    assert f"{1000 * common_layout.SUBSCRIBE_EVERY_S})" in script
