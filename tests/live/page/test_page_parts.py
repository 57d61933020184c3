"""A browser with pages of a server of three parts."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing
from live.page.serving import HOST, free_port, start, stop, until

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))

PARTS = 3
LARGEST = 40.0  # m


@pytest.fixture(scope="module")
def seen() -> tuple[dict[str, Any], dict[str, Any]]:
    """What the pages found, and the parts that played at each step."""
    port = free_port()
    server = start(port, PARTS)
    told: dict[str, Any] = {}

    def playing() -> list[int]:
        players = enumerate(server.players, 1)
        return [part for part, player in players if player.pitch is not None]

    def reach(step: str) -> None:
        if step.startswith("holds"):
            assert until(playing)
            told[step] = playing()
        elif step == "let go":
            assert until(lambda: not playing())
        elif step == "the room is larger":
            told[step] = until(lambda: server.players[0].value("/room/size") == LARGEST)

    try:
        found = drive("page_parts.mjs", f"http://{HOST}:{port}/", reach=reach)
    finally:
        stop(server)
    return found, told


@pytest.mark.parametrize(("page", "part"), [("second", 2), ("third", 3), ("none", 1)])
def test_the_page_shows_its_part_and_offers_the_others(seen, page: str, part: int) -> None:
    shown = seen[0][page]
    assert shown["isThere"]
    assert shown["chosen"] == str(part)
    assert shown["options"] == [f"Part {one}/{PARTS}" for one in range(1, PARTS + 1)]
    assert shown["title"] == f"Yehu {part}"


def test_a_part_that_is_chosen_stands_in_the_address(seen) -> None:
    assert seen[0]["third"]["address"] == "?part=3"


@pytest.mark.parametrize("part", [1, 2, 3])
def test_a_finger_plays_the_part_of_its_page_and_no_other(seen, part: int) -> None:
    assert seen[1][f"holds in {part}"] == [part]


def test_the_room_is_set_for_all_from_any_part(seen) -> None:
    assert seen[1]["the room is larger"]
    assert "The room is one for all parts." in seen[0]["about"]


def test_there_is_room_for_the_choice_on_a_phone(seen) -> None:
    assert seen[0]["narrow"]["isThere"]
    assert seen[0]["narrow"]["over"] <= 0


def test_nothing_goes_wrong_on_the_page(seen) -> None:
    assert seen[0]["errors"] == []
