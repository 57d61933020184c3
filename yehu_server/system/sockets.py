"""Datagrams with the kernel's time stamps, and sockets that a child process serves."""

import base64
import contextlib
import socket
import struct
import sys
from collections.abc import Sequence
from typing import NamedTuple

# Linux's numbers of options that Python's socket module does not name.
SO_RCVBUFFORCE, SO_TIMESTAMPNS, SO_RXQ_OVFL = 33, 35, 40
STAMP, COUNT = struct.Struct("@ll"), struct.Struct("@I")  # struct timespec, of the kernel
TRUNCATED = int(socket.MSG_TRUNC)  # as a plain number: the enumeration's is ten times as slow
TOO_LONG = 10040  # WSAEMSGSIZE
UNKNOWN = ("0.0.0.0", 0)  # noqa: S104 - whose datagram Windows does not say


class Datagram(NamedTuple):
    """A datagram, and what the kernel says of it."""

    packet: bytes
    address: tuple[str, int]
    is_whole: bool
    stamp_ns: int  # time of arrival (ns since 1970); 0 where the kernel does not say
    drops: int  # how many it has dropped since the start


def prepare(udp: socket.socket, buffer_bytes: int) -> int:
    """Ask for a large receive buffer, and for the kernel's time stamps and counts of drops.

    Returns the size of the buffer that is granted (bytes).
    """
    with contextlib.suppress(OSError):
        udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
    if sys.platform == "linux":
        with contextlib.suppress(OSError):  # with privileges only
            udp.setsockopt(socket.SOL_SOCKET, SO_RCVBUFFORCE, buffer_bytes)
        for option in (SO_TIMESTAMPNS, SO_RXQ_OVFL):
            with contextlib.suppress(OSError):
                udp.setsockopt(socket.SOL_SOCKET, option, 1)
    return udp.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)


if sys.platform == "win32":

    def receive(udp: socket.socket, most_bytes: int) -> Datagram:
        """Receive a datagram; raises OSError as `socket.recv`.

        Windows raises ConnectionResetError once for each answer that was refused at its port.
        """
        try:
            packet, address = udp.recvfrom(most_bytes)
        except OSError as error:
            if error.winerror != TOO_LONG:
                raise
            return Datagram(b"", UNKNOWN, is_whole=False, stamp_ns=0, drops=0)
        return Datagram(packet, address, is_whole=True, stamp_ns=0, drops=0)

    def share(shared: socket.socket, process: int) -> str:
        """What a child process, whose number is given, makes the same socket of."""
        return base64.b64encode(shared.share(process)).decode()

    def shared(handle: str) -> socket.socket:
        """The socket that the parent process shares."""
        return socket.fromshare(base64.b64decode(handle))

    def inherited(_shared: socket.socket) -> list[int]:
        """Descriptors that a child has to inherit."""
        return []

else:
    CONTROL_BYTES = socket.CMSG_SPACE(STAMP.size) + socket.CMSG_SPACE(COUNT.size)

    def receive(udp: socket.socket, most_bytes: int) -> Datagram:
        """Receive a datagram; raises OSError as `socket.recv`."""
        packet, controls, flags, address = udp.recvmsg(most_bytes, CONTROL_BYTES)
        stamp_ns, drops = stamp_and_drops(controls)
        return Datagram(packet, address, not flags & TRUNCATED, stamp_ns, drops)

    def share(shared: socket.socket, _process: int) -> int:
        """What a child process, whose number is given, makes the same socket of."""
        return shared.fileno()

    def shared(handle: int) -> socket.socket:
        """The socket that the parent process shares."""
        return socket.socket(fileno=handle)

    def inherited(shared: socket.socket) -> list[int]:
        """Descriptors that a child has to inherit."""
        return [shared.fileno()]


def stamp_and_drops(controls: Sequence[tuple[int, int, bytes]]) -> tuple[int, int]:
    """What the kernel adds to a datagram (`prepare`), each 0 where it does not."""
    stamp_ns = drops = 0
    for _level, kind, data in controls:
        if kind == SO_TIMESTAMPNS and len(data) == STAMP.size:
            seconds, ns = STAMP.unpack(data)
            stamp_ns = seconds * 10**9 + ns
        elif kind == SO_RXQ_OVFL and len(data) == COUNT.size:
            (drops,) = COUNT.unpack(data)
    return stamp_ns, drops
