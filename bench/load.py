"""A sound card and a load for benchmarks: JACK's dummy driver, dense MIDI and OSC.

.venv/bin/python bench/load.py PORT     sends the load to an OSC port, until it is killed
"""

import collections
import contextlib
import ctypes.util
import itertools
import multiprocessing
import os
import random
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from typing import Any

from yehu_server.live.osc.packets import pack

CARD = "system, JACK"
JACK = "yehu-bench"
SPAWN = multiprocessing.get_context("spawn")

# ---------------------------------------------------------------- the sound card


def start(program: list[str], out: int = subprocess.DEVNULL) -> subprocess.Popen[bytes]:
    """Start a program, without its error messages."""
    return subprocess.Popen(program, stdout=out, stderr=subprocess.DEVNULL)  # noqa: S603


@contextlib.contextmanager
def dummy_jack(period: int, rate: int = 48000, *words: str) -> Iterator[None]:
    """A JACK server without a sound card, for every process started within the block."""
    os.environ |= {"JACK_DEFAULT_SERVER": JACK, "JACK_NO_AUDIO_RESERVATION": "1"}
    os.environ["JACK_NO_START_SERVER"] = "1"
    card = ["-d", "dummy", "-r", str(rate), "-p", str(period)]
    program = ["jackd", "--no-realtime", "--no-mlock", "-p", "128", "-n", JACK, *words, *card]
    jackd = start(program)
    deadline = time.monotonic() + 10.0
    try:
        while b"playback_1" not in start(["jack_lsp"], subprocess.PIPE).communicate()[0]:
            if time.monotonic() > deadline:
                sys.exit("JACK's server does not start")
            if jackd.poll() is not None:  # JACK's registry still holds the server before
                jackd = start(program)
            time.sleep(0.05)
        yield
    finally:
        jackd.terminate()
        try:
            jackd.wait(3.0)
        except subprocess.TimeoutExpired:
            jackd.kill()


def sound_card(wanted: str | None, period: int) -> contextlib.AbstractContextManager[object]:
    """The named output, or a dummy JACK server."""
    if wanted is not None:
        return contextlib.nullcontext()
    if shutil.which("jackd") is None or ctypes.util.find_library("jack") is None:
        sys.exit("without JACK, name an output: --audio-device NAME")
    return dummy_jack(period)


# ---------------------------------------------------------------- the load


class MidiOut:
    """A MIDI output of JACK, of a client of its own."""

    def __init__(self, name: str) -> None:
        import jack

        self._client = jack.Client(name, no_start_server=True)
        self._port = self._client.midi_outports.register("out")
        self._waiting: collections.deque[bytes] = collections.deque()
        self._client.set_process_callback(self._process)
        self._client.activate()

    def _process(self, _frames: int) -> None:
        self._port.clear_buffer()
        while self._waiting:
            self._port.write_midi_event(0, self._waiting.popleft())

    def send(self, message: Sequence[int]) -> None:
        """Send a message in the next period."""
        self._waiting.append(bytes(message))

    def close(self) -> None:
        """Close the client."""
        self._client.close()


def send_load(port: int, parts: int = 1, beside: int | None = None) -> None:
    """Send notes, wheels and touch over MIDI, 600 messages a second; over OSC 2,000.

    Each part has an output of its own, and they are sent to in turn. The port `beside` is sent the
    same OSC.
    """
    sockets = []
    for to in (port, beside):
        if to is not None:
            sockets.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            sockets[-1].connect(("127.0.0.1", to))
    outs = [MidiOut("load" if parts == 1 else f"load {part + 1}") for part in range(parts)]
    prefixes = [f"/yehu/part/{part + 1}" for part in range(parts)] if parts > 1 else ["/yehu"]
    chance = random.Random(1)  # noqa: S311
    notes, due = [65] * parts, time.monotonic()
    while True:
        for part, midi in enumerate(outs):
            midi.send([0x80, notes[part], 64])
            notes[part] = chance.randrange(65, 90)
            midi.send([0x90, notes[part], chance.randrange(20, 127)])
        for step in range(50):
            midi, prefix = outs[step % parts], prefixes[step % parts]
            for message in ([0xE0, chance.randrange(128)], [0xD0], [0xB0, 1]):
                midi.send([*message, chance.randrange(128)])
            for _ in range(5):
                position = pack(f"{prefix}/bow/position", chance.uniform(0.05, 0.2))
                pressure = pack(f"{prefix}/playing/pressure", chance.uniform(0.2, 0.6))
                for osc, packet in itertools.product(sockets, (position, pressure)):
                    with contextlib.suppress(ConnectionRefusedError):
                        osc.send(packet)
            due += 0.005
            time.sleep(max(0.0, due - time.monotonic()))


@contextlib.contextmanager
def loaded(port: int, parts: int = 1, beside: int | None = None) -> Iterator[None]:
    """Within the block, another process sends the load; see `send_load`."""
    sender = SPAWN.Process(target=send_load, args=(port, parts, beside), daemon=True)
    sender.start()
    try:
        yield
    finally:
        sender.kill()
        sender.join()


@contextlib.contextmanager
def helper(work: Any, *arguments: Any) -> Iterator[Any]:
    """Run a function in another process; yield the pipe to it, which is its last argument."""
    here, there = SPAWN.Pipe()
    process = SPAWN.Process(target=work, args=(*arguments, there))
    process.start()
    there.close()
    try:
        yield here
    finally:
        process.join(10.0)
        process.kill()
        process.join()


def compute() -> None:
    """Keep Python busy, in a thread."""

    def work() -> None:
        while True:
            sum(number * number for number in range(1000))

    threading.Thread(target=work, daemon=True).start()


if __name__ == "__main__":
    send_load(int(sys.argv[1]))
