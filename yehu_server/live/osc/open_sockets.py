"""Open the sockets for OSC and read datagrams with the kernel's time stamps; who uses an address.

A call that lets go of the GIL may get it back only after a busy thread's turn. So on Linux a burst
is read by one call that keeps it (``recvmmsg``, which does not wait); elsewhere each datagram takes
a call.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import http.client
import itertools
import json
import logging
import socket
import struct
import sys
import time
from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import Any

import numpy as np

from yehu_server.errors import DeviceError
from yehu_server.live.network import Address, format_address
from yehu_server.live.osc.packets import PacketError, pack, unpack
from yehu_server.params.table import PREFIX
from yehu_server.util.files import why

BUFFER_BYTES = 32 << 20  # asked for; the system may grant less
DATAGRAM_BYTES = 1 << 14  # longer ones are dropped: a few would fill the system's buffer
TRIES_FOR_A_PORT = 20
# Linux's numbers of options that Python's socket module does not name.
SO_ATTACH_FILTER, SO_RCVBUFFORCE, SO_TIMESTAMPNS, SO_RXQ_OVFL = 26, 33, 35, 40
UDP_HEADER_BYTES = 8
MOST_MUTED = 256  # senders; the system bounds the size of a filter
# A kernel filter (BPF) that drops datagrams before they take room in the buffer.
DROP, KEEP = (0x06, 0, 0, 0), (0x06, 0, 0, 0xFFFFFFFF)
DROP_LONGER = (
    (0x80, 0, 0, 0),  # load the length
    (0x25, 0, 1, DATAGRAM_BYTES + UDP_HEADER_BYTES),  # skip one if it is no more than this
    DROP,
)
LOAD_SENDER = (  # its address in IPv4, XOR its port in the upper half
    (0x28, 0, 0, 0),  # load the port
    (0x64, 0, 0, 16),  # shift it to the left
    (0x07, 0, 0, 0),  # put it aside
    (0x20, 0, 0, 0xFFF00000 + 12),  # load the address, from the IP header
    (0xAC, 0, 0, 0),  # XOR what is aside
)
SKIP_UNLESS = 0x15
# Of who is asked at an address in use.
ANSWERS_WITHIN_S = 0.3
ANSWER_BYTES = 1 << 16
NAME = "yehu-server"  # in HOST_INFO of OSCQuery
LOCAL = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # noqa: S104 - nothing is bound


def open_both(host: str, port: int) -> tuple[socket.socket, socket.socket]:
    """Open UDP and TCP sockets at an address; raises DeviceError where it is in use or not ours."""
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0][0]
        for _ in range(TRIES_FOR_A_PORT if port == 0 else 0):
            with contextlib.suppress(OSError):  # in use for TCP only
                return _bind(family, host, port)
        return _bind(family, host, port)
    except OSError as error:
        raise DeviceError(
            f"OSC: cannot listen at {format_address(host, port)}: {why(error)}"
            f"{by_whom(error, host, port, plays_at)}"
        ) from error


def _bind(family: int, host: str, port: int) -> tuple[socket.socket, socket.socket]:
    with contextlib.ExitStack() as undo:
        udp = undo.enter_context(socket.socket(family, socket.SOCK_DGRAM))
        tcp = undo.enter_context(socket.socket(family, socket.SOCK_STREAM))
        udp.bind((host, port))
        tcp.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        tcp.bind((host, udp.getsockname()[1]))
        tcp.listen()
        undo.pop_all()
    return udp, tcp


def widen(udp: socket.socket) -> int:
    """Ask for a large receive buffer, and for the kernel's time stamps, drop counts and filter.

    Returns the size of the buffer that is granted (bytes).
    """
    with contextlib.suppress(OSError):
        udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
    if sys.platform == "linux":
        with contextlib.suppress(OSError):  # with privileges only
            udp.setsockopt(socket.SOL_SOCKET, SO_RCVBUFFORCE, BUFFER_BYTES)
        for option in (SO_TIMESTAMPNS, SO_RXQ_OVFL):
            with contextlib.suppress(OSError):
                udp.setsockopt(socket.SOL_SOCKET, option, 1)
    mute(udp, ())
    return udp.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)


def mute(udp: socket.socket, senders: Iterable[Address]) -> None:
    """Let Linux drop what is too long, all datagrams of some senders (by IPv4), and no others."""
    if sys.platform != "linux":
        return
    lines = [*DROP_LONGER, *LOAD_SENDER]
    for host, port in itertools.islice(senders, MOST_MUTED if udp.family == socket.AF_INET else 0):
        (number,) = struct.unpack(">I", socket.inet_aton(host))
        lines += [(SKIP_UNLESS, 0, 1, number ^ port << 16), DROP]
    program = b"".join(struct.pack("HBBI", *line) for line in (*lines, KEEP))
    buffer = ctypes.create_string_buffer(program, len(program))
    with contextlib.suppress(OSError):
        described = struct.pack("HP", len(lines) + 1, ctypes.addressof(buffer))
        udp.setsockopt(socket.SOL_SOCKET, SO_ATTACH_FILTER, described)


def by_whom(error: OSError, host: str, port: int, asks: Callable[[str, int], bool]) -> str:
    """What to add to an error of binding: whether a yehu-server is there; else nothing."""
    if error.errno != errno.EADDRINUSE or not asks(LOCAL.get(host, host), port):
        return ""
    return " by a running yehu-server; end it there, or play beside it: --osc :9010 --http :9011"


def plays_at(host: str, port: int) -> bool:
    """Whether a yehu-server answers OSC at an address."""
    with contextlib.suppress(OSError, PacketError):
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        with socket.socket(family, kind) as asking:
            asking.settimeout(ANSWERS_WITHIN_S)
            asking.connect(address)
            asking.send(pack(f"{PREFIX}/ping"))
            answers = unpack(asking.recv(ANSWER_BYTES))
            return any(answer.address == f"{PREFIX}/pong" for answer in answers)
    return False


def serves_at(host: str, port: int) -> bool:
    """Whether a yehu-server answers OSCQuery at an address."""
    connection = http.client.HTTPConnection(host, port, timeout=ANSWERS_WITHIN_S)
    with contextlib.suppress(OSError, http.client.HTTPException, ValueError):
        with contextlib.closing(connection):
            connection.request("GET", "/?HOST_INFO")
            told = json.loads(connection.getresponse().read(ANSWER_BYTES))
        return isinstance(told, dict) and str(told.get("NAME", "")).startswith(NAME)
    return False


log = logging.getLogger(__name__)

AT_ONCE = 128
Datagram = tuple[bytes, Address, int]  # the time of arrival in monotonic ns
SLOT_BYTES = DATAGRAM_BYTES + 1  # one more shows that a datagram is too long
NAME_BYTES, CONTROL_BYTES = 28, 128
ALIGNED = 8  # bytes, of a control message
STAMP, COUNT, CONTROL = struct.Struct("qq"), struct.Struct("I"), struct.Struct("Nii")
VECTOR = [("base", "u8"), ("length", "u8")]  # Linux's ``struct iovec`` of 64 bits
HEADER = np.dtype(  # and ``struct mmsghdr``
    [
        ("name", "u8"),
        ("name_length", "u4"),
        ("vectors", "u8"),
        ("vector_count", "u8"),
        ("control", "u8"),
        ("control_length", "u8"),
        ("flags", "u8"),  # with padding
        ("length", "u4"),
    ],
    align=True,
)


class SingleReader:
    """Reads each datagram of a socket by a call."""

    def __init__(self, udp: socket.socket) -> None:
        self.dropped = 0  # by the kernel since the start, its buffer being full, where it tells
        self._udp = udp

    def read(self) -> tuple[list[Datagram], bool]:
        """The next datagrams, `AT_ONCE` at most, and whether there may be more."""
        found: list[Datagram] = []
        for _ in range(AT_ONCE):
            try:
                packet, address = self._udp.recvfrom(SLOT_BYTES)
            except BlockingIOError:
                return found, False
            except OSError as error:  # an earlier answer was refused at its port
                log.debug("OSC: %s", error)
                continue
            found.append((packet, address, time.monotonic_ns()))
        return found, True


class BatchReader(SingleReader):
    """Reads all waiting datagrams by one call, which keeps the GIL."""

    def __init__(self, udp: socket.socket, recvmmsg: Callable[..., int]) -> None:
        super().__init__(udp)
        self._recvmmsg = recvmmsg
        self._data = np.zeros((AT_ONCE, SLOT_BYTES), np.uint8)
        self._names = np.zeros((AT_ONCE, NAME_BYTES), np.uint8)
        self._controls = np.zeros((AT_ONCE, CONTROL_BYTES), np.uint8)
        self._vectors, self._headers = np.zeros(AT_ONCE, VECTOR), np.zeros(AT_ONCE, HEADER)
        self._vectors["base"], self._vectors["length"] = _places(self._data), SLOT_BYTES
        self._headers["name"], self._headers["control"] = map(
            _places, (self._names, self._controls)
        )
        self._headers["vectors"], self._headers["vector_count"] = _places(self._vectors), 1
        self._place = ctypes.c_void_p(self._headers.ctypes.data)

    def read(self) -> tuple[list[Datagram], bool]:
        """See `SingleReader`."""
        headers = self._headers
        headers["name_length"], headers["control_length"] = NAME_BYTES, CONTROL_BYTES
        count = self._recvmmsg(self._udp.fileno(), self._place, AT_ONCE, socket.MSG_DONTWAIT, None)
        if count <= 0:  # nothing there, or an earlier answer was refused at its port
            return [], False
        now_ns = time.monotonic_ns()
        offset_ns = time.time_ns() - now_ns
        found = []
        lengths = (headers[name][:count].tolist() for name in ("length", "control_length"))
        for i, (length, control_length) in enumerate(zip(*lengths, strict=True)):
            stamp_ns = self._stamp(self._controls[i, :control_length].tobytes())
            arrived_ns = min(stamp_ns - offset_ns, now_ns) if stamp_ns else now_ns
            address = _address(self._names[i].tobytes())
            found.append((self._data[i, :length].tobytes(), address, arrived_ns))
        return found, count == AT_ONCE

    def _stamp(self, controls: bytes) -> int:
        """The time stamp in control messages, or 0; takes the count of drops from them too."""
        at, stamp_ns = 0, 0
        while at + CONTROL.size <= len(controls):
            length, _, kind = CONTROL.unpack_from(controls, at)
            if kind == SO_TIMESTAMPNS:
                seconds, ns = STAMP.unpack_from(controls, at + CONTROL.size)
                stamp_ns = seconds * 10**9 + ns
            elif kind == SO_RXQ_OVFL:
                (self.dropped,) = COUNT.unpack_from(controls, at + CONTROL.size)
            at += max(CONTROL.size, -(-length // ALIGNED) * ALIGNED)
        return stamp_ns


def datagrams(udp: socket.socket) -> SingleReader:
    """The best reader of a socket that there is."""
    if sys.platform == "linux" and struct.calcsize("P") == struct.calcsize("q"):
        library = ctypes.PyDLL(None)
        if hasattr(library, "recvmmsg"):
            return BatchReader(udp, library.recvmmsg)
    return SingleReader(udp)


def _places(rows: Any) -> Any:
    """The addresses in memory of an array's rows."""
    return rows.ctypes.data + rows.strides[0] * np.arange(len(rows))


@lru_cache(maxsize=1024)
def _address(name: bytes) -> Any:
    """A ``struct sockaddr`` as Python's sockets tell it."""
    (family,), (port,) = struct.unpack_from("H", name), struct.unpack_from(">H", name, 2)
    if family == socket.AF_INET:
        return socket.inet_ntop(family, name[4:8]), port
    flow, scope = struct.unpack_from(">I", name, 4)[0], struct.unpack_from("I", name, 24)[0]
    return socket.inet_ntop(socket.AF_INET6, name[8:24]), port, flow, scope
