"""What the page shows fits its screen, is reached by keys, and does what it says."""

import json
import re
from typing import Any

import pytest
from live.page.browser import ROOT, drive

from yehu_server.params.table import TABLE

INDEX = {param.address: index for index, param in enumerate(TABLE)}
# What every language writes with Latin letters, or that is no word.
LATIN = re.compile(
    r"yehu-server serve --mapping|/[a-z_/]+|Keys|Switch to English|English|MIDI|MPE|AudioWorklet|"
    r"Hz|dBFS|dB|ms|m/s|CC|N?RPN|WAV|Esc|Web|https|\b(?:[A-Z][♯♭]?#?|N|s|mm|st|ct)\b"
)


@pytest.fixture(scope="module")
def found(imitated) -> Any:
    """What a visitor found."""
    return drive("page_views.mjs", imitated)


def test_on_any_screen_all_has_room_and_a_name_and_the_hands_need_no_scrolling(found, subtests):
    assert set(found["layouts"]) == {"phone", "tablet", "desk"}
    for size, layout in found["layouts"].items():
        for name, panel in layout["panels"].items():
            with subtests.test(size=size, panel=name):
                assert (panel["wide"], panel["small"], panel["nameless"]) == (0, [], [])
        assert layout["hands"] < layout["height"], size
    assert found["beside"] == {"more": True, "shift": False}  # a panel on a laptop hides no note


def test_the_tab_key_goes_from_the_header_over_the_hands_to_the_rest_and_is_seen(found) -> None:
    ids = [each["id"] for each in found["focus"]]
    way = ["help", "language", "theme", "start", "fingerboard", "bow"]
    assert [each for each in ids if each in way] == way
    assert ids[:4] == way[:4]
    assert {each["ring"] for each in found["focus"]} == {"solid"}


@pytest.mark.skipif(not (ROOT / "web/node_modules/axe-core").is_dir(), reason="needs axe-core")
def test_axe_finds_nothing_that_keeps_people_out(imitated, everything):
    assert drive("page_axe.mjs", imitated, "all" if everything else "some") == []


def test_load_and_latency_are_shown_where_they_are_high(found) -> None:
    assert found["status"] == ["", "load 85 % · latency 12 ms"]


def test_the_diagram_places_the_bow_until_it_is_let_go(found) -> None:
    *placed, end = found["placed"]
    assert [command[:2] for command in placed] == 2 * [
        ["WRITE", INDEX["/bow/position"]],
        ["WRITE", INDEX["/bow/force"]],
    ]
    (near, light, far, firm) = (value for _kind, _row, value, *_ in placed)
    assert 0.04 <= near < far <= 0.5
    assert 0.0 < light < firm <= 5.0
    assert end[0] == "RELEASE"
    assert found["corner"] == pytest.approx([0.5, 10.0])  # the greatest of both


def test_what_was_kept_is_played_again_and_what_is_no_performance_is_refused(found) -> None:
    def notes(commands: list[list[Any]]) -> list[list[Any]]:
        return [command[:4] for command in commands if command[0] in ("BEGIN", "END")]

    assert len(notes(found["played"])) == 4
    assert notes(found["replayed"]) == notes(found["played"])
    *kept, end = (json.loads(line) for line in found["kept"])
    assert end["end"] > 0
    assert [line[2] for line in kept if line[2] in ("begin", "end")] == ["begin", "end"] * 2
    assert {line[1] for line in kept} == {1}  # the one player
    assert found["wrong"] == "wrong.jsonl is no performance of this instrument."


def test_a_midi_keyboard_plays_and_leaves_no_note_when_it_is_pulled_out(found) -> None:
    assert [command[0] for command in found["midi"] if command[0] in ("BEGIN", "END")] == [
        "BEGIN",
        "END",
    ]
    assert found["inputs"] == ["All that are connected"]


def test_a_tune_plays_waits_for_whoever_plays_along_and_stops(found) -> None:
    assert found["tune"] > 0
    assert found["tuneStopped"]["held"] == 0
    at_first, after_a_wrong_note, after_the_right_one = found["along"]
    assert at_first == after_a_wrong_note == 0.0
    assert after_the_right_one > 0.0
    assert found["listening"] == "Listen: Shi Bei Jiu"  # to screen readers
    assert found["stopping"] == "Stop: Shi Bei Jiu"
    assert found["alongEnded"]  # by Escape


@pytest.mark.slow
def test_in_another_language_nothing_that_sounds_or_was_written_is_lost(imitated) -> None:
    found = drive("page_language.mjs", imitated)
    assert found["stays"]
    assert found["held"] == 1
    assert found["searched"] == "bow"
    assert found["before"] != found["after"] == found["anew"]  # as loaded in that language
    left = [re.sub(LATIN, "", line.partition("|")[2]) for line in found["anew"]]
    assert [line for line in left if re.search(r"[A-Za-z]{2}", line)] == []
