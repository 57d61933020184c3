"""Tunes teach: a newcomer finds an easy one, is answered, and is told what went well."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing, served

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))

MOST_ACTIONS = 12
LEAST_BOARD = 0.35  # of the screen


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> Any:
    """What a newcomer saw and did."""
    with served(tmp_path_factory.mktemp("generated")) as url:
        return drive("page_tunes.mjs", url)


def test_nothing_goes_wrong(found) -> None:
    assert found["errors"] == []


def test_a_newcomer_plays_an_easy_tune_after_few_actions(found) -> None:
    assert found["actions"] <= MOST_ACTIONS
    assert not found["covered"]  # the panel gives way to the instrument


def test_nothing_lies_over_anything_at_any_size(found) -> None:
    assert found["overlaps"] == {name: [] for name in found["overlaps"]}
    assert {name: room for name, room in found["boards"].items() if room < LEAST_BOARD} == {}


def test_a_wrong_note_is_answered(found) -> None:
    assert found["answered"] == "Lower: to 1"


def test_at_its_end_it_tells_what_went_well(found) -> None:
    assert "41 of 42 notes at the first touch." in found["result"]
    assert found["again"]
    assert found["stopped"]


def test_whoever_listens_sees_the_notes_come(found) -> None:
    assert found["heard"] > 0
    assert found["goesOn"]
