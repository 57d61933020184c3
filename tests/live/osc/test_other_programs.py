"""OSC from and to other programs: liblo, Pure Data, python-osc."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
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
def test_liblo_sets_a_parameter_with_any_type_of_a_number_and_no_other(shared_server, until, kind):
    player, counts = shared_server.player, shared_server.handler.counts
    for address, tag, word, value in [
        ("/yehu/bow/force", "f", "0.75", 0.75),
        ("/yehu/bow/force", "d", "0.5", 0.5),
        ("/yehu/bow/force", "i", "2", 2.0),
        ("/yehu/bow/force", "h", "3", 3.0),
        ("/yehu/b?w/f*", "f", "0.25", 0.25),
    ]:
        oscsend(shared_server, kind, address, tag, word)
        until(lambda value=value: player.value("/bow/force") == value, f"{tag} {word}")
    for words in [["s", "0.75"], ["N"], ["I"], ["c", "a"], ["m", "00903c40"], ["cf", "a", "1"]]:
        before, refused = player.values(), counts.errors + counts.malformed
        oscsend(shared_server, kind, "/yehu/bow/force", *words)
        until(lambda n=refused + 1: counts.errors + counts.malformed == n, f"{words} refused")
        assert player.values() == before
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
def test_pure_data_plays_a_note_sets_a_value_and_hears_what_it_asks_for(live, tmp_path):
    port = live.ports.port
    pd(tmp_path, speaking(port, "/yehu/note", "67 90", 500))
    assert live.handler.counts.messages == 1
    live.settle()
    assert live.player.pitch == pytest.approx(67.0, abs=0.5)
    printed = pd(tmp_path, speaking(port, "/yehu/bow/force", "0.75"))
    assert live.player.value("/bow/force") == 0.75
    assert "heard: list yehu bow force 0.75" in printed or "heard: yehu bow force 0.75" in printed
    printed = pd(tmp_path, speaking(port, "/yehu/subscribe", "10"))
    for line in ("yehu subscribed 10", "yehu bow force 0.75", "yehu room size 5"):
        assert line in printed
    assert live.is_well()


# ---------------------------------------------------------------- python-osc


@pytest.mark.parametrize("mode", [None, MODE_1_0, MODE_1_1], ids=["udp", "1.0", "1.1"])
def test_python_osc_plays_and_hears(live, until, mode):
    place = ("127.0.0.1", live.ports.port)
    with (
        SimpleUDPClient(*place, timeout=LONGEST_S)
        if mode is None
        else SimpleTCPClient(*place, mode=mode, timeout=LONGEST_S)
    ) as client:
        client.send_message("/yehu/note", [67.0, 90])
        client.send_message("/yehu/bow/force", 0.75)
        message = next(client.get_messages(LONGEST_S))
        assert (message.address, message.params) == ("/yehu/bow/force", [0.75])
        until(lambda: live.player.pitch is not None, "the note")
    until(lambda: live.ports.traffic.connections == 0, "the connection to be gone")
