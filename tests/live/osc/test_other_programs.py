"""OSC from and to other programs: liblo, Pure Data, python-osc."""

from __future__ import annotations

import shutil
import subprocess
import time
from pathlib import Path

import pytest
from pythonosc.osc_bundle_builder import OscBundleBuilder
from pythonosc.osc_message_builder import OscMessageBuilder
from pythonosc.osc_tcp_server import MODE_1_0, MODE_1_1
from pythonosc.tcp_client import SimpleTCPClient
from pythonosc.udp_client import SimpleUDPClient

LONGEST_S = 30.0

PD = shutil.which("pd") or shutil.which("puredata")
needs_liblo = pytest.mark.skipif(not shutil.which("oscsend"), reason="liblo's oscsend is not here")
needs_pd = pytest.mark.skipif(not PD, reason="Pure Data is not here")


# ---------------------------------------------------------------- liblo


def oscsend(live, kind: str, *words: str) -> None:
    url = f"osc.{kind}://127.0.0.1:{live.ports.port}"
    subprocess.run(["oscsend", url, *words], check=True, timeout=LONGEST_S)  # noqa: S607


@needs_liblo
@pytest.mark.parametrize("kind", ["udp", "tcp"])
def test_liblo_plays_a_note_and_ends_it(live, until, kind):
    oscsend(live, kind, "/yehu/playing/variation", "f", "0")
    oscsend(live, kind, "/yehu/note", "ff", "67", "90")
    until(lambda: live.player.pitch == 67.0, "the note")
    oscsend(live, kind, "/yehu/note", "if", "67", "0")
    until(lambda: live.player.pitch is None, "its end")
    until(lambda: live.ports.traffic.connections == 0, "the connections to be gone")
    assert live.is_well()


@needs_liblo
@pytest.mark.parametrize("kind", ["udp", "tcp"])
@pytest.mark.parametrize(
    ("address", "words", "value"),
    [
        ("/yehu/bow/force", ["f", "0.75"], 0.75),
        ("/yehu/bow/force", ["d", "0.75"], 0.75),
        ("/yehu/bow/force", ["i", "2"], 2.0),
        ("/yehu/bow/force", ["h", "3"], 3.0),
        ("/yehu/bow/force", ["T"], 1.0),
        ("/yehu/bow/force", ["F"], 0.0),
        ("/yehu/b?w/f*", ["f", "0.25"], 0.25),
    ],
)
def test_liblo_sets_a_parameter_with_any_type(shared_server, until, kind, address, words, value):
    before = shared_server.handler.counts.messages
    oscsend(shared_server, kind, address, *words)
    until(lambda: shared_server.handler.counts.messages > before, "the message")
    until(lambda: shared_server.player.value("/bow/force") == value, "the value")


@needs_liblo
@pytest.mark.parametrize("kind", ["udp", "tcp"])
@pytest.mark.parametrize(
    "words",
    [["s", "0.75"], ["N"], ["I"], ["c", "a"], ["m", "00903c40"], ["S", "loud"], ["cf", "a", "1"]],
)
def test_what_liblo_sends_of_a_wrong_type_changes_nothing(shared_server, until, kind, words):
    counts = shared_server.handler.counts
    before, refused = shared_server.player.values(), counts.errors + counts.malformed
    oscsend(shared_server, kind, "/yehu/bow/force", *words)
    until(lambda: counts.errors + counts.malformed == refused + 1, "the refusal")
    assert shared_server.player.values() == before
    assert shared_server.is_well()


# ---------------------------------------------------------------- Pure Data


def patch_of(*lines: str) -> str:
    return "\n".join(("#N canvas 0 0 450 300 10;", *lines, ""))


def pd(tmp_path: Path, patch: str) -> str:
    """Run a patch until it quits; return what it prints."""
    assert PD is not None
    file = tmp_path / "patch.pd"
    file.write_text(patch)
    ended = subprocess.run(
        [PD, "-nogui", "-noaudio", "-nomidi", "-stderr", "-noprefs", "-open", str(file)],
        capture_output=True,
        text=True,
        timeout=LONGEST_S,
        check=False,
        stdin=subprocess.DEVNULL,
    )
    return ended.stdout + ended.stderr


def speaking(port: int, address: str, arguments: str, ends_after_ms: int = 10_000) -> str:
    """A patch that connects, sends a message, prints what comes back, and then quits."""
    words = " ".join(address.strip("/").split("/"))
    return patch_of(
        "#X obj 10 10 loadbang;",  # 0
        f"#X msg 10 40 connect 127.0.0.1 {port};",  # 1
        "#X obj 150 40 delay 200;",  # 2
        f"#X msg 150 70 {arguments};",  # 3
        f"#X obj 150 100 oscformat {words};",  # 4
        "#X obj 150 130 list prepend send;",  # 5
        "#X obj 150 160 list trim;",  # 6
        "#X obj 10 200 netsend -u -b;",  # 7
        "#X obj 10 230 oscparse;",  # 8
        "#X obj 10 260 print heard;",  # 9
        f"#X obj 300 40 delay {ends_after_ms};",  # 10
        "#X msg 300 70 \\; pd quit;",  # 11
        "#X obj 150 230 t b;",  # 12
        "#X obj 150 260 delay 200;",  # 13
        "#X connect 0 0 1 0;",
        "#X connect 0 0 2 0;",
        "#X connect 0 0 10 0;",
        "#X connect 1 0 7 0;",
        "#X connect 2 0 3 0;",
        "#X connect 3 0 4 0;",
        "#X connect 4 0 5 0;",
        "#X connect 5 0 6 0;",
        "#X connect 6 0 7 0;",
        "#X connect 7 1 8 0;",
        "#X connect 8 0 9 0;",
        "#X connect 10 0 11 0;",
        "#X connect 8 0 12 0;",
        "#X connect 12 0 13 0;",
        "#X connect 13 0 11 0;",
    )


@needs_pd
def test_pure_data_plays_a_note(live, tmp_path):
    pd(tmp_path, speaking(live.ports.port, "/yehu/note", "67 90", 500))
    assert live.handler.counts.messages == 1
    live.settle()
    assert live.player.pitch == pytest.approx(67.0, abs=0.5)
    assert live.is_well()


@needs_pd
def test_pure_data_hears_the_value_it_has_set(live, tmp_path):
    printed = pd(tmp_path, speaking(live.ports.port, "/yehu/bow/force", "0.75"))
    assert live.player.value("/bow/force") == 0.75
    assert "heard: list yehu bow force 0.75" in printed or "heard: yehu bow force 0.75" in printed


@needs_pd
def test_pure_data_hears_all_values_when_it_subscribes(live, tmp_path):
    printed = pd(tmp_path, speaking(live.ports.port, "/yehu/subscribe", "10"))
    for line in ("yehu subscribed 10", "yehu bow force 0.5", "yehu finger 1 press 0"):
        assert line in printed


@needs_pd
def test_pure_data_reads_the_status(live, tmp_path):
    printed = pd(tmp_path, speaking(live.ports.port, "/yehu/status", "1"))
    for name, value in live.server.status().items():
        if value != "":
            assert f"yehu status {name}" in printed


# ---------------------------------------------------------------- python-osc


def test_python_osc_plays_and_hears_by_udp(live, until):
    with SimpleUDPClient("127.0.0.1", live.ports.port, timeout=LONGEST_S) as client:
        client.send_message("/yehu/note", [67.0, 90])
        client.send_message("/yehu/bow/force", 0.75)
        message = next(client.get_messages(LONGEST_S))
        assert (message.address, message.params) == ("/yehu/bow/force", [0.75])
        until(lambda: live.player.pitch is not None, "the note")
        client.send_message("/yehu/note/off", 67)
        until(lambda: live.player.pitch is None, "its end")


@pytest.mark.parametrize("mode", [MODE_1_0, MODE_1_1])
def test_python_osc_plays_and_hears_by_tcp(live, until, mode):
    with SimpleTCPClient("127.0.0.1", live.ports.port, mode=mode, timeout=LONGEST_S) as client:
        client.send_message("/yehu/note", [67.0, 90])
        client.send_message("/yehu/bow/force", 0.75)
        message = next(client.get_messages(LONGEST_S))
        assert (message.address, message.params) == ("/yehu/bow/force", [0.75])
        until(lambda: live.player.pitch is not None, "the note")
    until(lambda: live.ports.traffic.connections == 0, "the connection to be gone")


def test_python_osc_sends_bundles_ahead(live, until):
    now = time.time()
    bundle = OscBundleBuilder(now + 0.3)
    for address, value in (("/yehu/bow/position", 0.3), ("/yehu/bow/force", 1.5)):
        message = OscMessageBuilder(address)
        message.add_arg(value)
        bundle.add_content(message.build())
    with SimpleUDPClient("127.0.0.1", live.ports.port) as client:
        client.send(bundle.build())
    until(lambda: live.handler.counts.scheduled == 2, "the bundle")
    until(lambda: live.handler.waiting == 0, "its time")
    assert time.time() - now > 0.2
    moves = {address: frame for frame, address, _ in live.settle()}
    assert moves["/bow/position"] == moves["/bow/force"]
