"""Whoever plays a tune along is followed, answered, and sees what went well."""

from __future__ import annotations

import json
from typing import Any

import pytest

EASY = {"twinkle", "frere_jacques", "au_clair_de_la_lune"}
STUDIES = {"slow_air", "bow_pressure", "mpe_phrase"}


@pytest.fixture(scope="module")
def found(run_node, page) -> Any:
    return json.loads(run_node("tune.test.mjs", page))


def test_it_waits_for_each_note_and_says_what_went_well_and_what_was_hard(found) -> None:
    assert found["waiting"]["way"] == [1, 1, 2, 2, 3, 4]
    assert found["waiting"]["wrong"] == [69]
    assert not found["waiting"]["isOn"]
    result = found["waiting"]["result"]
    assert (result["right"], result["count"], result["run"]) == (3, 4, 2)
    assert [note["pitch"] for note in result["hardest"]] == [65, 67]
    assert found["left"] is None
    assert found["bowed"] == [1, 2]  # another stroke of the hand repeats a note


def test_in_time_it_goes_on_and_says_how_late(found) -> None:
    result = found["timed"]["result"]
    assert (result["right"], result["count"]) == (3, 4)
    assert result["late"] == pytest.approx((0.1 + 0.0 + 0.0) / 3, abs=0.01)
    assert found["timed"]["wrong"] == [70]
    assert not found["timed"]["isOn"]


def test_there_are_twelve_tunes_within_reach_the_easiest_first(found) -> None:
    tunes = [tune for tune in found["tunes"] if tune["name"] not in STUDIES]
    assert len(tunes) == 12
    assert {tune["name"] for tune in tunes[:3]} == EASY
    assert {tune["name"] for tune in tunes if tune["isEasy"]} == EASY
    for tune in tunes:
        low, high = tune["range"]
        assert 65 <= low < high <= 89
        assert tune["isInOrder"]
        assert tune["count"] > 20


def test_tunes_are_written_in_their_own_key_and_slurs_are_seen(found) -> None:
    tunes = {tune["name"]: tune for tune in found["tunes"]}
    assert tunes["twinkle"]["jianpu"] == "1 1 5 5 6 6 5"
    assert tunes["auld_lang_syne"]["jianpu"] == "5\u0323 1 1 1 3 2 1"
    assert tunes["twinkle"]["tied"] == 0
    assert tunes["amazing_grace"]["tied"] == 4  # as its file has slurs
    # Fingers are those of the first position.
    assert found["fingers"] == [0, 1, 2, 3, 0, 1, 2, 3, 4]


def test_the_challenge_counts_tone_from_the_first_stroke_and_after_a_scratch(found) -> None:
    state = found["challenge"]
    assert state["isOver"]
    assert state["gone"] == pytest.approx(20.0)
    assert state["tone"] == pytest.approx(3.0 + 4.0 + 8.5)
    assert state["longest"] == pytest.approx(8.5)
    assert state["found"] == pytest.approx(1.0)  # of a bow that was too light
