"""The page shows the sound that it has, whoever has set it, and gives back what was borrowed."""

from typing import Any

import pytest
from live.page.browser import drive

OWN = ["Vibrato", "Chamber", "0"]


@pytest.fixture(scope="module")
def found(imitated) -> Any:
    """What is shown as chosen: of sounds, of rooms, of articulations."""
    return drive("page_presets.mjs", imitated)


def test_the_preset_that_is_shown_is_the_one_that_the_parameters_are(found) -> None:
    assert found["first"] == OWN
    assert found["moved"] == ["Vibrato, changed", "Chamber", "0"]


def test_a_reset_of_all_is_shown_and_can_be_undone(found) -> None:
    assert found["reset"] == ["Undo the reset", "Ordinary", "Chamber", "0"]
    assert found["undone"] == ["Reset all", "Vibrato, changed", "Chamber", "0"]


def test_the_sound_room_and_articulation_that_were_chosen_are_there_again(found) -> None:
    assert found["again"] == ["Sul tasto", "Hall", "3"]
    assert found["played"] == found["again"]  # though a key's velocity moves the bow's pressure


def test_on_a_phone_loudness_and_vibrato_have_names_and_values(found) -> None:
    shown, cut_off = found["phone"]
    assert (shown, cut_off) == (2, 0)


def test_a_search_finds_names_first_and_escape_ends_it(found) -> None:
    first = [address for address in found["sought"] if address.startswith("/playing")]
    is_named = ["string" in address for address in first]
    assert is_named == sorted(is_named, reverse=True)
    assert {*is_named} == {True, False}
    assert found["escaped"] == ["", found["escaped"][2], found["escaped"][2]]


def test_the_sound_of_a_link_is_shown_while_it_plays_and_then_ones_own_is_back(found) -> None:
    assert found["before"] == found["after"] == OWN
    assert found["during"] == ["Sul tasto, changed", "Hall", "5"]
    assert found["sounding"] == []  # that is otherwise than it shows
