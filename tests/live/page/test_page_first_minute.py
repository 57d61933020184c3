"""A newcomer is shown three gestures, and can send what was played as a link."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing, served

from yehu_server.params.table import TABLE

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))

VIBRATO = next(row for row, one in enumerate(TABLE) if one.address == "/playing/vibrato")
NOTES = ("BEGIN", "END", "SLIDE")


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> Any:
    """What a newcomer saw and did."""
    with served(tmp_path_factory.mktemp("generated")) as url:
        return drive("page_first_minute.mjs", url)


def test_nothing_goes_wrong(found) -> None:
    assert found["errors"] == []


def test_nothing_is_cut_off_at_any_size(found) -> None:
    assert found["cut"] == {size: [] for size in found["cut"]}


def test_the_instrument_stands_where_there_is_height(found) -> None:
    upright = {size: bool(count) for size, count in found["upright"].items()}
    assert upright == {
        "1920x1080": False, "820x1180": True, "390x844": True, "320x568": True, "844x390": False,
    }  # fmt: skip


def test_the_invitation_goes_with_the_first_touch(found) -> None:
    assert found["invited"]
    assert not found["invitedStill"]


def test_each_gesture_is_noticed_when_it_is_done(found) -> None:
    slide, rock, bow, tone = (words for [words] in found["said"])
    for words, expected in (slide, "Slide"), (rock, "rock"), (bow, "bow"), (tone, "20 seconds"):
        assert expected in words
    assert found["pressed"] == "scratch"
    assert found["taught"] is True


def test_a_finger_that_rocks_puts_the_players_vibrato_to_rest(found) -> None:
    at_first, rocking = (wish[2] for wish in found["rocked"] if wish[:2] == ["WRITE", VIBRATO])
    assert at_first > rocking == 0.0


def test_a_key_brings_help_and_takes_it_away(found) -> None:
    assert "Slide" in found["helped"][0]
    assert found["put"] == []


def notes(wishes: list[list[Any]]) -> list[list[Any]]:
    return [wish for wish in wishes if wish[0] in NOTES]


def test_a_link_asks_for_what_was_played(found) -> None:
    played, replayed = notes(found["played"]), notes(found["replayed"])
    assert len(played) > 5
    assert [wish[0] for wish in played] == [wish[0] for wish in replayed]
    for one, other in zip(played, replayed, strict=True):
        assert other[1:4] == pytest.approx(one[1:4], abs=1e-4)
    late = [other[4] - one[4] for one, other in zip(played, replayed, strict=True)]
    assert max(late) - min(late) < 200  # frames, of 48000 a second
    assert found["heldAfter"] == 0


def test_a_link_is_short(found) -> None:
    assert len(found["link"]) < 2000


def test_whoever_touches_the_string_goes_on(found) -> None:
    assert found["taken"]["held"] == 1  # the own finger
    assert found["let"] == 0
