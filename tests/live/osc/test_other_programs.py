"""OSC from and to other programs: liblo, python-osc."""

import shutil
import subprocess

import pytest
from pythonosc.osc_tcp_server import MODE_1_0, MODE_1_1
from pythonosc.tcp_client import SimpleTCPClient
from pythonosc.udp_client import SimpleUDPClient

LONGEST_S = 30.0

needs_liblo = pytest.mark.skipif(not shutil.which("oscsend"), reason="liblo's oscsend is not here")


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
