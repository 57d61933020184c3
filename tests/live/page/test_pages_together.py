"""Two pages that sound by themselves play together, and with their server."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing
from live.page.serving import HOST, free_port, start, stop, until

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(missing() is not None, reason=str(missing())),
]


@pytest.fixture(scope="module")
def seen() -> tuple[dict[str, Any], dict[str, Any]]:
    """What the pages found, and what the server played at each step."""
    port = free_port()
    server = start(port)
    told: dict[str, Any] = {}

    def reach(step: str) -> None:
        player = server.player
        if step.startswith("holds"):
            assert until(lambda: player.pitch is not None)
            told[step] = player.pitch
        elif step.startswith("let go"):
            told[step] = until(lambda: player.pitch is None)

    found = drive("page_together.mjs", f"http://{HOST}:{port}/", reach=reach)
    stop(server)
    return found, told


def test_what_one_page_plays_sounds_in_both(seen) -> None:
    assert seen[0]["notes"] == [["B4", "B4"], ["E5", "E5"]]


def test_the_server_plays_along(seen) -> None:
    held = {step: pitch for step, pitch in seen[1].items() if step.startswith("holds")}
    expected = {"holds 71": 71.0, "holds 76": 76.0, "holds 69": 69.0}
    assert held == pytest.approx(expected, abs=0.1)  # it varies from note to note


def test_a_note_ends_everywhere_when_it_is_let_go_and_when_its_page_is_closed(seen) -> None:
    assert [seen[1][f"let go {pitch}"] for pitch in (71, 76, 69)] == [True, True, True]


def test_nothing_goes_wrong_on_the_pages(seen) -> None:
    assert seen[0]["errors"] == []
