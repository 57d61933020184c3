"""A JACK server for each file of tests, a recorder in another process, and `serve`."""

import contextlib
import ctypes.util
import functools
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import forks
import numpy as np
import pytest
from waiting import until

from yehu_server.core.engine.warming import warm_up
from yehu_server.live.osc.packets import pack, unpack
from yehu_server.live.osc.status import STATUS

RECORDER = Path(__file__).with_name("recorder.py")
RATE = 48000
STARTED_WITHIN_S = 120.0  # where everything has to be compiled first


@functools.cache
def missing() -> str:
    for program in ("jackd", "jack_lsp"):
        if shutil.which(program) is None:
            return f"{program} is not installed"
    for library in ("jack", "portaudio"):
        if ctypes.util.find_library(library) is None:
            return f"lib{library} is not installed"
    return ""


# ---------------------------------------------------------------- JACK


class Jackd:
    """A JACK server that pretends to have a sound card."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.environment = os.environ | {
            "JACK_DEFAULT_SERVER": name,
            "JACK_NO_START_SERVER": "1",
            "JACK_NO_AUDIO_RESERVATION": "1",
        }
        self._process: subprocess.Popen | None = None
        self._card: dict[str, int] = {}

    @property
    def pid(self) -> int:
        assert self._process is not None
        return self._process.pid

    def start(self, period: int = 128, *, rate: int = RATE, channels: int = 2) -> None:
        """Start the server, or restart it with another card or where it does not answer."""
        card = {"-p": period, "-r": rate, "-P": channels, "-C": 1}
        if card != self._card:
            self.stop()
        self._card = card
        words = [str(word) for option in card.items() for word in option]
        safe = ("--no-realtime", "--no-mlock", "-p", "128")
        # One that outlives tests that were killed would be in the way of later ones.
        with_us = ["setpriv", "--pdeathsig", "KILL"] if shutil.which("setpriv") else []
        program = [*with_us, "jackd", *safe, "-n", self.name, "-d", "dummy", *words]

        def is_up() -> bool:
            if self._process is None or self._process.poll() is not None:
                # It ends at once where the one before has not left JACK's registry yet.
                self._process = subprocess.Popen(
                    program,
                    env=self.environment,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
            try:
                return "system:playback_1" in self.ports(3.0)
            except subprocess.TimeoutExpired:  # JACK sometimes hangs
                self._process.kill()
                self._process.wait()
                return False

        until(is_up, "a JACK server", 20.0)

    def restart(self) -> None:
        """Start the same again after a kill."""
        card = self._card
        self.start(card["-p"], rate=card["-r"], channels=card["-P"])

    def kill(self, number: int = signal.SIGKILL) -> None:
        assert self._process is not None
        self._process.send_signal(signal.SIGCONT)
        self._process.send_signal(number)
        try:
            self._process.wait(3.0)
        except subprocess.TimeoutExpired:  # it sometimes hangs as it ends, too
            self._process.kill()
            self._process.wait()

    def stop(self) -> None:
        if self._process is not None and self._process.poll() is None:
            self.kill(signal.SIGTERM)

    def ports(self, timeout_s: float = 10.0) -> list[str]:
        found = subprocess.run(
            ["jack_lsp", "-s", self.name],  # noqa: S607
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=timeout_s,
            check=False,
        )
        return found.stdout.split("\n")


@contextlib.contextmanager
def free_name() -> Iterator[str]:
    """A server name that no other run of the tests uses.

    There are only six: JACK has room for eight names, those of killed servers included.
    """
    import fcntl

    for number in range(6):
        name = f"yehu-tests-{os.getuid()}-{number}"  # a user cannot take up another one's
        with Path(tempfile.gettempdir(), name).open("a") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            yield name
            return
    pytest.skip("six other runs of the tests have a JACK server each")


@pytest.fixture(scope="module")
def jackd() -> Iterator[Jackd]:
    if missing():
        pytest.skip(missing())
    warm_up()  # what an audio process had to compile would come too late
    with free_name() as name, pytest.MonkeyPatch.context() as patch:
        server = Jackd(name)
        for variable in ("JACK_DEFAULT_SERVER", "JACK_NO_START_SERVER"):
            patch.setenv(variable, server.environment[variable])
        yield server
        server.stop()
        for left in Path("/dev/shm").glob(f"jack_sem.*_{server.name}_*"):  # noqa: S108
            left.unlink(missing_ok=True)


# ---------------------------------------------------------------- recorder


class Recording:
    """A recorder's samples [shape=(channels, frames)], and the time of each block."""

    def __init__(self, path: Path) -> None:
        with np.load(path) as file:
            self.samples = file["samples"]
            self.times = file["times"]  # of blocks: JACK's frame, frames, monotonic ns
            self.xruns = int(file["xruns"])

    @property
    def is_whole(self) -> bool:
        """Whether JACK called the recorder for every block, without an xrun."""
        frames, sizes = self.times[:, 0], self.times[:, 1]
        return self.xruns == 0 and bool((np.diff(frames) == sizes[:-1]).all())


class Recorder:
    """Records the instrument's ports, in another process."""

    def __init__(self, jackd: Jackd, folder: Path, channels: int = 2) -> None:
        self._folder = folder
        self._process = subprocess.Popen(
            [sys.executable, RECORDER, jackd.name, str(channels)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=jackd.environment,
        )
        self._expect("ready")

    def connected(self) -> "Recorder":
        """Wait until every port is connected."""
        self._tell("connect")
        self._expect("connected")
        return self

    def freewheel(self, *, on: bool) -> None:
        self._tell("freewheel on" if on else "freewheel off")
        self._expect("freewheel")

    def forget(self) -> None:
        """Begin the recording now."""
        self._tell("forget")
        self._expect("forgotten")

    def recording(self) -> Recording:
        target = self._folder / f"{time.monotonic_ns()}.npz"
        self._tell(f"save {target}")
        self._expect("saved")
        return Recording(target)

    def close(self) -> None:
        for pipe in (self._process.stdin, self._process.stdout):
            with contextlib.suppress(OSError):
                pipe.close()
        try:
            self._process.wait(2.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _tell(self, order: str) -> None:
        self._process.stdin.write(order + "\n")
        self._process.stdin.flush()

    def _expect(self, word: str) -> None:
        heard = self._process.stdout.readline().strip()
        assert heard == word


@pytest.fixture
def recorder(jackd, tmp_path) -> Iterator[Callable[..., Recorder]]:
    with contextlib.ExitStack() as ending:

        def make(channels: int = 2) -> Recorder:
            made = Recorder(jackd, tmp_path, channels)
            ending.callback(made.close)
            return made

        yield make


# ---------------------------------------------------------------- serve


class Osc:
    """An OSC client."""

    def __init__(self, port: int) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect(("127.0.0.1", port))

    def send(self, address: str, *arguments: float | str) -> None:
        with contextlib.suppress(ConnectionRefusedError):  # of an earlier packet
            self._socket.send(pack(f"/yehu{address}", *arguments))

    def ask(self, address: str, *arguments: float | str, last: str = "") -> dict[str, Any]:
        """Send, and return the answers by address: up to `last`, or until none comes for 0.1 s."""
        self._socket.setblocking(False)
        with contextlib.suppress(OSError):
            while True:
                self._socket.recv(65536)
        self.send(address, *arguments)
        heard = {}
        self._socket.settimeout(2.0)
        with contextlib.suppress(TimeoutError, ConnectionRefusedError):
            while not last or last not in heard:
                for message in unpack(self._socket.recv(65536)):
                    heard[message.address.removeprefix("/yehu")] = message.arguments
                self._socket.settimeout(2.0 if last else 0.1)
        return heard

    def status(self) -> dict[str, Any]:
        """The whole status: asked for again where a datagram is lost."""
        names = [value.name for value in STATUS]

        def ask() -> dict[str, Any]:
            heard = self.ask("/status", last=f"/status/{names[-1]}")
            status = {name: heard[at][0] for name in names if (at := f"/status/{name}") in heard}
            return status if len(status) == len(names) else {}

        return until(ask, "the whole status", 20.0)

    def close(self) -> None:
        self._socket.close()


class Serve:
    """``yehu-server serve``, as a command."""

    def __init__(self, environment: dict[str, str], *words: object) -> None:
        self.lines: list[str] = []
        self._changed = threading.Condition()
        self._clients: list[Osc] = []
        self._family: set[int] = set()
        self.process = forks.start(
            *("serve", *words), env=environment, stdout=subprocess.DEVNULL, start_new_session=True
        )
        self._listener = threading.Thread(target=self._listen)
        self._listener.start()

    def _listen(self) -> None:
        for line in self.process.stderr:
            with self._changed:
                self.lines.append(line.rstrip())
                self._changed.notify_all()

    def said(self, pattern: str, within_s: float = 10.0, after: int = 0) -> re.Match[str]:
        """Wait for a line that matches; the first one after `after` lines."""

        def found() -> re.Match[str] | None:
            fitting = (re.search(pattern, line) for line in self.lines[after:])
            return next((match for match in fitting if match), None)

        with self._changed:
            self._changed.wait_for(found, within_s)
            match = found()
        assert match, f"{pattern!r} not within {within_s} s among {self.lines}"
        return match

    def osc(self) -> Osc:
        """A client of the server, once it listens."""
        port = int(self.said(r"OSC at [\d.]+:(\d+)", STARTED_WITHIN_S)[1])
        self.said("Ctrl-C ends")
        self._clients.append(Osc(port))
        return self._clients[-1]

    def family(self) -> set[int]:
        """All processes that it has started so far and that are alive."""
        for entry in Path("/proc").glob("[0-9]*/stat"):
            with contextlib.suppress(OSError):
                fields = entry.read_text().rpartition(")")[2].split()
                if int(fields[1]) == self.process.pid:
                    self._family.add(int(entry.parent.name))
        return {pid for pid in self._family if _lives(pid)}

    def end(self, number: int = signal.SIGTERM) -> int:
        """End it; return its exit code. No process that it started may be left."""
        self.family()
        self.process.send_signal(number)
        return self.wait()

    def wait(self, within_s: float = 10.0) -> int:
        code = self.process.wait(within_s)
        self._listener.join()
        until(lambda: not self.family(), "all its processes to be gone", 60.0)
        return code

    def close(self) -> None:
        self.family()
        for pid in {*self._family, self.process.pid}:
            if _lives(pid):
                os.kill(pid, signal.SIGKILL)
        self.process.wait()
        self._listener.join()
        self.process.stderr.close()
        for client in self._clients:
            client.close()


def _lives(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


@pytest.fixture
def serve(jackd) -> Iterator[Callable[..., Serve]]:
    """Start ``yehu-server serve`` with options, with OSC at a free port by default.

    Its page is one more process to start, of half a second: `panel` asks for it.
    """
    with contextlib.ExitStack() as ending:

        def start(*words: object, panel: bool = False) -> Serve:
            osc = () if "--osc" in words else ("--osc", "127.0.0.1:0")
            page = () if panel else ("--no-panel",)
            made = Serve(jackd.environment, *osc, "--http", "127.0.0.1:0", *page, *words)
            ending.callback(made.close)
            return made

        yield start


@pytest.fixture
def silent() -> Iterator[Callable[..., Serve]]:
    """Start ``yehu-server serve`` with options, on a silent clock and without MIDI."""
    warm_up()
    words = ("--audio-device", "null", "--midi-api", "none", "--osc", "127.0.0.1:0", "--no-http")
    with contextlib.ExitStack() as ending:

        def start(*more: object) -> Serve:
            made = Serve(dict(os.environ), *words, *more)
            ending.callback(made.close)
            return made

        yield start
