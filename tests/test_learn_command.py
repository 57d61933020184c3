"""``yehu-server learn`` and ``mappings show --live``, with a running server."""

from __future__ import annotations

import contextlib
import json
import socket
import threading
import time

import pytest

from yehu_server.audio.output import OutputOptions
from yehu_server.cli import main
from yehu_server.control.packets import pack
from yehu_server.playing.mapping import load
from yehu_server.server import ServeOptions, Server


@pytest.fixture
def server(config_home, tmp_path):
    del config_home
    output = OutputOptions(device="null", blocksize=128)
    options = ServeOptions(output=output, osc=("127.0.0.1", 0), midi=None, recordings=tmp_path)
    server = Server(options, lambda _line: None)
    server.start()
    yield server
    server.stop()


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


def test_what_is_moved_is_learned_and_told(server, at, capsys):
    with a_fader_that_moves(server):
        assert main(["learn", "/playing/vibrato", "/output/gain", *at]) == 0
    out = capsys.readouterr().out
    assert "move the control for /yehu/playing/vibrato" in out
    assert "/my/fader moves /yehu/output/gain, kept in" in out
    assert [bind.target for bind in load("mine/keyboard").of("/my/fader")] == ["/output/gain"]
    assert server.player.mapping == load("mine/keyboard")


def test_what_was_learned_is_forgotten(server, at, capsys):
    with a_fader_that_moves(server):
        main(["learn", "--soft", "/playing/vibrato", *at])
    assert load("mine/keyboard").of("/my/fader")[0].is_soft
    assert main(["learn", "--forget", "/playing/vibrato", *at]) == 0
    assert "/playing/vibrato: 1 forgotten" in capsys.readouterr().out
    assert not load("mine/keyboard").of("/my/fader")


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["learn", "/playing/vibrat"], "did you mean /playing/vibrato?"),
        (["learn", "/bow/speed"], "/bow/speed is moved by the player"),
        (["learn"], "name the parameters to learn"),
        (["mappings", "show", "--live", "wind"], "name none"),
    ],
)
def test_what_cannot_be_learned_or_shown_is_told(server, at, capsys, words, reason):
    assert main([*words, *at]) == 2
    err = capsys.readouterr().err
    assert reason in err
    assert err.count("\n") == 1
    assert not server.player.listens


def test_the_bindings_of_a_server_are_shown_with_where_they_are(server, at, capsys):
    server.player.note_on(70.0, 127.0, frame=server.player.frame_of())
    assert main(["mappings", "show", "--live", "--json", *at]) == 0
    rows = {row["source"]: row for row in json.loads(capsys.readouterr().out)}
    assert rows["velocity"]["place"] == 1.0
    assert rows["cc 1"]["target"] == "/yehu/playing/speed"
    assert main(["mappings", "show", "--live", *at]) == 0
    out = capsys.readouterr().out
    assert "100 %" in out
    assert "/playing/portamento_time" in out


@pytest.mark.parametrize("words", [["learn", "/playing/vibrato"], ["mappings", "show", "--live"]])
def test_a_server_that_does_not_answer_is_told_of(capsys, words):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    began = time.monotonic()
    assert main([*words, "--server", f"127.0.0.1:{port}"]) == 2
    assert time.monotonic() - began < 5.0
    assert "no server answers" in capsys.readouterr().err


def test_a_server_of_no_name_is_told_of(capsys):
    assert main(["learn", "/playing/vibrato", "--server", "127.0.0.1:x"]) == 2
    assert "expected HOST:PORT" in capsys.readouterr().err
