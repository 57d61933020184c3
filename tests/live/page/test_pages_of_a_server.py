"""Browsers with pages of a server: they play it, hear it, play here, together, and survive it."""

from typing import Any

import pytest
from live.page.browser import drive, in_browser
from live.page.serving import HOST, ONE, free_port, serving, start, stop
from waiting import until

pytestmark = in_browser
slow = pytest.mark.slow  # they hear a server in real time

PRESSURE, BOW_POSITION, ROOM_SIZE = "/playing/pressure", "/playing/bow_position", "/room/size"
VIBRATO = "/playing/vibrato"


class Stage:
    """A server that may end and come back, and what it does at each step of a scenario."""

    def __init__(self) -> None:
        self.port = free_port()
        self.server = start(port=self.port)

    def reach(self, step: str) -> None:
        player = self.server.player
        if step == "before":
            player.set(VIBRATO, 33.0, frame=player.frame_of())
        elif step in ("holds", "plays here", "holds again"):
            until(lambda: player.pitch is not None, step)
        elif step in ("let go", "let go here"):
            until(lambda: player.pitch is None, step)
        elif step == "watches":
            player.set(PRESSURE, 0.62, frame=player.frame_of())
        elif step == "listens":
            player.key_on(69.0, 100.0, frame=player.frame_of())
        elif step == "has listened":
            player.panic(frame=player.frame_of())
            until(lambda: player.pitch is None, step)
        elif step == "stop the server":
            stop(self.server)
        elif step == "start the server":
            self.server = start(port=self.port)


@slow
def test_a_page_plays_a_server_there_listens_plays_here_and_outlives_it() -> None:
    stage = Stage()
    try:
        found = drive("page_connected.mjs", f"http://{HOST}:{stage.port}/", reach=stage.reach)
    finally:
        stop(stage.server)
    assert found["first"] == "way-listen"  # as the server has no device, if nobody chose
    # Start, pressed while the line is made, begins what the server offers.
    assert found["early"]["before"] == "Starting …"
    assert "heard here" in found["early"]["after"]
    assert found["early"]["begun"] == 1
    assert found["there"] == "on"
    assert found["lack"].count("choose Here under Connect") == 2  # to record, and to keep
    assert found["shown"] == "0.62"  # which others set
    assert "heard here" in found["panel"]
    assert found["listening"] == "on"
    assert found["isSteady"]  # no more gaps once enough of the sound waits
    assert found["listensWithoutModule"]


@slow
def test_what_one_page_plays_sounds_in_another_and_at_the_server_until_it_is_let_go() -> None:
    held: dict[str, float] = {}
    with serving() as (server, url):

        def reach(step: str) -> None:
            if step.startswith("holds"):
                held[step] = until(lambda: server.player.pitch, step)
            elif step.startswith("let go"):  # or the page is closed
                until(lambda: server.player.pitch is None, step)

        found = drive("page_together.mjs", url, reach=reach)
    assert found["notes"] == [["B4", "B4"], ["E5", "E5"]]
    expected = {"holds 71": 71.0, "holds 76": 76.0, "holds 69": 69.0}
    assert held == pytest.approx(expected, abs=0.1)  # it varies from note to note


@slow
def test_a_page_that_sounds_here_takes_over_what_the_server_sounds_like_and_changes_nothing():
    # What others set before each time that the page chooses where to sound.
    others = {"at first": 0.18, "there": 0.15, "again": 0.16, "after a reload": 0.11}
    values: dict[str, float] = {}
    with serving() as (server, url):
        player = server.player

        def reach(step: str) -> None:
            what, _, when = step.partition(" ")
            if what == "before":
                player.set(BOW_POSITION, others[when], frame=player.frame_of())
                until(lambda: abs(player.value(BOW_POSITION) - others[when]) < 1e-6, step)
                return
            if what in ("plays", "played"):
                until(lambda: (player.pitch is None) == (what == "played"), step)
            values[step] = player.value(BOW_POSITION)

        found = drive("page_here.mjs", url, reach=reach)
    for when, value in others.items():
        assert float(found[when]) == value
        kept = [is_now for step, is_now in values.items() if step.endswith(when)]
        assert kept == pytest.approx([value] * 3), when


@slow
def test_the_page_of_a_guest_asks_once_for_the_pin_and_offers_what_a_guest_may_do() -> None:
    with serving() as (_, url):
        found = drive("page_guests.mjs", url)
    assert "PIN" in found["question"]
    assert found["asked"] == ["?part=1", "?pin=123456&part=1"]
    assert not found["formIsShown"]
    assert not found["cards"]
    assert not found["reset"]
    assert "guest who plays" in found["status"]


@pytest.fixture(scope="module")
def of_three() -> tuple[Any, dict[str, list[int]]]:
    """What pages of a server of three parts found, and the parts that played at each step."""
    holding: dict[str, list[int]] = {}
    with serving(3 * ONE) as (server, url):

        def playing() -> list[int]:
            players = enumerate(server.players, 1)
            return [part for part, player in players if player.pitch is not None]

        def reach(step: str) -> None:
            if step.startswith("holds"):
                holding[step] = until(playing, step)
            elif step == "let go":
                until(lambda: not playing(), step)
            elif step == "the room is larger":
                until(lambda: server.players[0].value(ROOM_SIZE) == 40.0, step)

        found = drive("page_parts.mjs", url, reach=reach)
    return found, holding


def test_a_finger_plays_the_part_of_its_page_alone_and_the_room_is_one_for_all(of_three) -> None:
    found, holding = of_three
    assert holding == {f"holds in {part}": [part] for part in (2, 3, 1)}
    assert "The room is one for all parts." in found["about"]
