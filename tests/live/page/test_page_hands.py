"""Hands on the page ask for the notes and strokes that they play, and leave none behind."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing, served

from yehu_server.params.table import TABLE

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))

TEN = [67.0 + 2 * finger for finger in range(10)]
QUANTITIES = 1e-6
DYNAMICS = next(row for row, one in enumerate(TABLE) if one.address == "/playing/dynamics")


@pytest.fixture(scope="module")
def played(tmp_path_factory) -> Any:
    """What was wished while the page was played, by what was done."""
    generated = tmp_path_factory.mktemp("generated")
    with served(generated) as url:
        return drive("page_hands.mjs", url)


def of_kind(wishes: list[list[Any]], *kinds: str) -> list[list[Any]]:
    return [wish for wish in wishes if wish[0] in kinds]


def pitches(wishes: list[list[Any]]) -> list[float]:
    """The pitches at which notes begin."""
    return [other for _kind, _index, _value, other, _frame in of_kind(wishes, "BEGIN")]


def slides(wishes: list[list[Any]]) -> list[float]:
    return [value for _kind, _index, value, _other, _frame in of_kind(wishes, "SLIDE")]


def test_ten_fingers_begin_ten_notes(played) -> None:
    assert played["tenDown"]["held"] == 10
    assert pitches(played["tenDown"]["wishes"]) == TEN


def test_ten_fingers_that_go_leave_no_note(played) -> None:
    assert played["tenUp"]["held"] == 0
    assert len(of_kind(played["tenUp"]["wishes"], "END")) == 10


def test_ten_fingers_that_are_cancelled_leave_no_note(played) -> None:
    begun, ended = (of_kind(played["cancelled"]["wishes"], kind) for kind in ("BEGIN", "END"))
    assert len(begun) == len(ended) == 10
    assert played["cancelled"]["held"] == 0


def test_leaving_the_window_ends_all_notes(played) -> None:
    assert played["left"]["held"] == 0


def test_hiding_the_page_ends_all_notes(played) -> None:
    assert played["hidden"]["held"] == 0


def test_ten_fingers_that_go_at_once_leave_no_note(played) -> None:
    assert played["atOnce"]["held"] == 0


def test_a_finger_lands_in_tune_and_slides_to_where_it_goes(played) -> None:
    assert pitches(played["slid"]) == [69.0]
    way = slides(played["slid"])
    assert way == sorted(way)
    assert way[-1] == pytest.approx(71.2, abs=0.05)  # it touched at 69.2 and went two semitones


def test_a_finger_is_louder_across_the_string_until_it_goes(played) -> None:
    dynamics = [wish[2] for wish in of_kind(played["swelled"], "WRITE") if wish[1] == DYNAMICS]
    loud, soft, usual = dynamics
    assert 0.2 < soft < 0.3
    assert loud == usual == 1.0


def test_the_bow_is_drawn_as_fast_as_the_finger_and_in_its_direction(played) -> None:
    for name, direction in (("drawnForth", 1.0), ("drawnBack", -1.0)):
        speeds = [direction * wish[2] for wish in of_kind(played[name], "DRAW")]
        assert max(speeds) > 0.05
        assert sum(speeds) > 0.0
        assert all(abs(speed) <= 1.0 for speed in speeds)


def test_a_finger_only_stops_the_string_while_the_bow_is_drawn_by_hand(played) -> None:
    assert not pitches(played["drawnForth"])
    assert slides(played["drawnForth"]) == pytest.approx([74.0], abs=QUANTITIES)


def test_a_bow_that_rests_on_the_string_stands_still(played) -> None:
    # A slow browser notices it while the finger still comes back.
    drawn = of_kind([*played["drawnBack"], *played["rested"]], "DRAW")
    assert drawn[-1][2] == 0.0


def test_the_bow_leaves_the_string_with_the_finger(played) -> None:
    assert of_kind(played["lifted"]["wishes"], "LIFT", "DRAW")[-1][0] == "LIFT"
    assert played["lifted"]["held"] == 0


def test_without_assist_a_finger_only_stops_the_string(played) -> None:
    assert not pitches(played["withoutAssist"])
    # It stops E5, and leaves the C string open.
    assert slides(played["withoutAssist"]) == pytest.approx([76.0, 72.0], abs=QUANTITIES)


def test_without_assist_the_bow_is_heavier_towards_the_coconut(played) -> None:
    light, firm = (of_kind(played[name], "DRAW")[0][3] for name in ("light", "firm"))
    assert 0.0 < light < 0.3
    assert firm > 2.0


def test_two_rows_of_keys_are_a_piano(played) -> None:
    wishes = played["keys"]["wishes"]
    assert pitches(wishes) == [65.0, 71.0, 77.0]
    assert len(of_kind(wishes, "END")) == 3
    assert played["keys"]["held"] == 0


def test_leaving_the_window_lifts_all_keys(played) -> None:
    assert played["keysLeft"]["held"] == 0


def test_the_octave_key_moves_the_piano(played) -> None:
    assert pitches(played["octave"]) == [77.0]


def test_arrow_keys_move_a_finger_that_space_plays(played) -> None:
    assert pitches(played["arrows"]) == [70.0]
    assert of_kind(played["arrows"], "END")


def test_arrow_keys_draw_the_bow(played) -> None:
    drawn, lifted = of_kind(played["bowKeys"], "DRAW", "LIFT")
    assert drawn[2] == -0.2
    assert lifted[0] == "LIFT"


def test_writing_in_a_field_plays_nothing(played) -> None:
    assert not of_kind(played["writing"], "BEGIN")


def test_nothing_goes_wrong_while_it_is_played(played) -> None:
    assert played["errors"] == []
