"""The page sounds loud and soft as it is touched, sleeps at rest, and plays without a network."""

import gzip
from typing import Any

import pytest
from live.page.browser import drive

pytestmark = pytest.mark.slow

RANGE_DB = 18.0
MAX_BYTES = 350_000


@pytest.fixture(scope="module")
def found(sounding) -> Any:
    return drive("page_expression.mjs", sounding)


def test_a_note_is_as_loud_as_it_is_touched(found) -> None:
    assert set(found["dynamics"]) == {"touch", "mouse", "pen"}
    for way in found["dynamics"].values():
        for levels in way.values():
            assert levels == sorted(levels)
            assert levels[-1] - levels[0] >= RANGE_DB


def test_at_rest_nothing_is_drawn_nor_computed_and_a_key_wakes_it(found) -> None:
    assert found["drawnAtRest"] == 0
    assert found["state"] == "suspended"
    assert found["resting"] < 0.4 * found["playing"]
    assert found["awake"] > -40.0


def test_the_first_touch_is_heard_at_once(found) -> None:
    """What the instrument needs is held in ``player.test.mjs``, by its frames."""
    assert found["loaded"] == []
    assert found["firstMs"] < 1000.0  # 0.1 s on a free machine


def test_it_plays_without_a_network(found) -> None:
    assert found["offline"] > -40.0
    assert found["language"] == "椰胡"


def test_the_whole_page_is_small(written) -> None:
    files = [file for file in written.rglob("*") if file.is_file()]
    assert sum(len(gzip.compress(file.read_bytes())) for file in files) <= MAX_BYTES
