"""Whoever wants little motion sees little, and starts the rest; a narrow diagram can be dragged."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive

from yehu_server.params.table import TABLE

pytestmark = pytest.mark.slow

PICTURES = {"yehu", "tuner", "level", "schelleng", "spectrum"}
LIVELY = 10  # drawings in a second; 60 on a free machine
PLACE = TABLE.index(next(param for param in TABLE if param.address == "/bow/position"))


@pytest.fixture(scope="module")
def found(imitated) -> Any:
    """What was drawn."""
    return drive("page_calm.mjs", imitated)


def test_pictures_show_a_note_and_move_as_a_rule_until_they_are_stopped(found) -> None:
    lively = found["lively"]
    assert set(lively["changed"]) == PICTURES
    assert {name for name, count in lively["drawn"].items() if count > LIVELY} == PICTURES
    assert lively["bowMoves"]
    assert lively["transition"] > 0.0
    assert lively["pressed"] == ["Slowed"]
    assert lively["clicked"]["pressed"] == lively["again"] == []


def test_whoever_wants_little_motion_sees_little_until_it_is_asked_for(found) -> None:
    calm = found["calm"]
    assert set(calm["changed"]) == set(calm["drawn"]) == PICTURES
    assert max(calm["drawn"].values()) <= 3
    assert not calm["bowMoves"]
    assert calm["transition"] == 0.0
    assert calm["pressed"] == calm["again"] == []
    assert calm["clicked"]["pressed"] == ["Slowed"]
    assert calm["clicked"]["drawn"]["yehu"] > LIVELY
    assert calm["clicked"]["drawn"]["spectrum"] <= 3


def test_a_narrow_diagram_is_dragged_while_a_note_sounds(found) -> None:
    """Else the browser takes the finger, to scroll the page."""
    silent, sounding = (found["drag"][name] for name in ("silent", "sounding"))
    places = [value for kind, row, value, *_ in sounding["commands"] if row == PLACE]
    assert (silent["taken"], sounding["taken"]) == (True, False)
    assert places == sorted(places)
    assert places[-1] / places[0] > 3.0
    assert sounding["commands"][-1][0] == "RELEASE"
    assert sounding["room"]["width"] > 320
    assert sounding["room"]["height"] > 240
