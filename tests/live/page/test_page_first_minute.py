"""A newcomer is shown three gestures, can send what was played as a link, and learns a tune."""

import re
from typing import Any

import pytest
from live.page.browser import drive

from yehu_server.params.table import TABLE

VIBRATO = next(row for row, one in enumerate(TABLE) if one.address == "/playing/vibrato")


@pytest.fixture(scope="module")
def found(imitated) -> Any:
    """What a newcomer saw and did."""
    return drive("page_first_minute.mjs", imitated)


def test_the_page_fits_every_size_and_the_instrument_stands_where_there_is_height(found) -> None:
    assert found["cut"] == {size: [] for size in found["cut"]}
    upright = {size: bool(count) for size, count in found["upright"].items()}
    assert upright == {
        "1920x1080": False, "820x1180": True, "390x844": True, "320x568": True, "844x390": False,
    }  # fmt: skip


def test_octave_dots_keep_clear_of_other_notes(found) -> None:
    assert found["touching"]["count"] > 15 + 8  # digits and dots
    assert found["touching"]["close"] == []


def test_the_invitation_goes_with_the_first_touch_and_each_gesture_is_noticed(found) -> None:
    assert found["invited"]
    assert not found["invitedStill"]
    slide, rock, bow, tone = (words for [words] in found["said"])
    for words, expected in (slide, "Slide"), (rock, "rock"), (bow, "bow"), (tone, "20 seconds"):
        assert expected in words
    assert found["pressed"] == "scratch"
    assert found["taught"] is True
    # A finger that rocks puts the player's vibrato to rest.
    at_first, rocking = (
        command[2] for command in found["rocked"] if command[:2] == ["WRITE", VIBRATO]
    )
    assert at_first > rocking == 0.0


def test_a_key_brings_help_and_takes_it_away(found) -> None:
    assert "Slide" in found["helped"][0]
    assert found["put"] == []


def test_a_link_can_be_heard_by_start_too_and_again_until_it_is_closed_and_the_guide_waits(found):
    link = found["link"]
    *offered, is_offered = link["offered"]
    listen = offered[0]
    assert listen.startswith("Listen (0:0")
    assert offered == [listen, "Stop", listen]
    assert not is_offered
    assert link["guided"] == [False, False]
    assert link["heldAfterStop"] == 0
    assert found["taken"]["offered"] == listen  # whoever plays meanwhile can still hear it


def test_what_is_kept_and_what_is_recorded_have_a_stop_and_a_time_each(found) -> None:
    kept, recorded = (re.sub(r"0:0\d", "0:0", row).split() for row in found["keeping"])
    assert kept[:3] == ["Stop", "keeping", "0:0"]
    assert recorded == ["Stop", "recording", "0:0"]


def test_what_a_link_leaves_out_is_said_above_the_strings(found):
    line = "Notes and gestures are played, without these settings of it: "
    assert found["leftOut"] == f"{line}Vibrato (How the player plays)"


def test_a_link_asks_for_what_was_played_until_one_touches_the_string(found) -> None:
    played, replayed = (
        [command for command in found[name] if command[0] in ("BEGIN", "END", "SLIDE")]
        for name in ("played", "replayed")
    )
    assert len(played) > 5
    assert [command[0] for command in played] == [command[0] for command in replayed]
    for one, other in zip(played, replayed, strict=True):
        assert other[1:4] == pytest.approx(one[1:4], abs=1e-4)
    late = [other[4] - one[4] for one, other in zip(played, replayed, strict=True)]
    assert max(late) - min(late) < 200  # frames, of 48000 a second
    assert found["heldAfter"] == 0
    assert found["link"]["length"] < 2000
    assert found["taken"]["held"] == 1  # the own finger
    assert found["let"] == 0


def test_a_newcomer_plays_an_easy_tune_after_few_actions_and_is_answered(imitated) -> None:
    found = drive("page_tunes.mjs", imitated)
    assert found["actions"] <= 12
    assert not found["covered"]  # the panel gives way to the instrument
    assert found["overlaps"] == {name: [] for name in found["overlaps"]}
    assert {
        name: room for name, room in found["boards"].items() if room < 0.35
    } == {}  # of the screen
    assert found["answered"] == "Lower: to 1"
    assert "41 of 42 notes at the first touch." in found["result"]
    assert found["again"]
    assert found["stopped"]
    assert found["heard"] > 0  # whoever listens sees the notes come
    assert found["goesOn"]
