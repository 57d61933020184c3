"""A page that sounds here takes over what the server sounds like, and changes nothing there."""

from __future__ import annotations

from typing import Any

import pytest
from live.page.browser import drive, missing
from live.page.serving import HOST, free_port, start, stop, until

pytestmark = [
    pytest.mark.slow,  # it plays a server in real time
    pytest.mark.skipif(missing() is not None, reason=str(missing())),
]

PLACE = "/playing/bow_position"
# What others set before each time that the page chooses where to sound.
SET = {"at first": 0.18, "there": 0.15, "again": 0.16, "after a reload": 0.11}


@pytest.fixture(scope="module")
def seen() -> tuple[dict[str, Any], dict[str, float]]:
    """What the page shows, and the server's values at each step."""
    port = free_port()
    server = start(port)
    player, values = server.player, {}

    def reach(step: str) -> None:
        what, _, when = step.partition(" ")
        if what == "before":
            player.write(PLACE, SET[when], frame=player.frame_of())
            assert until(lambda: abs(player.value(PLACE) - SET[when]) < 1e-6)
            return
        if what in ("plays", "played"):
            assert until(lambda: (player.pitch is None) == (what == "played"))
        values[step] = player.value(PLACE)

    found = drive("page_here.mjs", f"http://{HOST}:{port}/", reach=reach)
    stop(server)
    return found, values


@pytest.mark.parametrize("when", SET)
def test_the_server_keeps_its_sound(seen, when) -> None:
    values = {step: value for step, value in seen[1].items() if step.endswith(when)}
    assert values == dict.fromkeys(values, pytest.approx(SET[when]))
    assert len(values) == 3


@pytest.mark.parametrize("when", SET)
def test_the_page_takes_it_over(seen, when) -> None:
    assert float(seen[0][when]) == SET[when]


def test_nothing_goes_wrong_on_the_page(seen) -> None:
    assert seen[0]["errors"] == []
