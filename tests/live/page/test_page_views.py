"""What the page shows fits its screen, is reached by keys, and does what it says."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest
from live.page.browser import drive, missing, served

from yehu_server.live.page.examples import write_capture_headers
from yehu_server.params.table import TABLE
from yehu_server.playing.preset_folders import Presets

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))

ROW = {param.address: row for row, param in enumerate(TABLE)}


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> Any:
    """What a visitor found."""
    generated = tmp_path_factory.mktemp("generated")
    write_capture_headers(generated / "captures")
    with served(generated) as url:
        return drive("page_views.mjs", url)


def test_the_page_loads_and_works_without_an_error(found) -> None:
    assert found["errors"] == []


@pytest.mark.parametrize("size", ["phone", "tablet", "desk"])
def test_nothing_is_wider_than_the_screen(found, size: str) -> None:
    panels = found["layouts"][size]["panels"]
    assert {name: panel["wide"] for name, panel in panels.items()} == dict.fromkeys(panels, 0)


@pytest.mark.parametrize("size", ["phone", "tablet", "desk"])
def test_whatever_is_touched_has_room_for_a_finger(found, size: str) -> None:
    assert [
        small for panel in found["layouts"][size]["panels"].values() for small in panel["small"]
    ] == []


@pytest.mark.parametrize("size", ["phone", "tablet", "desk"])
def test_every_control_has_a_name(found, size: str) -> None:
    panels = found["layouts"][size]["panels"].values()
    assert [nameless for panel in panels for nameless in panel["nameless"]] == []


@pytest.mark.parametrize("size", ["phone", "tablet", "desk"])
def test_fingerboard_and_bow_are_seen_without_scrolling(found, size: str) -> None:
    layout = found["layouts"][size]
    assert layout["hands"] < layout["height"]


def test_the_tab_key_goes_from_the_header_over_the_hands_to_the_rest(found) -> None:
    ids = [each["id"] for each in found["focus"]]
    way = ["help", "language", "theme", "start", "fingerboard", "bow"]
    assert [each for each in ids if each in way] == way
    assert ids[:4] == way[:4]


def test_what_has_the_focus_is_seen_to_have_it(found) -> None:
    assert {each["ring"] for each in found["focus"]} == {"solid"}


def test_all_notes_are_there_beside_a_panel_on_a_laptop(found) -> None:
    assert found["beside"] == {"more": True, "shift": False}


def test_load_and_latency_are_told_where_they_are_high(found) -> None:
    assert found["status"] == ["", "load 85 % · latency 12 ms"]


def test_the_diagram_places_the_bow_until_it_is_let_go(found) -> None:
    *placed, end = found["placed"]
    assert [wish[:2] for wish in placed] == 2 * [
        ["WRITE", ROW["/bow/position"]],
        ["WRITE", ROW["/bow/force"]],
    ]
    (near, light, far, firm) = (value for _kind, _row, value, *_ in placed)
    assert 0.04 <= near < far <= 0.5
    assert 0.0 < light < firm <= 5.0
    assert end[0] == "RELEASE"


def test_the_tuner_measures_from_the_notes_of_the_tuning(found) -> None:
    note, cents = re.fullmatch(r"Tuner: (\S+), (-?\d+) cents", found["tuner"]).groups()
    assert note == "A4"
    assert abs(int(cents)) <= 5  # as far as the imitation is out of tune


def test_a_preset_writes_its_values(found) -> None:
    third = sorted(Presets().all()[0], key=lambda preset: preset.program or 0)[2]
    assert {row: value for _kind, row, value, *_ in found["preset"]} == {
        ROW[address]: value for address, value in third.values.items()
    }


def test_a_search_finds_parameters_by_their_words(found) -> None:
    assert {"/bow/speed", "/playing/speed"} <= set(found["search"])
    assert "/output/gain" not in found["search"]


def test_a_number_beyond_the_range_becomes_its_end(found) -> None:
    assert found["clamped"]["shown"] == "500"
    assert [wish[:3] for wish in found["clamped"]["wishes"]] == [
        ["WRITE", ROW["/playing/attack"], 500]
    ]


def test_a_parameter_returns_to_its_default(found) -> None:
    assert found["reset"]["shown"] == "40"
    assert [wish[:3] for wish in found["reset"]["wishes"]] == [
        ["WRITE", ROW["/playing/attack"], 40]
    ]


def test_a_tune_plays_and_stops_without_a_note_left(found) -> None:
    assert found["tune"] > 0
    assert found["tuneStopped"]["held"] == 0


def test_what_was_kept_is_played_again(found) -> None:
    def notes(wishes: list[list[Any]]) -> list[list[Any]]:
        return [wish[:4] for wish in wishes if wish[0] in ("BEGIN", "END")]

    assert len(notes(found["played"])) == 4
    assert notes(found["replayed"]) == notes(found["played"])
    *kept, end = (json.loads(line) for line in found["kept"])
    assert end["end"] > 0
    assert [line[2] for line in kept if line[2] in ("begin", "end")] == ["begin", "end"] * 2
    assert {line[1] for line in kept} == {1}  # the one player


def test_a_file_that_is_no_performance_is_refused_in_words(found) -> None:
    assert found["wrong"] == "wrong.jsonl is no performance of this instrument."


def test_a_midi_keyboard_plays_and_leaves_no_note_when_it_is_pulled_out(found) -> None:
    assert [wish[0] for wish in found["midi"] if wish[0] in ("BEGIN", "END")] == ["BEGIN", "END"]
    assert found["inputs"] == ["All that are connected"]


def test_a_tune_that_is_played_along_waits_for_its_notes(found) -> None:
    at_first, after_a_wrong_note, after_the_right_one = found["along"]
    assert at_first == after_a_wrong_note == 0.0
    assert after_the_right_one > 0.0


def test_a_button_that_stops_says_so_to_screen_readers(found) -> None:
    assert found["listening"] == "Listen: Shi Bei Jiu"
    assert found["stopping"] == "Stop: Shi Bei Jiu"


def test_escape_ends_what_plays(found) -> None:
    assert found["alongEnded"]


def test_the_theme_is_remembered(found) -> None:
    assert found["theme"] == found["language"]["theme"] == "dark"


def test_the_page_speaks_chinese(found) -> None:
    assert found["language"]["lang"] == "zh-Hans"
    assert found["language"]["start"] == "静音"  # it goes on sounding
    assert found["language"]["bare"] == []
