"""Whoever wants little motion sees little, and starts the rest; a narrow diagram can be dragged."""

from typing import Any

import pytest
from live.page.browser import drive

pytestmark = pytest.mark.slow

PICTURES = {"yehu", "tuner", "level", "schelleng", "spectrum"}
LIVELY = 10  # drawings in a second; 60 on a free machine


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
