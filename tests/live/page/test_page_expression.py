"""The page sounds loud and soft as it is touched, sleeps at rest, and plays without a network."""

from __future__ import annotations

import gzip
from typing import Any

import pytest
from live.page.browser import drive, missing, running

from yehu_server.live.page.site import server_of, url_of, write_page

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(missing() is not None, reason=str(missing())),
]

RANGE_DB = 18.0
MOST_BYTES = 350_000


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The page, written as static files."""
    folder = tmp_path_factory.mktemp("page")
    write_page(folder)
    return folder


@pytest.fixture(scope="module")
def found(folder) -> Any:
    with running(server := server_of(folder, 0)):
        yield drive("page_expression.mjs", url_of(server))


def test_nothing_goes_wrong(found) -> None:
    assert found["errors"] == []


@pytest.mark.parametrize("way", ["touch", "mouse", "pen"])
def test_a_note_is_as_loud_as_it_is_touched(found, way: str) -> None:
    for levels in found["dynamics"][way].values():
        assert levels == sorted(levels)
        assert levels[-1] - levels[0] >= RANGE_DB


def test_at_rest_nothing_is_drawn_nor_computed(found) -> None:
    assert found["drawnAtRest"] == 0
    assert found["state"] == "suspended"
    assert found["resting"] < 0.4 * found["playing"]


def test_a_key_wakes_it(found) -> None:
    assert found["awake"] > -40.0


def test_the_first_touch_is_heard_at_once(found) -> None:
    """What the instrument needs is held in ``player.test.mjs``, by its frames."""
    assert found["loaded"] == []
    assert found["firstMs"] < 1000.0  # 0.1 s on a free machine


def test_it_plays_without_a_network(found) -> None:
    assert found["offline"] > -40.0
    assert found["language"] == "椰胡"


def test_the_whole_page_is_small(folder) -> None:
    files = [file for file in folder.rglob("*") if file.is_file()]
    assert sum(len(gzip.compress(file.read_bytes())) for file in files) <= MOST_BYTES
