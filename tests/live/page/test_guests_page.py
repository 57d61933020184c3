"""The page of a guest asks for the PIN, and offers what a guest may do."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing
from live.page.serving import HOST, free_port, start, stop

pytestmark = [
    pytest.mark.slow,  # it starts a browser
    pytest.mark.skipif(missing() is not None, reason=str(missing())),
]


@pytest.fixture(scope="module")
def seen() -> dict[str, Any]:
    """What the page found."""
    port = free_port()
    server = start(port)
    found = drive("page_guests.mjs", f"http://{HOST}:{port}/")
    stop(server)
    return found


def test_without_a_pin_it_asks_for_one(seen) -> None:
    assert "PIN" in seen["question"]
    assert seen["asked"][0] == "?part=1"


def test_the_pin_goes_along(seen) -> None:
    assert seen["asked"][-1] == "?pin=123456&part=1"
    assert not seen["formIsShown"]


def test_it_does_not_ask_again_with_a_pin_that_was_refused(seen) -> None:
    assert len(seen["asked"]) == 2


def test_a_player_is_not_offered_what_the_owner_may_do(seen) -> None:
    assert not seen["cards"]
    assert not seen["reset"]
    assert "guest who plays" in seen["told"]
    assert seen["errors"] == []
