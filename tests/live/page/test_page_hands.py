"""Hands on the page ask for the notes and strokes that they play, and leave none behind."""

from typing import Any

import pytest
from live.page.browser import drive

from yehu_server.params.table import TABLE

QUANTITIES = 1e-6
DYNAMICS = next(row for row, one in enumerate(TABLE) if one.address == "/playing/dynamics")


@pytest.fixture(scope="module")
def played(imitated) -> Any:
    """What was requested while the page was played, by what was done."""
    return drive("page_hands.mjs", imitated)


def of_kind(commands: list[list[Any]], *kinds: str) -> list[list[Any]]:
    return [command for command in commands if command[0] in kinds]


def pitches(commands: list[list[Any]]) -> list[float]:
    """The pitches at which notes begin."""
    return [other for _kind, _index, _value, other, _frame in of_kind(commands, "BEGIN")]


def slides(commands: list[list[Any]]) -> list[float]:
    return [value for _kind, _index, value, _other, _frame in of_kind(commands, "SLIDE")]


def test_ten_fingers_begin_ten_notes_and_leave_none_however_they_go(played) -> None:
    assert played["tenDown"]["held"] == 10
    assert pitches(played["tenDown"]["commands"]) == [67.0 + 2 * finger for finger in range(10)]
    assert len(of_kind(played["tenUp"]["commands"], "END")) == 10
    begun, ended = (of_kind(played["cancelled"]["commands"], kind) for kind in ("BEGIN", "END"))
    assert len(begun) == len(ended) == 10
    ways = ("tenUp", "atOnce", "cancelled", "left", "hidden")
    assert {way: played[way]["held"] for way in ways} == dict.fromkeys(ways, 0)


def test_a_finger_lands_in_tune_slides_and_is_louder_across_the_string(played) -> None:
    assert pitches(played["slid"]) == [69.0]
    way = slides(played["slid"])
    assert way == sorted(way)
    assert way[-1] == pytest.approx(71.2, abs=0.05)  # it touched at 69.2 and went two semitones
    dynamics = [
        command[2] for command in of_kind(played["swelled"], "WRITE") if command[1] == DYNAMICS
    ]
    loud, soft, usual = dynamics
    assert 0.2 < soft < 0.3
    assert loud == usual == 1.0  # until it goes


def test_the_bow_is_drawn_as_fast_as_the_finger_until_it_rests_or_leaves(played) -> None:
    for name, direction in (("drawnForth", 1.0), ("drawnBack", -1.0)):
        speeds = [direction * command[2] for command in of_kind(played[name], "DRAW")]
        assert max(speeds) > 0.05
        assert sum(speeds) > 0.0
        assert all(abs(speed) <= 1.0 for speed in speeds)
    # A slow browser notices that it rests while the finger still comes back.
    drawn = of_kind([*played["drawnBack"], *played["rested"]], "DRAW")
    assert drawn[-1][2] == 0.0
    assert of_kind(played["lifted"]["commands"], "LIFT", "DRAW")[-1][0] == "LIFT"
    assert played["lifted"]["held"] == 0


def test_a_finger_only_stops_the_string_that_is_bowed_by_hand_or_without_assist(played) -> None:
    assert not pitches(played["drawnForth"])
    assert slides(played["drawnForth"]) == pytest.approx([74.0], abs=QUANTITIES)
    assert not pitches(played["withoutAssist"])
    # It stops E5, and leaves the C string open.
    assert slides(played["withoutAssist"]) == pytest.approx([76.0, 72.0], abs=QUANTITIES)


def test_two_rows_of_keys_are_a_piano_that_another_key_moves_an_octave(played) -> None:
    commands = played["keys"]["commands"]
    assert pitches(commands) == [65.0, 71.0, 77.0]
    assert len(of_kind(commands, "END")) == 3
    assert played["keys"]["held"] == 0
    assert pitches(played["octave"]) == [77.0]
    assert played["keysLeft"]["held"] == 0  # leaving the window lifts all keys
    assert not of_kind(played["writing"], "BEGIN")  # in a field they write


def test_arrow_keys_move_a_finger_that_space_plays_and_draw_the_bow(played) -> None:
    assert pitches(played["arrows"]) == [70.0]
    assert of_kind(played["arrows"], "END")
    drawn, lifted = of_kind(played["bowKeys"], "DRAW", "LIFT")
    assert drawn[2] == -0.2
    assert lifted[0] == "LIFT"


def test_keys_play_wherever_the_focus_is_unless_text_is_typed(imitated) -> None:
    found = drive("page_keys.mjs", imitated)
    assert found["count"] > 100
    silent = [text for text in found["silent"] if 'type="search"' not in text]
    assert [text for text in silent if 'type="number"' not in text] == []
    assert [text for text in found["written"] if 'type="search"' not in text] == []
    assert found["left"] == [True, True]
    assert found["chosen"] == ["1", True, True]
    assert found["errors"] == []
