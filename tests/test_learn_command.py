"""``yehu-server learn`` and ``mappings show --live``, with a running server."""

import contextlib
import json
import socket
import threading

import pytest
from waiting import until

from yehu_server.cli import main
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.options import PartOptions, ServeOptions
from yehu_server.live.osc.packets import pack
from yehu_server.live.server import Server
from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions

PLAIN, WIND = (PartOptions(PlayingOptions(mapping=load(name))) for name in ("keyboard", "wind"))


@contextlib.contextmanager
def served(folder, parts):
    output = OutputOptions(device="null", blocksize=128)
    how = {"osc": ("127.0.0.1", 0), "midi": None, "recordings": folder, "parts": parts}
    server = Server(ServeOptions(output=output, **how), lambda _line: None)
    server.start()
    yield server
    server.stop()


@pytest.fixture
def server(config_home, tmp_path):
    del config_home
    with served(tmp_path, [PLAIN]) as server:
        yield server


@pytest.fixture
def duo(config_home, tmp_path):
    """A server of two players, each with a mapping of their own."""
    del config_home
    with served(tmp_path, [PLAIN, WIND]) as server:
        yield server


@pytest.fixture
def at(server) -> tuple[str, str]:
    return "--server", f"127.0.0.1:{server.osc.port}"


@contextlib.contextmanager
def a_fader_that_moves(server, address: str = "/my/fader"):
    """Move a fader up and down within the block."""
    ending = threading.Event()

    def move() -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as hand:
            place = 0.0
            while not ending.wait(0.02):
                place = (place + 0.1) % 1.0
                hand.sendto(pack(address, place), ("127.0.0.1", server.osc.port))

    thread = threading.Thread(target=move)
    thread.start()
    try:
        yield
    finally:
        ending.set()
        thread.join()


def test_what_is_moved_is_learned_and_reported(server, at, capsys):
    with a_fader_that_moves(server, "/one"), a_fader_that_moves(server, "/two"):
        assert main(["learn", "/playing/vibrato", "/output/gain", *at]) == 0
    out = capsys.readouterr().out
    assert "move the control for /playing/vibrato" in out
    assert "  cc 77 still moves it, too" in out
    first, second = ("/one", "/two") if "/one added: /playing/vibrato" in out else ("/two", "/one")
    for source, target in ((first, "/playing/vibrato"), (second, "/output/gain")):
        assert f"{source} added: {target}, saved in" in out
        assert [bind.target for bind in load("mine/keyboard").of(source)] == [target]
    assert server.player.mapping == load("mine/keyboard")


def test_what_was_learned_is_forgotten(server, at, capsys):
    with a_fader_that_moves(server):
        main(["learn", "--soft", "--only", "vibrato", *at])
    assert "cc 77 moves /playing/vibrato no longer, until --forget" in capsys.readouterr().out
    assert load("mine/keyboard").of("/my/fader")[0].is_soft
    assert main(["learn", "--forget", "/playing/vibrato", *at]) == 0
    assert "/playing/vibrato: 1 forgotten" in capsys.readouterr().out
    assert server.player.mapping == load("keyboard", user_first=True) == load("keyboard")


def test_what_a_part_moves_is_learned_by_its_mapping_alone(duo, capsys):
    at = ("--server", f"127.0.0.1:{duo.osc.port}")
    with a_fader_that_moves(duo):
        assert main(["learn", "--part", "2", "/playing/vibrato", *at]) == 0
    assert "/my/fader added: /part/2/playing/vibrato" in capsys.readouterr().out
    first, second = (player.mapping for player in duo.players)
    assert [bind.target for bind in second.of("/my/fader")] == ["/playing/vibrato"]
    assert not first.of("/my/fader")
    assert load("mine/wind") == second
    assert main(["learn", "--part", "2", "--forget", "/playing/vibrato", *at]) == 0
    assert "/playing/vibrato: 1 forgotten" in capsys.readouterr().out


def test_what_cannot_be_learned_or_shown_is_reported(duo, refused):
    for words, reason in (
        ("learn --part 3 /playing/vibrato", "no part 3: there are parts 1 to 2"),
        ("learn --part 2 /room/size", "/room/size is one for all parts"),
        ("learn --part 0 /playing/vibrato", "0 is not 1 or more"),
        ("learn /playing/vibrat", "did you mean /playing/vibrato?"),
        ("learn /bow/speed", "/bow/speed is moved by the player"),
        ("learn", "name the parameters to learn"),
        ("mappings show --live wind", "name none"),
    ):
        at = ("--server", f"127.0.0.1:{duo.osc.port}")
        assert reason in refused(*words.split(), *at)
    assert not any(player.learning.waits for player in duo.players)


def test_what_is_replaced_by_another_ends_and_leaves_that_one(server, at, command):
    def begin_another() -> None:
        until(lambda: server.player.learning.waits)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as hand:
            packet = pack("/yehu/learn", "/output/gain")
            hand.sendto(packet, ("127.0.0.1", server.osc.port))

    other = threading.Thread(target=begin_another)
    other.start()
    status, _, error = command("learn", "vibrato", *at)
    assert status == 2
    assert "something else is learned now" in error
    other.join()
    assert server.player.learning.waits


def test_the_end_of_input_ends_the_questions(monkeypatch, capsys):
    def end(_question: str) -> str:
        raise EOFError  # Ctrl-D

    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("builtins.input", end)
    assert main(["learn"]) == 0
    assert capsys.readouterr().err == ""


def test_the_bindings_of_a_server_are_shown_with_where_they_are(server, at, capsys):
    server.player.key_on(70.0, 127.0, frame=server.player.frame_of())

    def shown() -> dict:
        assert main(["mappings", "show", "--live", "--json", *at]) == 0
        return {row["source"]: row for row in json.loads(capsys.readouterr().out)}

    until(lambda: shown()["velocity"]["place"] == 1.0)  # once it is struck
    rows = shown()
    assert rows["cc 16"]["target"] == "/yehu/playing/speed"
    assert main(["mappings", "show", "--live", *at]) == 0
    out = capsys.readouterr().out
    assert "100 %" in out
    assert "/playing/portamento_time" in out
