"""Whoever plays a tune along is followed, answered, and sees what went well."""

import json
from typing import Any

import pytest

from yehu_server.params.articulations import ARTICULATIONS

EASY = {"twinkle", "frere_jacques", "au_clair_de_la_lune"}
ON_ITS_WAY = {"fall", "trill", "wide-trill"}  # is the finger when it is looked at
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


def test_the_challenge_counts_tone_from_the_first_stroke_and_after_a_scratch(found) -> None:
    state = found["challenge"]
    assert state["isOver"]
    assert state["gone"] == pytest.approx(20.0)
    assert state["tone"] == pytest.approx(3.0 + 4.0 + 8.5)
    assert state["longest"] == pytest.approx(8.5)
    assert state["found"] == pytest.approx(1.0)  # of a bow that was too light


def test_the_strings_and_fingers_that_are_printed_are_those_that_play(
    run_node, playing, subtests, everything
):
    presets, tunes = "vibrato,ordinary", "twinkle"
    articulations = "ordinary,straight,rolling-vibrato,flageolet"
    if everything:
        presets, tunes = f"{presets},pizzicato", f"{tunes},frere_jacques,silent_night"
        articulations = ",".join(each.name for each in ARTICULATIONS if each.name not in ON_ITS_WAY)
    played = json.loads(run_node("fingering.mjs", playing, presets, tunes, articulations))
    for name, notes in played.items():
        with subtests.test(name):
            assert len(notes) >= 5
            assert [note["printed"] for note in notes] == [note["seen"] for note in notes]
    openly, stopped = ([note["printed"] for note in played[f"{each} twinkle ordinary"]]
                       for each in ("ordinary", "vibrato"))  # fmt: skip
    assert openly[2] == [1, 0]  # C5 on its open string, or by the fourth finger
    assert stopped[2] == [0, 4]
