"""The shipped patch on a real server, in a real Pure Data."""

import contextlib
import math
import shutil
import socket
import subprocess
import threading
import time

import pytest

from yehu_server.params.table import TABLE
from yehu_server.surfaces import puredata

PD = shutil.which("pd") or shutil.which("puredata")

WATCHED = "/yehu/playing/vibrato"  # only these tests move it


class RunningPatch:
    """A Pd with the patch open, moved and watched from another patch."""

    def __init__(self, folder, port: int) -> None:
        patch = folder / "yehu.pd"
        patch.write_bytes(puredata.make(("127.0.0.1", port)))
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind(("127.0.0.1", 0))
            self._port = probe.getsockname()[1]
        watcher = folder / "watcher.pd"
        watcher.write_text(
            "#N canvas 0 0 450 300 10;\n"
            f"#X obj 10 10 netreceive -u {self._port} 127.0.0.1;\n"
            "#X msg 10 40 \\; \\$1 \\$2;\n"
            f"#X obj 200 10 r {WATCHED};\n"
            "#X obj 200 40 print watched;\n"
            "#X connect 0 0 1 0;\n"
            "#X connect 2 0 3 0;\n"
        )
        words = [PD, "-nogui", "-noaudio", "-nomidi", "-stderr", "-noprefs"]
        self._pd = subprocess.Popen(
            [*words, "-open", str(watcher), "-open", str(patch)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.printed: list[str] = []
        self._reader = threading.Thread(target=self._read)
        self._reader.start()
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def _read(self) -> None:
        self.printed.extend(line.strip() for line in self._pd.stderr)

    def move(self, name: str, value: float | str) -> None:
        """Send a value to a slider or button of the patch."""
        self._socket.sendto(f"list {name} {value};\n".encode(), ("127.0.0.1", self._port))

    def close(self) -> None:
        self._pd.terminate()
        self._pd.wait(10)
        self._reader.join()
        self._pd.stderr.close()
        self._socket.close()


@pytest.fixture
def patch(live, until, tmp_path):
    if not PD:
        pytest.skip("Pure Data is not here")
    live.player.set("/playing/variation", 0.0, frame=0)
    live.player.set("/playing/vibrato", 12.5, frame=0)
    with contextlib.closing(RunningPatch(tmp_path, live.ports.port)) as patch:
        until(lambda: "watched: set 12.5" in patch.printed, "what the server had")
        yield patch


def test_every_slider_of_the_patch_moves_its_parameter(live, until, patch):
    for param in TABLE:
        if param.address == "/playing/section":  # at most as many as there are
            continue
        value = param.from_unit(0.1)
        patch.move(f"/yehu{param.address}{puredata.MOVED}", f"{value:.9g}")
        value = math.floor(value + 0.5) if param.is_choice else value
        until(
            lambda param=param, value=value: (
                live.player.value(param.address) == pytest.approx(value, rel=1e-5)
            ),
            param.address,
        )
    assert live.handler.counts.errors == 0
    assert not [line for line in patch.printed if "create" in line or "error" in line]


def test_a_slider_follows_the_server_says_nothing_back_and_shows_what_it_has_moved(
    live, until, patch
):
    client = live.client()
    client.send("/playing/vibrato", 40.0)
    until(lambda: "watched: set 40" in patch.printed, "the change")
    client.sync()
    count = live.handler.counts.messages
    time.sleep(0.4)
    assert live.handler.counts.messages == count
    assert live.player.value("/playing/vibrato") == 40.0
    patch.move(WATCHED, 25)
    # The patch itself shows it at once, the server when the slider rests.
    until(lambda: patch.printed.count("watched: set 25") >= 2, "echo, and the server")
    patch.move("/yehu/playing/speed", 0.3)
    until(lambda: live.player.value("/playing/speed") == pytest.approx(0.3), "the move")
    client.send("/playing/vibrato", 77.0)
    until(lambda: "watched: set 77" in patch.printed, "the change, sent when the slider rests")
