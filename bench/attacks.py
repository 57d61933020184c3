"""Hostile senders to the OSC port, by name, for `hostile.py`."""

from __future__ import annotations

import contextlib
import itertools
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterator

HOST = "127.0.0.1"
HOSTILE = 40.0  # the note that they play
ATTACKER_HOST = HOST  # where datagrams come from


# ---------------------------------------------------------------- bytes


def text(of: str) -> bytes:
    """A string in OSC's encoding."""
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
    """A bundle to act on at once, or in some seconds."""
    tag = 1 if in_s is None else round((time.time() + in_s + 2_208_988_800) * 2**32)
    sized = (struct.pack(">i", len(element)) + element for element in elements)
    return b"#bundle\0" + struct.pack(">Q", tag) + b"".join(sized)


def full_of(element: bytes, size: int) -> bytes:
    """A bundle of at most `size` bytes that repeats one message."""
    return bundle([element] * ((size - 16) // (len(element) + 4)))


def prefixed(packet: bytes) -> bytes:
    """A packet as a TCP stream frames it: its length first."""
    return struct.pack(">I", len(packet)) + packet


# ---------------------------------------------------------------- attacks

Attack = Callable[[int, float], None]
DATAGRAM = 65_000
LONG = 1 << 20
NOTHING = b"/\0\0\0"


def connect(port: int) -> socket.socket:
    """A TCP connection."""
    return socket.create_connection((HOST, port), timeout=5.0)


def senders(port: int, count: int) -> list[socket.socket]:
    """Non-blocking UDP sockets, each with its own port."""
    made = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for each in made:
        with contextlib.suppress(OSError):  # only Linux has the whole 127.0.0.0/8
            each.bind((ATTACKER_HOST, 0))
        each.connect((HOST, port))
        each.setblocking(False)
    return made


def until(seconds: float) -> Iterator[int]:
    """Count until the time is over."""
    end = time.monotonic() + seconds
    return itertools.takewhile(lambda _: time.monotonic() < end, itertools.count())


def flood(port: int, seconds: float, packets: list[bytes], count: int = 1) -> None:
    """Send datagrams from many ports in turn, without a pause."""
    sockets = senders(port, count)
    for number in until(seconds):
        with contextlib.suppress(OSError):
            sockets[number % count].send(packets[number % len(packets)])


def streams(port: int, seconds: float, data: bytes, count: int = 1) -> None:
    """Send data over many connections as fast as they take it; reconnect when cut off."""

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
    """A POST with a SLIP body, as a page in a browser can send it."""
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
    """Sixty connections with an endless stream of bundles as long as a datagram."""
    streams(port, seconds, prefixed(full_of(message("/yehu/bow/force", 0.5), DATAGRAM)), 60)


def datagrams(port: int, seconds: float) -> None:
    """Two thousand datagrams of 65 kB from one port."""
    _burst(port, seconds, 1)


def datagrams_of_many(port: int, seconds: float) -> None:
    """Two thousand datagrams of 65 kB from five hundred ports."""
    _burst(port, seconds, 500)


def _burst(port: int, seconds: float, count: int) -> None:
    packet = full_of(NOTHING, DATAGRAM)
    sockets = senders(port, count)
    for number in range(2000):
        with contextlib.suppress(OSError):
            sockets[number % count].send(packet)
    time.sleep(seconds)


def shorter_of_many(port: int, seconds: float) -> None:
    """Eight thousand datagrams of 16 kB, short enough to be accepted, from five hundred ports."""
    packet = full_of(NOTHING, 16_000)
    sockets = senders(port, 500)
    for number in range(8000):
        _send(sockets[number % 500], packet)
    time.sleep(seconds)


def slip_without_end(port: int, seconds: float) -> None:
    """SLIP that never ends a packet."""
    streams(port, seconds, b"\xc0/" + b"x" * (LONG - 2), 8)


def empty_packets(port: int, seconds: float) -> None:
    """Streams of empty packets."""
    streams(port, seconds, bytes(1 << 16), 8)


def idle(port: int, seconds: float) -> None:
    """As many idle connections as the server allows."""
    made = [connect(port) for _ in range(64)]
    time.sleep(seconds)
    for stream in made:
        stream.close()


def questions(port: int, seconds: float) -> None:
    """Datagrams of 65 kB that repeat a question for every value."""
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
    """As many subscriptions as the server allows, and patterns that set every parameter."""
    (sender,) = senders(port, 1)
    listening = senders(port, 64)
    for each in listening:
        own = each.getsockname()[1]
        _send(sender, message("/yehu/subscribe", 60.0, float(own)))
    for number in until(seconds):
        _send(sender, message("/yehu/*/*/unit", number % 100 / 100.0))
        time.sleep(0.002)


def patterns(port: int, seconds: float) -> None:
    """Patterns that take long to match and match nothing."""
    flood(port, seconds, [message("/yehu/" + "{*,?*,*?}*[!x]*" * 15, 1.0)], 8)


def due_together(port: int, seconds: float) -> None:
    """As many scheduled messages as the server allows, all due at one time."""
    (sender,) = senders(port, 1)
    element = message("/yehu/bow/force", 0.5)
    for _ in until(seconds):
        packet = bundle([element] * 400, 0.5)
        for _ in range(75):
            _send(sender, packet)
        time.sleep(0.25)


def due_never(port: int, seconds: float) -> None:
    """Long messages scheduled for a time far ahead."""
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


def small_of_the_players_host(port: int, seconds: float) -> None:
    """Small datagrams from one port, 20,000 a second."""
    (sender,) = senders(port, 1)
    packet = message("/yehu/bow/force", 0.5)
    due = time.monotonic()
    for _ in until(seconds):
        for _ in range(200):
            _send(sender, packet)
        due += 0.01
        time.sleep(max(0.0, due - time.monotonic()))


def small_of_one(port: int, seconds: float) -> None:
    """Small datagrams from one port, as many as possible."""
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
        small_of_the_players_host,
        small_of_one,
    )
}
