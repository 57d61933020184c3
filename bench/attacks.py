"""Hostile senders to the OSC port, by name, for `hostile.py`."""

import contextlib
import itertools
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial

from yehu_server.live.osc.packets import pack

HOST = "127.0.0.1"
HOSTILE = 40.0  # the note that they play
DATAGRAM, LONG = 65_000, 1 << 20
NOTHING, FORCE = b"/\0\0\0", pack("/yehu/bow/force", 0.5)
END = b"\xc0"  # of SLIP
EVERY_S = 0.01

Attack = Callable[[int, float], None]  # called with a port, and for how many seconds


# ---------------------------------------------------------------- forms of attack


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


def senders(port: int, count: int) -> list[socket.socket]:
    """Non-blocking UDP sockets, each with its own port."""
    made = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for each in made:
        each.connect((HOST, port))
        each.setblocking(False)
    return made


def until(seconds: float) -> Iterator[int]:
    """Count until the time is over."""
    end = time.monotonic() + seconds
    return itertools.takewhile(lambda _: time.monotonic() < end, itertools.count())


def flood(
    port: int,
    seconds: float,
    *,
    packet: bytes,
    ports: int = 1,
    a_second: float | None = None,
    most: int | None = None,
) -> None:
    """Send a datagram from many ports in turn, as often as goes or so many times in all."""
    sockets, due = senders(port, ports), time.monotonic()
    at_once = ports if a_second is None else round(a_second * EVERY_S)
    number, end = 0, time.monotonic() + seconds
    while time.monotonic() < end and (most is None or number < most):
        for _ in range(at_once):
            with contextlib.suppress(OSError):
                sockets[number % ports].send(packet)
            number += 1
        if a_second is not None:
            due += EVERY_S
            time.sleep(max(0.0, due - time.monotonic()))
    time.sleep(max(0.0, end - time.monotonic()))


def streams(
    port: int, seconds: float, *, data: bytes, count: int = 1, times: int | None = None
) -> None:
    """Send data over many connections as fast as they take it; reconnect when cut off.

    With `times` each connects once, sends it so often, and stays.
    """
    end = time.monotonic() + seconds

    def send() -> None:
        for _ in until(seconds) if times is None else range(1):
            with contextlib.suppress(OSError), socket.create_connection((HOST, port)) as stream:
                stream.settimeout(1.0)
                for _ in until(seconds) if times is None else range(times):
                    stream.sendall(data)
                time.sleep(0.0 if times is None else max(0.0, end - time.monotonic()))

    threads = [threading.Thread(target=send) for _ in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    time.sleep(max(0.0, end - time.monotonic()))


# ---------------------------------------------------------------- others


def quiet(_port: int, seconds: float) -> None:
    """Do nothing."""
    time.sleep(seconds)


def web_page(port: int, seconds: float) -> None:
    """A POST with a SLIP body, as a page in a browser can send it."""
    body = END + pack("/yehu/note", HOSTILE, 100.0) + END
    head = f"POST / HTTP/1.1\r\nHost: {HOST}:{port}\r\nOrigin: http://evil.example\r\n"
    request = f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body
    for _ in until(seconds):
        with contextlib.suppress(OSError), socket.create_connection((HOST, port)) as stream:
            stream.sendall(request)
            stream.recv(100)


def subscriptions(port: int, seconds: float) -> None:
    """As many subscriptions as the server allows, and patterns that set every parameter."""
    (sender,) = senders(port, 1)
    listening = senders(port, 64)
    for each in listening:
        sender.send(pack("/yehu/subscribe", 60.0, float(each.getsockname()[1])))
    for number in until(seconds):
        with contextlib.suppress(OSError):
            sender.send(pack("/yehu/*/*/unit", number % 100 / 100.0))
        time.sleep(0.002)


def due_together(port: int, seconds: float) -> None:
    """As many scheduled messages as the server allows, all due at one time."""
    for _ in until(seconds):
        flood(port, 0.25, packet=bundle([FORCE] * 400, 0.5), most=75)


KINDS: dict[str, Attack] = {
    "quiet": quiet,
    "web_page": web_page,
    # By TCP: one long packet after another, sixty connections with two, or without an end.
    "long_bundle": partial(streams, data=prefixed(full_of(NOTHING, LONG))),
    "many_long": partial(streams, data=prefixed(full_of(NOTHING, LONG)), count=60, times=2),
    "many_streams": partial(streams, data=prefixed(full_of(FORCE, DATAGRAM)), count=60),
    "slip_without_end": partial(streams, data=END + b"/" + b"x" * (LONG - 2), count=8),
    "idle": partial(streams, data=b"", count=64, times=0),
    # What takes long to answer or to match, and patterns that match nothing.
    "questions": partial(flood, packet=full_of(pack("/yehu/get", "/*/*"), DATAGRAM)),
    "tables": partial(flood, packet=pack("/yehu/params"), ports=16, a_second=9600),
    "subscriptions": subscriptions,
    "due_together": due_together,
    "due_never": partial(
        flood, packet=bundle([pack("/yehu/ping", "x" * 16_000)], 1e6), a_second=2000
    ),
    # Small datagrams: what a busy program may send, and more than Python handles.
    "two_thousand": partial(flood, packet=FORCE, a_second=2000),
    "five_thousand": partial(flood, packet=FORCE, a_second=5000),
    "twenty_thousand": partial(flood, packet=FORCE, a_second=20_000),
    "of_two_hundred_ports": partial(flood, packet=FORCE, ports=200, a_second=20_000),
    "as_fast_as_it_goes": partial(flood, packet=FORCE),
}
