"""Tunes teach: a newcomer finds an easy one, is answered, and is told what went well."""

from __future__ import annotations

from live.page.browser import drive

MOST_ACTIONS = 12
LEAST_BOARD = 0.35  # of the screen


def test_a_newcomer_plays_an_easy_tune_after_few_actions_and_is_answered(imitated) -> None:
    found = drive("page_tunes.mjs", imitated)
    assert found["actions"] <= MOST_ACTIONS
    assert not found["covered"]  # the panel gives way to the instrument
    assert found["overlaps"] == {name: [] for name in found["overlaps"]}
    assert {name: room for name, room in found["boards"].items() if room < LEAST_BOARD} == {}
    assert found["answered"] == "Lower: to 1"
    assert "41 of 42 notes at the first touch." in found["result"]
    assert found["again"]
    assert found["stopped"]
    assert found["heard"] > 0  # whoever listens sees the notes come
    assert found["goesOn"]
