"""OSCQuery's tree changes as presets are saved and sources are learned."""

import pytest
from web_client import WebSocket, ask

from yehu_server.live.web.server import WebOptions


@pytest.fixture
def live(config_home, make_live):
    del config_home
    return make_live(http=WebOptions(("127.0.0.1", 0)))


@pytest.fixture
def web(live):
    web = WebSocket(live.server.web.port)
    yield web
    web.close()


def changed(web: WebSocket) -> str:
    """The path of the next change."""
    while (heard := web.next()) is not None:
        if isinstance(heard, dict) and heard["COMMAND"] == "PATH_CHANGED":
            return heard["DATA"]
    raise AssertionError("no PATH_CHANGED came")


def test_a_learned_address_is_in_the_tree_and_the_change_is_sent(live, web):
    port = live.server.web.port
    assert ask(port, "/my/fader").status == 404
    web.message("/yehu/learn", "/playing/vibrato")
    for place in (0.0, 0.5):
        web.message("/my/fader", place)
    assert changed(web) == "/"
    node = ask(port, "/my/fader").json
    assert (node["ACCESS"], node["TYPE"]) == (2, "f")
    assert node["RANGE"] == [{"MIN": 0.0, "MAX": 1.0}]
    web.message("/yehu/unlearn", "/playing/vibrato")
    assert changed(web) == "/"
    assert ask(port, "/my/fader").status == 404


def test_a_preset_that_is_kept_or_removed_changes_the_choice(live, web):
    port = live.server.web.port

    def choice() -> list[str]:
        return ask(port, "/yehu/preset/load?RANGE").json["RANGE"][0]["VALS"]

    before = choice()
    web.message("/yehu/preset/save", "mine")
    assert changed(web) == "/yehu/preset"
    assert set(choice()) == {*before, "mine"}
    web.message("/yehu/preset/delete", "mine")
    assert changed(web) == "/yehu/preset"
    assert choice() == before
