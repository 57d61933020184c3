"""Whoever wants little motion sees little, and starts the rest; a narrow diagram can be dragged."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing, served

from yehu_server.params.table import TABLE

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(missing() is not None, reason=str(missing())),
]

PICTURES = {"yehu", "tuner", "level", "schelleng", "spectrum"}
LIVELY = 10  # drawings in a second; 60 on a free machine
PLACE = TABLE.index(next(param for param in TABLE if param.address == "/bow/position"))


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> Any:
    """What was drawn."""
    generated = tmp_path_factory.mktemp("generated")
    with served(generated) as url:
        return drive("page_calm.mjs", url)


@pytest.mark.parametrize("way", ["lively", "calm"])
def test_every_picture_shows_a_note_that_begins(found, way: str) -> None:
    assert set(found[way]["changed"]) == PICTURES


def test_pictures_move_as_a_rule(found) -> None:
    drawn = found["lively"]["drawn"]
    assert {name for name, count in drawn.items() if count > LIVELY} == PICTURES
    assert found["lively"]["bowMoves"]
    assert found["lively"]["transition"] > 0.0


def test_whoever_wants_little_motion_sees_pictures_change_three_times_a_second(found) -> None:
    drawn = found["calm"]["drawn"]
    assert set(drawn) == PICTURES
    assert max(drawn.values()) <= 3
    assert not found["calm"]["bowMoves"]
    assert found["calm"]["transition"] == 0.0


def test_the_slowed_strings_start_when_they_are_asked_for(found) -> None:
    assert found["calm"]["pressed"] == []
    assert found["calm"]["clicked"]["pressed"] == ["Slowed"]
    assert found["calm"]["clicked"]["drawn"]["yehu"] > LIVELY
    assert found["calm"]["clicked"]["drawn"]["spectrum"] <= 3
    assert found["calm"]["again"] == []


def test_what_moves_can_be_stopped(found) -> None:
    assert found["lively"]["pressed"] == ["Slowed"]
    assert found["lively"]["clicked"]["pressed"] == found["lively"]["again"] == []


def test_a_narrow_diagram_is_dragged_while_a_note_sounds(found) -> None:
    """Else the browser takes the finger, to scroll the page."""
    silent, sounding = (found["drag"][name] for name in ("silent", "sounding"))
    places = [value for kind, row, value, *_ in sounding["wishes"] if row == PLACE]
    assert (silent["taken"], sounding["taken"]) == (True, False)
    assert places == sorted(places)
    assert places[-1] / places[0] > 3.0
    assert sounding["wishes"][-1][0] == "RELEASE"
    assert sounding["room"]["width"] > 320
    assert sounding["room"]["height"] > 240


def test_nothing_goes_wrong(found) -> None:
    assert [found[name]["errors"] for name in ("lively", "calm", "drag")] == [[], [], []]
