"""A server on a still clock, and real servers with clients."""

import contextlib
import logging
import socket
import struct
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from moves import Moves
from waiting import PATIENCE_S, until
from wire import FakePeer, Message, StillTime, Wire

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.player.record import SILENT
from yehu_server.errors import OutputError
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.options import PartOptions, ServeOptions
from yehu_server.live.osc import clients, handler
from yehu_server.live.osc.context import CallContext
from yehu_server.live.osc.status import PART_STATUS, STATUS
from yehu_server.live.part_addresses import part_of
from yehu_server.live.server import Server
from yehu_server.live.web.server import WebOptions
from yehu_server.params.table import SLOT
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import player_of
from yehu_server.playing.player import Player
from yehu_server.system import clocks

HOST = "127.0.0.1"
QUIET_S = 0.15  # silence after which nothing more is expected


def target_of(instrument: Instrument, address: str) -> float:
    """The target of an engine parameter on the audio side."""
    return float(instrument._rig["controls"]["target"][0, SLOT[address]])


@pytest.fixture(scope="session")
def wire() -> type[Wire]:
    return Wire


@pytest.fixture(scope="session", name="until")
def until_fixture() -> Callable[..., Any]:
    """Wait for something to be true, and return it."""
    return until


# ---------------------------------------------------------------- peers


@pytest.fixture
def peer() -> FakePeer:
    return FakePeer()


@pytest.fixture
def still_time(monkeypatch) -> StillTime:
    clock = StillTime(time.monotonic() + 100.0)  # later than anything on the true clock
    monkeypatch.setattr(clocks, "monotonic_ns", clock.monotonic_ns)
    monkeypatch.setattr(clocks, "now_s", clock.time)
    monkeypatch.setattr(clients, "time", clock)
    return clock


# ---------------------------------------------------------------- a server on a still clock


class Services:
    """Services of a server that record their calls."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.changed: list[str] = []
        self.said: list[str] = []

    def context(self, players: Sequence[Player]) -> CallContext:
        return CallContext(
            players,
            self.status,
            self.start_recording,
            self.stop_recording,
            self.said.append,
            lambda action: action(),
            lambda action: action(),
            [self.changed.append],
        )

    def status(self, group: str) -> dict[str, float | str]:
        if group:
            return dict.fromkeys((value.name for value in PART_STATUS), float(part_of(group)))
        status = dict.fromkeys((value.name for value in STATUS), 0.0)
        return status | {"load": 0.5, "recording": "".join(self.names[-1:])}

    def start_recording(self, name: str) -> str:
        self.names.append(name)
        return f"{name}.wav"

    def stop_recording(self) -> str:
        if not self.names:
            raise OutputError("nothing is being recorded")
        return f"{self.names.pop()}.wav"


class StillServer:
    """An OSC handler and its instrument, on a still clock."""

    RATE = 48000

    def __init__(self, clock: StillTime, block: int = 128) -> None:
        self.clock = clock
        self.block = block
        playing = PlayingOptions()
        calibration = calibration_for(float(self.RATE))
        self.instrument = Instrument(playing.spec(self.RATE, calibration))
        self._moves = Moves(self.instrument)
        self.instrument.frame_at = self._frame_at
        self.others: list[Instrument] = []  # more instruments, played along
        self._began = (clock.now, 0)
        delay_ms = 1e3 * block / self.RATE + 1.0
        self.player = player_of(0, playing, [self.instrument], delay_ms=delay_ms)
        self.player.set("/playing/variation", 0.0, frame=0)
        self.services = Services()
        self.handler = handler.OscHandler(self.services.context([self.player]))
        self.peer = FakePeer()
        self.events: list[tuple[int, str, float]] = []

    def _frame_at(self, time_ns: int) -> float:
        moment, frame = self._began
        return frame + (1e-9 * time_ns - moment) * self.RATE

    def take(self, packet: bytes, peer: FakePeer | None = None) -> None:
        """Receive a packet now."""
        for _ in self.handler.handle(packet, peer or self.peer, self.clock.monotonic_ns()):
            pass

    def send(self, address: str, *arguments: Any, tags: str | None = None) -> None:
        self.take(Wire.message("/yehu" + address, *arguments, tags=tags))

    def ask(self, address: str, *arguments: Any, tags: str | None = None) -> list[Message]:
        """Send a message; return the answers up to the next flush."""
        self.peer.received()
        self.send(address, *arguments, tags=tags)
        self.clock.now += 0.02
        self._do_what_is_due()
        return self.peer.received()

    def pass_time(self, seconds: float) -> np.ndarray:
        """Play on at the device's pace; return the sound."""
        out = []
        end = self.clock.now + seconds
        while self.clock.now < end:
            while self.instrument.frame <= self._frame_at(self.clock.monotonic_ns()):
                sound = np.zeros(self.block, np.float32)
                self.instrument.process(sound)
                out.append(sound)
                for other in self.others:
                    other.process(np.zeros(self.block, np.float32))
            self.clock.now += 0.001
            self._do_what_is_due()
        self.events += [move[:3] for move in self._moves.seen()]
        assert self._moves.are_those_of_the_audio_side()
        return np.concatenate(out) if out else np.zeros(0, np.float32)

    def _do_what_is_due(self) -> None:
        for steps, _, _ in self.handler.due():
            for _ in steps:
                pass
        self.handler.clients.flush()

    def value(self, address: str) -> float:
        """The value of a parameter, after everything said up to now was played."""
        self.pass_time(0.01)
        return self.player.value(address)

    def target(self, address: str) -> float:
        return target_of(self.instrument, address)

    def frames(self, address: str) -> list[int]:
        """The frames at which a parameter was moved, so far."""
        return [frame for frame, moved, _ in self.events if moved == address]

    def late(self) -> int:
        """Number of events that came after their frame."""
        return int(self.instrument.meters()["late_events"])


@pytest.fixture
def make_still(still_time) -> Callable[..., StillServer]:
    return lambda block=128: StillServer(still_time, block)


@pytest.fixture
def still(make_still) -> StillServer:
    return make_still()


# ---------------------------------------------------------------- clients of a real server


class Client:
    """A client by UDP."""

    def __init__(self, port: int, host: str = HOST) -> None:
        self.server = (host, port)
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        self.socket = socket.socket(family, socket.SOCK_DGRAM)
        self.socket.bind((host, 0))
        self.port = self.socket.getsockname()[1]

    def take(self, packet: bytes) -> None:
        self.socket.sendto(packet, self.server)

    def send(self, address: str, *arguments: Any, tags: str | None = None) -> None:
        self.take(Wire.message("/yehu" + address, *arguments, tags=tags))

    def next(self, within_s: float = PATIENCE_S) -> Message | None:
        """The next message, if one comes within the time."""
        self.socket.settimeout(within_s)
        try:
            packet, sender = self.socket.recvfrom(1 << 16)
        except TimeoutError:
            return None
        assert sender[:2] == self.server  # from the listening port
        return Wire.read(packet)

    def all(self, quiet_s: float = QUIET_S) -> list[Message]:
        """All messages until none comes for a while."""
        return list(iter(lambda: self.next(quiet_s), None))

    def wait_for(self, address: str, within_s: float = PATIENCE_S) -> list[Any]:
        """The arguments of the next message of an address."""
        deadline = time.monotonic() + within_s
        while message := self.next(max(0.001, deadline - time.monotonic())):
            if message.address == "/yehu" + address:
                return message.arguments
        raise AssertionError(f"no {address} within {within_s} s")

    def sync(self) -> None:
        """Wait until all messages sent so far are handled; discard the answers."""
        token = time.monotonic_ns()
        self.send("/ping", token)
        while self.wait_for("/pong") != [token]:
            pass

    def close(self) -> None:
        self.socket.close()


class Stream:
    """A client by TCP, in either framing."""

    def __init__(self, port: int, *, slip: bool = False, host: str = HOST) -> None:
        self.slip = slip
        self.socket = socket.create_connection((host, port), timeout=PATIENCE_S)
        self._buffer = b""

    def wrap(self, packet: bytes) -> bytes:
        if not self.slip:
            return struct.pack(">I", len(packet)) + packet
        escaped = packet.replace(b"\xdb", b"\xdb\xdd").replace(b"\xc0", b"\xdb\xdc")
        return b"\xc0" + escaped + b"\xc0"

    def take(self, packet: bytes) -> None:
        self.socket.sendall(self.wrap(packet))

    def send(self, address: str, *arguments: Any, tags: str | None = None) -> None:
        self.take(Wire.message("/yehu" + address, *arguments, tags=tags))

    def next(self, within_s: float = PATIENCE_S) -> Message | None:
        """The next message; None after the time, or when the server closed the connection."""
        self.socket.settimeout(within_s)
        while (packet := self._packet()) is None:
            try:
                data = self.socket.recv(1 << 16)
            except (TimeoutError, ConnectionError):
                return None
            if not data:
                return None
            self._buffer += data
        return Wire.read(packet)

    def _packet(self) -> bytes | None:
        if not self.slip:
            size = int.from_bytes(self._buffer[:4], "big")
            if len(self._buffer) < 4 + size or len(self._buffer) < 4:
                return None
            packet, self._buffer = self._buffer[4 : 4 + size], self._buffer[4 + size :]
            return packet
        frame, end, rest = self._buffer.lstrip(b"\xc0").partition(b"\xc0")
        if not end:
            return None
        self._buffer = rest
        return frame.replace(b"\xdb\xdc", b"\xc0").replace(b"\xdb\xdd", b"\xdb")

    all = Client.all
    wait_for = Client.wait_for
    sync = Client.sync

    def has_ended(self, within_s: float = PATIENCE_S) -> bool:
        """Whether the server closes the connection within the time."""
        self.socket.settimeout(within_s)
        try:
            while self.socket.recv(1 << 16):
                pass
        except TimeoutError:
            return False
        except ConnectionError:
            return True
        return True

    def close(self) -> None:
        self.socket.close()


class LiveServer:
    """A server without a device, and its clients."""

    def __init__(self, folder: Path, ending: contextlib.ExitStack, **options: Any) -> None:
        self.said: list[str] = []
        output = OutputOptions(device="null", blocksize=options.pop("blocksize", 128))
        handler = options.pop("osc", (HOST, 0))
        own = {name: options.pop(name) for name in ("playing", "reread") if name in options}
        parts = [PartOptions(**own)] * options.pop("parts", 1)
        serve = ServeOptions(output=output, osc=handler, midi=None, parts=parts, recordings=folder)
        self.server = Server(replace(serve, **options), self.said.append)
        self.ports = self.server.osc
        self.handler = self.server.handler
        self.instrument = self.server.instrument
        self.player = self.server.player
        self._moves = Moves(self.instrument)
        self._ending = ending
        self.server.start()
        ending.callback(self.end)

    def end(self) -> None:
        self.server.stop()

    def client(self) -> Client:
        client = Client(self.ports.port, self.ports.host)
        self._ending.callback(client.close)
        return client

    def stream(self, *, slip: bool = False) -> Stream:
        stream = Stream(self.ports.port, slip=slip, host=self.ports.host)
        self._ending.callback(stream.close)
        return stream

    def moves(self) -> list[tuple[int, str, float]]:
        """What was moved since the last call: frame, address, value."""
        self.wait_frames(1)
        return [move[:3] for move in self._moves.seen()]

    def settle(self) -> list[tuple[int, str, float]]:
        """Wait until everything decided so far is played; return what was moved."""
        self.wait_frames(2 * self.player.delay + 1024)
        return self.moves()

    def wait_frames(self, frames: int) -> None:
        end = self.instrument.frame + frames
        until(lambda: self.instrument.frame >= end, f"frame {end}")

    def target(self, address: str) -> float:
        return target_of(self.instrument, address)

    def level(self, seconds: float = 0.2) -> float:
        """RMS of the sound from now on for some seconds."""
        start = self.instrument.frame
        self.wait_frames(round(seconds * self.instrument.rate))
        _, sound = self.server.ensemble.taped(start)
        return float(np.sqrt(np.mean(np.square(sound, dtype=np.float64))))

    def is_at_rest(self) -> bool:
        """Whether no note sounds or is held."""
        performer = self.instrument._rig["player"][0]
        return (
            self.player.pitch is None
            and not self.player.held()
            and performer["held"] == 0
            and performer["sounding"] == SILENT
            and self.target("/bow/speed") == 0.0
            and self.target("/bow/side") == 0.0
            and self.handler.waiting == 0
        )

    def is_well(self) -> bool:
        """Whether the server listens, and no message has met a defect."""
        return self.ports._thread.is_alive() and self.ports.traffic.failures == 0


@contextlib.contextmanager
def run_live(folder: Path, **options: Any) -> Iterator[LiveServer]:
    interval = sys.getswitchinterval()
    before = set(threading.enumerate())
    try:
        with contextlib.ExitStack() as ending:
            yield LiveServer(folder, ending, **options)
    finally:
        sys.setswitchinterval(interval)
    assert set(threading.enumerate()) <= before


@pytest.fixture
def make_live(tmp_path) -> Iterator[Callable[..., LiveServer]]:
    """Open a server with options."""
    with contextlib.ExitStack() as ending:
        yield lambda **options: ending.enter_context(run_live(tmp_path / "takes", **options))


@pytest.fixture
def live(make_live) -> LiveServer:
    return make_live()


@pytest.fixture(scope="module")
def shared_server(tmp_path_factory) -> Iterator[LiveServer]:
    """One server for all tests of a file; each leaves it as it was."""
    with run_live(tmp_path_factory.mktemp("live")) as live:
        yield live


@pytest.fixture(scope="module")
def shared_web(tmp_path_factory) -> Iterator[LiveServer]:
    """The same, with OSCQuery."""
    http = WebOptions((HOST, 0))
    with run_live(tmp_path_factory.mktemp("live"), http=http) as live:
        yield live


@contextlib.contextmanager
def python_is_busy() -> Iterator[None]:
    """Keep a thread of this process busy within the block."""
    ending = threading.Event()

    def count() -> None:
        number = 0
        while not ending.is_set():
            for _ in range(10_000):
                number += 1

    thread = threading.Thread(target=count)
    thread.start()
    try:
        yield
    finally:
        ending.set()
        thread.join()


@pytest.fixture
def busy() -> Callable[[], contextlib.AbstractContextManager[None]]:
    return python_is_busy


@pytest.fixture(autouse=True)
def _quiet() -> Iterator[None]:
    """Keep python-osc's thousands of warnings about odd bytes out of the log."""

    def is_ours(record: logging.LogRecord) -> bool:
        return "pythonosc" not in record.pathname

    logging.getLogger().addFilter(is_ours)
    yield
    logging.getLogger().removeFilter(is_ours)


@pytest.fixture(scope="session")
def kit() -> SimpleNamespace:
    """The client classes, for tests that connect to servers of their own."""
    return SimpleNamespace(Client=Client, Stream=Stream)
