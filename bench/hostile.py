"""A player beside hostile senders: notes lost, ping, memory, for each kind of sender.

    .venv/bin/python bench/hostile.py [--seconds N] [--kind NAME ...] [--save FILE.json]

The server plays to nobody, in a process of its own, new for each kind; senders are in another.
The player begins a note, ends the one before and pings, a hundred times a second, by UDP. Memory
is the server process's own, sampled; it needs Linux.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import multiprocessing
import os
import platform
import socket
import statistics
import struct
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

HOST = "127.0.0.1"
SPAWN = multiprocessing.get_context("spawn")
EVERY_S = 0.01  # between a note and the next
ACQUAINTED_S = 1.5  # for which the player plays alone
RECOVERS_S = 20.0  # at most, until what was sent is answered
PITCHES = 24
LOWEST = 62  # the player's notes; hostile ones are lower
HOSTILE = 40.0
ATTACKER_HOST = HOST  # where datagrams come from


# ---------------------------------------------------------------- bytes


def text(of: str) -> bytes:
    """A string as OSC has it."""
    data = of.encode()
    return data + b"\0" * (4 - len(data) % 4)


def message(address: str, *floats: float) -> bytes:
    """A message of floats."""
    tags = text("," + "f" * len(floats))
    return text(address) + tags + struct.pack(f">{len(floats)}f", *floats)


def question(address: str, word: str) -> bytes:
    """A message of one string."""
    return text(address) + text(",s") + text(word)


def bundle(elements: list[bytes], in_s: float | None = None) -> bytes:
    """A bundle for at once, or for some seconds from now."""
    tag = 1 if in_s is None else round((time.time() + in_s + 2_208_988_800) * 2**32)
    sized = (struct.pack(">i", len(element)) + element for element in elements)
    return b"#bundle\0" + struct.pack(">Q", tag) + b"".join(sized)


def full_of(element: bytes, size: int) -> bytes:
    """A bundle of at most `size` bytes, of one message again and again."""
    return bundle([element] * ((size - 16) // (len(element) + 4)))


def prefixed(packet: bytes) -> bytes:
    """A packet as a stream has it."""
    return struct.pack(">I", len(packet)) + packet


# ---------------------------------------------------------------- who is hostile

Attack = Callable[[int, float], None]
DATAGRAM = 65_000
LONG = 1 << 20
NOTHING = b"/\0\0\0"


def connect(port: int) -> socket.socket:
    """A TCP connection."""
    return socket.create_connection((HOST, port), timeout=5.0)


def senders(port: int, count: int) -> list[socket.socket]:
    """UDP sockets, each with a port of its own, that wait for nobody."""
    made = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for each in made:
        with contextlib.suppress(OSError):  # elsewhere than on Linux there is one such address
            each.bind((ATTACKER_HOST, 0))
        each.connect((HOST, port))
        each.setblocking(False)
    return made


def until(seconds: float) -> Iterator[int]:
    """Count for so long."""
    end = time.monotonic() + seconds
    return itertools.takewhile(lambda _: time.monotonic() < end, itertools.count())


def flood(port: int, seconds: float, packets: list[bytes], count: int = 1) -> None:
    """Send datagrams in turn from many ports, without a pause."""
    sockets = senders(port, count)
    for number in until(seconds):
        with contextlib.suppress(OSError):
            sockets[number % count].send(packets[number % len(packets)])


def streams(port: int, seconds: float, data: bytes, count: int = 1) -> None:
    """Send the same over many connections, as fast as they take it; connect again when cut."""

    def send() -> None:
        for _ in until(seconds):
            with contextlib.suppress(OSError), connect(port) as stream:
                stream.settimeout(1.0)
                for _ in until(seconds):
                    stream.sendall(data)

    threads = [threading.Thread(target=send) for _ in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def quiet(_port: int, seconds: float) -> None:
    """Do nothing."""
    time.sleep(seconds)


def web_page(port: int, seconds: float) -> None:
    """What a page in a browser can send: a POST whose body is SLIP."""
    body = b"\xc0" + message("/yehu/note", HOSTILE, 100.0) + b"\xc0"
    head = f"POST / HTTP/1.1\r\nHost: {HOST}:{port}\r\nOrigin: http://evil.example\r\n"
    request = f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body
    for _ in until(seconds):
        with contextlib.suppress(OSError), connect(port) as stream:
            stream.sendall(request)
            stream.recv(100)


def long_bundle(port: int, seconds: float) -> None:
    """Bundles of 1 MB by TCP."""
    streams(port, seconds, prefixed(full_of(NOTHING, LONG)))


def full_bundles(port: int, seconds: float) -> None:
    """Bundles as long as a datagram, by TCP."""
    streams(port, seconds, prefixed(full_of(NOTHING, DATAGRAM)))


def many_long(port: int, seconds: float) -> None:
    """Sixty connections with two bundles of 1 MB each."""
    data = 2 * prefixed(full_of(NOTHING, LONG))
    made = [connect(port) for _ in range(60)]
    sending = [threading.Thread(target=_send_all, args=(stream, data)) for stream in made]
    for thread in sending:
        thread.start()
    time.sleep(seconds)
    for stream in made:
        stream.close()


def _send_all(stream: socket.socket, data: bytes) -> None:
    with contextlib.suppress(OSError):
        stream.sendall(data)


def many_streams(port: int, seconds: float) -> None:
    """Sixty connections with bundles of messages, each as long as a datagram, without an end."""
    streams(port, seconds, prefixed(full_of(message("/yehu/bow/force", 0.5), DATAGRAM)), 60)


def datagrams(port: int, seconds: float) -> None:
    """Two thousand datagrams of 65 kB from one port."""
    _burst(port, seconds, 1)


def datagrams_of_many(port: int, seconds: float) -> None:
    """Two thousand datagrams of 65 kB, each from a port of its own."""
    _burst(port, seconds, 500)


def _burst(port: int, seconds: float, count: int) -> None:
    packet = full_of(NOTHING, DATAGRAM)
    sockets = senders(port, count)
    for number in range(2000):
        with contextlib.suppress(OSError):
            sockets[number % count].send(packet)
    time.sleep(seconds)


def shorter_of_many(port: int, seconds: float) -> None:
    """Eight thousand datagrams of 16 kB, which are heard, from five hundred ports."""
    packet = full_of(NOTHING, 16_000)
    sockets = senders(port, 500)
    for number in range(8000):
        _send(sockets[number % 500], packet)
    time.sleep(seconds)


def slip_without_end(port: int, seconds: float) -> None:
    """SLIP that never ends a packet."""
    streams(port, seconds, b"\xc0/" + b"x" * (LONG - 2), 8)


def empty_packets(port: int, seconds: float) -> None:
    """Streams of packets without a byte."""
    streams(port, seconds, bytes(1 << 16), 8)


def idle(port: int, seconds: float) -> None:
    """As many idle connections as there are."""
    made = [connect(port) for _ in range(64)]
    time.sleep(seconds)
    for stream in made:
        stream.close()


def questions(port: int, seconds: float) -> None:
    """Datagrams of 65 kB that ask for everything, again and again."""
    flood(port, seconds, [full_of(question("/yehu/get", "/*/*"), DATAGRAM)])


def tables(port: int, seconds: float) -> None:
    """16 bytes that ask for 10 kB, ten thousand times a second."""
    packet = text("/yehu/params")
    sockets = senders(port, 16)
    for _ in until(seconds):
        for each in sockets * 6:
            with contextlib.suppress(OSError):
                each.send(packet)
        time.sleep(0.01)


def subscriptions(port: int, seconds: float) -> None:
    """As many subscriptions as there are, and patterns that set everything."""
    (sender,) = senders(port, 1)
    listening = senders(port, 64)
    for each in listening:
        own = each.getsockname()[1]
        _send(sender, message("/yehu/subscribe", 60.0, float(own)))
    for number in until(seconds):
        _send(sender, message("/yehu/*/*/unit", number % 100 / 100.0))
        time.sleep(0.002)


def patterns(port: int, seconds: float) -> None:
    """Patterns that take long to match and fit nothing."""
    flood(port, seconds, [message("/yehu/" + "{*,?*,*?}*[!x]*" * 15, 1.0)], 8)


def due_together(port: int, seconds: float) -> None:
    """All that may wait for its time, for one time."""
    (sender,) = senders(port, 1)
    element = message("/yehu/bow/force", 0.5)
    for _ in until(seconds):
        packet = bundle([element] * 400, 0.5)
        for _ in range(75):
            _send(sender, packet)
        time.sleep(0.25)


def due_never(port: int, seconds: float) -> None:
    """Long messages for a time far ahead."""
    (sender,) = senders(port, 1)
    packet = bundle([text("/yehu/ping") + text(",s") + text("x" * 16_000)], 1e6)
    for _ in until(seconds):
        _send(sender, packet)
        time.sleep(0.0005)


def small_of_many(port: int, seconds: float) -> None:
    """Small datagrams from two hundred ports, some 20,000 a second."""
    sockets = senders(port, 200)
    packet = message("/yehu/bow/force", 0.5)
    for _ in until(seconds):
        for each in sockets:
            _send(each, packet)
        time.sleep(0.01)


def small_of_another_host(port: int, seconds: float) -> None:
    """Small datagrams from two hundred ports of another host, some 20,000 a second."""
    globals()["ATTACKER_HOST"] = "127.0.0.2"
    small_of_many(port, seconds)


def tables_of_another_host(port: int, seconds: float) -> None:
    """16 bytes that ask for 10 kB, from another host."""
    globals()["ATTACKER_HOST"] = "127.0.0.2"
    tables(port, seconds)


def small_of_one(port: int, seconds: float) -> None:
    """Small datagrams from one port, as many as it can."""
    flood(port, seconds, [message("/yehu/bow/force", 0.5)])


def _send(sender: socket.socket, packet: bytes) -> None:
    with contextlib.suppress(OSError):
        sender.send(packet)


KINDS: dict[str, Attack] = {
    attack.__name__: attack
    for attack in (
        quiet,
        web_page,
        long_bundle,
        full_bundles,
        many_long,
        many_streams,
        datagrams,
        datagrams_of_many,
        shorter_of_many,
        slip_without_end,
        empty_packets,
        idle,
        questions,
        tables,
        subscriptions,
        patterns,
        due_together,
        due_never,
        small_of_many,
        small_of_another_host,
        tables_of_another_host,
        small_of_one,
    )
}


# ---------------------------------------------------------------- who is played


def serve(pipe: Any) -> None:
    """Serve until told to stop; tell what notes came, in order, and how things stand."""
    from yehu_server.audio.output import NULL, OutputOptions
    from yehu_server.server import ServeOptions, Server

    options = ServeOptions(output=OutputOptions(device=NULL), midi=None, osc=(HOST, 0))
    playing = Server(options, lambda _line: None)
    notes: list[tuple[float, float]] = []
    begin = playing.player.note_on

    def note_on(note: float, velocity: float, **more: Any) -> None:
        notes.append((note, velocity))
        begin(note, velocity, **more)

    vars(playing.player)["note_on"] = note_on
    playing.start()
    pipe.send(playing.osc.port)
    while pipe.recv():
        pipe.send((list(notes), playing.status()))
    playing.stop()


class Served:
    """A server in a process of its own."""

    def __init__(self) -> None:
        self._pipe, there = SPAWN.Pipe()
        self.process = SPAWN.Process(target=serve, args=(there,), daemon=True)
        self.process.start()
        there.close()
        self.port = int(self._pipe.recv())

    def told(self) -> tuple[list[tuple[float, float]], dict[str, Any]]:
        """The notes that came, and the status."""
        self._pipe.send(True)
        notes, status = self._pipe.recv()
        return notes, status

    def bytes(self) -> int:
        """Memory that is its own, or 0 where the system does not tell."""
        with contextlib.suppress(OSError):
            for line in Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
                if line.startswith("RssAnon"):
                    return int(line.split()[1]) << 10
        return 0

    def stop(self) -> None:
        """End it."""
        with contextlib.suppress(OSError):
            self._pipe.send(False)
        self.process.join(10.0)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()


# ---------------------------------------------------------------- who plays


class Playing:
    """A player by UDP: notes, pings between them, and how long answers take."""

    def __init__(self, port: int) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect((HOST, port))
        self._socket.settimeout(0.1)
        self._ending = threading.Event()
        self._sent: dict[int, float] = {}
        self.notes: list[tuple[float, float]] = []
        self.pings_s: list[float] = []
        self._threads = [threading.Thread(target=work) for work in (self._play, self._hear)]
        self._is_playing = True
        for thread in self._threads:
            thread.start()

    @property
    def unanswered(self) -> int:
        """Pings without an answer yet."""
        return len(self._sent)

    def finish(self) -> None:
        """Play no more, and wait for what is still to be answered."""
        if self._ending.is_set():
            return
        self._is_playing = False
        self._threads[0].join()
        deadline = time.monotonic() + RECOVERS_S
        while self._sent and time.monotonic() < deadline:
            time.sleep(0.01)
        self._ending.set()
        self._threads[1].join()
        self._socket.close()

    def _play(self) -> None:
        due = time.monotonic()
        for number in itertools.count():
            if not self._is_playing:
                return
            steps, pitch = divmod(number, PITCHES)
            note = float(LOWEST + pitch), 1.0 + steps % 127
            self._socket.send(message("/yehu/note", *note))
            if self.notes:
                self._socket.send(message("/yehu/note/off", self.notes[-1][0]))
            self.notes.append(note)
            self._sent[number] = time.monotonic()
            self._socket.send(text("/yehu/ping") + text(",i") + struct.pack(">i", number))
            due += EVERY_S
            time.sleep(max(0.0, due - time.monotonic()))

    def _hear(self) -> None:
        while not self._ending.is_set():
            try:
                packet = self._socket.recv(1 << 16)
            except OSError:
                continue
            if packet.startswith(b"/yehu/pong"):
                (number,) = struct.unpack(">i", packet[-4:])
                self.pings_s.append(time.monotonic() - self._sent.pop(number))


@dataclass
class Figures:
    """What one kind of sender did to the player."""

    notes: int
    lost: int
    hostile_notes: int
    unanswered: int
    ping_median_ms: float
    ping_99_ms: float
    ping_worst_ms: float
    growth_mb: float
    kept_mb: float  # of the growth, in the end
    system_dropped: int  # packets, of anyone


def measured(name: str, seconds: float, served: Served) -> Figures:
    """Play beside one kind of sender."""
    before, status = served.told()
    playing = Playing(served.port)
    attacker = SPAWN.Process(target=KINDS[name], args=(served.port, seconds))
    try:
        time.sleep(ACQUAINTED_S)
        idle_bytes = most_bytes = served.bytes()
        playing.pings_s.clear()
        attacker.start()
        end = time.monotonic() + 2.0 * seconds + RECOVERS_S
        while attacker.is_alive() and time.monotonic() < end:
            most_bytes = max(most_bytes, served.bytes())
            time.sleep(0.005)
        playing.finish()
        most_bytes = max(most_bytes, served.bytes())
        notes, after = served.told()
    finally:
        attacker.kill()
        attacker.join()
        playing.finish()
    notes = notes[len(before) :]
    own = [note for note in notes if note[0] != HOSTILE]
    left = iter(playing.notes)
    in_order = sum(note in left for note in own)
    pings = sorted(playing.pings_s) + [RECOVERS_S] * playing.unanswered
    return Figures(
        notes=len(playing.notes),
        lost=len(playing.notes) - in_order,
        hostile_notes=len(notes) - len(own),
        unanswered=playing.unanswered,
        ping_median_ms=1e3 * statistics.median(pings),
        ping_99_ms=1e3 * pings[int(0.99 * len(pings))],
        ping_worst_ms=1e3 * pings[-1],
        growth_mb=1e-6 * (most_bytes - idle_bytes),
        kept_mb=1e-6 * (served.bytes() - idle_bytes),
        system_dropped=after["osc_dropped"] - status["osc_dropped"],
    )


def main() -> None:
    """Measure and print everything."""
    from rich.console import Console
    from rich.table import Table
    from run import processor

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=10.0, help="of each (default: 10)")
    parser.add_argument("--kind", nargs="*", choices=KINDS, help="(default: all)")
    parser.add_argument("--save", type=Path, help="write the figures to a JSON file")
    arguments = parser.parse_args()
    console = Console(width=150)
    table = Table()
    columns = ("notes", "lost", "hostile notes", "pings unanswered", "ping ms, median")
    for column in (
        "",
        *columns,
        "99 %",
        "worst",
        "memory +MB",
        "kept +MB",
        "dropped by the system",
    ):
        table.add_column(column)
    figures = {}
    for name in arguments.kind or KINDS:
        served = Served()
        try:
            got = figures[name] = measured(name, arguments.seconds, served)
        finally:
            served.stop()
        cells = [
            f"{cell:.1f}" if isinstance(cell, float) else str(cell) for cell in vars(got).values()
        ]
        console.print(name, *cells)
        table.add_row(name.replace("_", " "), *cells)
    console.print(table)
    if arguments.save:
        record = {
            "machine": f"{processor()}, {os.cpu_count()} cores, {platform.system()}",
            "python": platform.python_version(),
            "seconds": arguments.seconds,
            "figures": {name: asdict(got) for name, got in figures.items()},
        }
        arguments.save.parent.mkdir(parents=True, exist_ok=True)
        arguments.save.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
