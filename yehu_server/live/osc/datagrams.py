"""Read datagrams with the kernel's time stamps, as many as there are by one call of the system.

A call that lets go of the GIL may get it back only after a busy thread's turn. So on Linux a burst
is read by one call that keeps it (``recvmmsg``, which does not wait); elsewhere each datagram takes
a call.
"""

from __future__ import annotations

import ctypes
import logging
import socket
import struct
import sys
import time
from collections.abc import Callable
from typing import Any, Protocol

from yehu_server.live.addresses import Address
from yehu_server.live.osc.listening import DATAGRAM_BYTES, SO_RXQ_OVFL, SO_TIMESTAMPNS

log = logging.getLogger(__name__)

AT_ONCE = 128
Datagram = tuple[bytes, Address, int]  # the time of arrival in monotonic ns
SLOT_BYTES = DATAGRAM_BYTES + 1  # one more shows that a datagram is too long
NAME_BYTES, CONTROL_BYTES = 28, 128
MOST_NAMES = 1024
ALIGNED = 8  # bytes, of a control message
STAMP, COUNT, CONTROL = struct.Struct("qq"), struct.Struct("I"), struct.Struct("Nii")


class Datagrams(Protocol):
    """The datagrams of a socket."""

    dropped: int  # by the kernel since the start, its buffer being full

    def read(self) -> tuple[list[Datagram], bool]:
        """The next datagrams, `AT_ONCE` at most, and whether there may be more."""


def datagrams(udp: socket.socket) -> Datagrams:
    """The best reader of a socket that there is."""
    if sys.platform == "linux" and struct.calcsize("P") == struct.calcsize("q"):
        library = ctypes.PyDLL(None)
        if hasattr(library, "recvmmsg"):
            return BatchReader(udp, library.recvmmsg)
    return SingleReader(udp)


class _Vector(ctypes.Structure):
    _fields_ = (("base", ctypes.c_void_p), ("length", ctypes.c_size_t))


class _Header(ctypes.Structure):
    """Linux's ``struct mmsghdr``."""

    _fields_ = (
        ("name", ctypes.c_void_p),
        ("name_length", ctypes.c_uint32),
        ("vectors", ctypes.c_void_p),
        ("vector_count", ctypes.c_size_t),
        ("control", ctypes.c_void_p),
        ("control_length", ctypes.c_size_t),
        ("flags", ctypes.c_int64),  # with padding
        ("length", ctypes.c_uint32),
    )


class BatchReader:
    """Reads all waiting datagrams by one call, which keeps the GIL."""

    def __init__(self, udp: socket.socket, recvmmsg: Callable[..., int]) -> None:
        self.dropped = 0
        self._udp = udp
        self._recvmmsg = recvmmsg
        self._data = bytearray(AT_ONCE * SLOT_BYTES)
        self._names = bytearray(AT_ONCE * NAME_BYTES)
        self._controls = bytearray(AT_ONCE * CONTROL_BYTES)
        self._headers = (_Header * AT_ONCE)()
        self._addresses: dict[bytes, Address] = {}
        data, names, controls = (
            ctypes.addressof(ctypes.c_char.from_buffer(memory))
            for memory in (self._data, self._names, self._controls)
        )
        self._vectors = (_Vector * AT_ONCE)()
        for i, (header, vector) in enumerate(zip(self._headers, self._vectors, strict=True)):
            vector.base, vector.length = data + i * SLOT_BYTES, SLOT_BYTES
            header.name, header.control = names + i * NAME_BYTES, controls + i * CONTROL_BYTES
            header.vectors, header.vector_count = ctypes.addressof(vector), 1
        self._prepare(AT_ONCE)

    def _prepare(self, count: int) -> None:
        """Set anew what the kernel overwrites."""
        for i in range(count):
            header = self._headers[i]
            header.name_length, header.control_length = NAME_BYTES, CONTROL_BYTES

    def read(self) -> tuple[list[Datagram], bool]:
        """See `Datagrams`."""
        count = self._recvmmsg(
            self._udp.fileno(), self._headers, AT_ONCE, socket.MSG_DONTWAIT, None
        )
        if count <= 0:  # nothing there, or an earlier answer was refused at its port
            return [], False
        now_ns = time.monotonic_ns()
        offset_ns = time.time_ns() - now_ns
        found = []
        for i in range(count):
            header = self._headers[i]
            start, name, control = i * SLOT_BYTES, i * NAME_BYTES, i * CONTROL_BYTES
            packet = bytes(self._data[start : start + header.length])
            address = self._address(bytes(self._names[name : name + header.name_length]))
            arrived_ns = self._arrived(control, control + header.control_length, offset_ns)
            found.append((packet, address, min(arrived_ns or now_ns, now_ns)))
        self._prepare(count)
        return found, count == AT_ONCE

    def _arrived(self, at: int, end: int, offset_ns: int) -> int:
        """The stamp in control messages, or 0; takes the count of drops from them too."""
        arrived_ns = 0
        while at + CONTROL.size <= end:
            length, _, kind = CONTROL.unpack_from(self._controls, at)
            if kind == SO_TIMESTAMPNS:
                seconds, ns = STAMP.unpack_from(self._controls, at + CONTROL.size)
                arrived_ns = seconds * 10**9 + ns - offset_ns
            elif kind == SO_RXQ_OVFL:
                (self.dropped,) = COUNT.unpack_from(self._controls, at + CONTROL.size)
            at += max(CONTROL.size, -(-length // ALIGNED) * ALIGNED)
        return arrived_ns

    def _address(self, name: bytes) -> Address:
        """A ``struct sockaddr`` as Python's sockets tell it."""
        address = self._addresses.get(name)
        if address is None:
            address = _parse_sockaddr(name)
            if len(self._addresses) >= MOST_NAMES:
                self._addresses.clear()
            self._addresses[name] = address
        return address


def _parse_sockaddr(name: bytes) -> Any:
    (family,), (port,) = struct.unpack_from("H", name), struct.unpack_from(">H", name, 2)
    if family == socket.AF_INET:
        return socket.inet_ntop(family, name[4:8]), port
    flow, scope = struct.unpack_from(">I", name, 4)[0], struct.unpack_from("I", name, 24)[0]
    return socket.inet_ntop(socket.AF_INET6, name[8:24]), port, flow, scope


class SingleReader:
    """Reads each datagram by a call."""

    def __init__(self, udp: socket.socket) -> None:
        self.dropped = 0
        self._udp = udp

    def read(self) -> tuple[list[Datagram], bool]:
        """See `Datagrams`."""
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
