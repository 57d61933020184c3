"""A browser with the page of a server: it plays there, hears it, plays here, and survives it."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing
from live.page.serving import HOST, free_port, start, stop, until

pytestmark = [
    pytest.mark.slow,  # it hears a server in real time
    pytest.mark.skipif(missing() is not None, reason=str(missing())),
]

PRESSURE = "/playing/pressure"


class Stage:
    """The server, and what it does at each step of the scenario."""

    def __init__(self, port: int) -> None:
        self.port = port
        self.server = start(port)
        self.found: dict[str, bool] = {}

    def reach(self, step: str) -> None:
        player = self.server.player
        if step in ("holds", "plays here", "holds again"):
            self.found[step] = until(lambda: player.pitch is not None)
        elif step in ("let go", "let go here"):
            self.found[step] = until(lambda: player.pitch is None)
        elif step == "watches":
            player.write(PRESSURE, 0.62, frame=player.frame_of())
        elif step == "listens":
            player.note_on(69.0, 100.0, frame=player.frame_of())
        elif step == "has listened":
            player.panic(frame=player.frame_of())
            until(lambda: player.pitch is None)
        elif step == "stop the server":
            stop(self.server)
        elif step == "start the server":
            self.server = start(self.port)


@pytest.fixture(scope="module")
def seen() -> tuple[dict[str, Any], dict[str, bool]]:
    """What the page found, and what the server found at each step."""
    port = free_port()
    stage = Stage(port)
    found = drive("page_connected.mjs", f"http://{HOST}:{port}/", reach=stage.reach)
    stop(stage.server)
    return found, stage.found


def test_a_page_hears_a_server_without_a_device_if_nobody_chose(seen) -> None:
    assert seen[0]["first"] == "way-listen"


def test_start_pressed_while_the_line_is_made_begins_what_the_server_offers(seen) -> None:
    assert seen[0]["early"]["before"] == "Starting …"
    assert "heard here" in seen[0]["early"]["after"]
    assert seen[0]["early"]["begun"] == 1


def test_there_a_finger_plays_the_server(seen) -> None:
    page, server = seen
    assert server["holds"]
    assert server["let go"]
    assert page["there"] == "on"


def test_there_the_page_shows_what_others_set(seen) -> None:
    assert seen[0]["shown"] == "0.62"


def test_listening_the_page_has_the_sound_and_no_more_gaps_once_enough_of_it_waits(seen) -> None:
    assert "heard here" in seen[0]["panel"]
    assert seen[0]["listening"] == "on"
    assert seen[0]["isSteady"]


def test_a_page_that_cannot_be_played_listens_and_sees(seen) -> None:
    assert seen[0]["listensWithoutModule"]


def test_here_the_page_sounds_and_the_server_plays_along(seen) -> None:
    _, server = seen
    assert server["plays here"]
    assert server["let go here"]


def test_a_server_that_comes_back_is_played_again(seen) -> None:
    assert seen[1]["holds again"]


def test_nothing_goes_wrong_on_the_page(seen) -> None:
    assert seen[0]["errors"] == []
