"""Sockets for OSC: UDP and TCP at one address, read by one thread, fast, and parsed later.

The socket is emptied before anything is parsed, so that a burst is kept by memory and not by
the kernel's small buffer. On Linux the kernel stamps what arrives, and tells what it dropped:
a message is as early as it truly was, however busy Python is.
"""

from __future__ import annotations

import contextlib
import ipaddress
import logging
import selectors
import socket
import struct
import sys
import threading
import time
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Protocol

from yehu_server.control.framing import Framing, FramingError
from yehu_server.errors import DeviceError, ParameterError

log = logging.getLogger(__name__)

BUFFER_BYTES = 32 << 20  # asked for; the system grants what it may
DATAGRAM_BYTES = 1 << 16
MOST_QUEUED = 1 << 17  # packets
READ_AT_ONCE, HANDLED_AT_ONCE = 4096, 64
MOST_CONNECTIONS = 64
MOST_UNSENT_BYTES = 1 << 20
LONGEST_WAIT_S = 0.5
TRIES_FOR_A_PORT = 20
# Linux's numbers for what Python's socket module does not name.
SO_RCVBUFFORCE, SO_TIMESTAMPNS, SO_RXQ_OVFL = 33, 35, 40

Network = ipaddress.IPv4Network | ipaddress.IPv6Network
Address = tuple[str, int]


class Peer(Protocol):
    """Someone who sent us something, and can be answered."""

    @property
    def name(self) -> str:
        """Host and port, for reading."""

    def send(self, packet: bytes) -> None:
        """Send a packet, or drop it where the peer does not take it."""

    def at(self, port: int) -> Peer:
        """The same host at a port of its choice."""


class Handler(Protocol):
    """What is done with packets; called from the socket's thread."""

    def handle(self, packet: bytes, peer: Peer, arrived_ns: int) -> None:
        """Act on one packet."""

    def tick(self) -> None:
        """Do what is due."""

    def wait_s(self) -> float | None:
        """Seconds until `tick` has something to do."""

    def gone(self, peer: Peer) -> None:
        """A peer has hung up."""


@dataclass
class Traffic:
    """What came and went, since the start."""

    packets: int = 0
    refused: int = 0  # from senders who are not allowed
    kernel_drops: int = 0  # found the socket's buffer full
    queue_drops: int = 0  # found our queue full
    unsent: int = 0
    failures: int = 0  # defects of ours
    connections: int = 0
    buffer_bytes: int = 0  # of the UDP socket, as granted


@dataclass(frozen=True)
class UdpPeer:
    """A sender of datagrams."""

    socket: socket.socket = field(compare=False)
    address: Address
    traffic: Traffic = field(compare=False)

    @property
    def name(self) -> str:
        """See `Peer`."""
        return f"{self.address[0]}:{self.address[1]}"

    def send(self, packet: bytes) -> None:
        """See `Peer`."""
        try:
            self.socket.sendto(packet, self.address)
        except OSError:
            self.traffic.unsent += 1

    def at(self, port: int) -> UdpPeer:
        """See `Peer`."""
        return UdpPeer(self.socket, (self.address[0], port, *self.address[2:]), self.traffic)


class TcpPeer:
    """One TCP connection."""

    def __init__(self, connection: socket.socket, address: Address, ports: OscPorts) -> None:
        self.socket = connection
        self.name = f"{address[0]}:{address[1]} (TCP)"
        self.framing = Framing()
        self.unsent = bytearray()
        self._ports = ports

    def send(self, packet: bytes) -> None:
        """See `Peer`; one who reads nothing for long is cut off."""
        self.unsent += self.framing.wrap(packet)
        self.flush()

    def flush(self) -> None:
        """Send what is waiting, as far as the peer takes it now."""
        try:
            while self.unsent:
                del self.unsent[: self.socket.send(self.unsent)]
        except BlockingIOError:
            pass
        except OSError:
            self.unsent.clear()
        if len(self.unsent) > MOST_UNSENT_BYTES:
            self._ports.hang_up(self)
        else:
            self._ports.watch(self)

    def at(self, port: int) -> TcpPeer:
        """See `Peer`: over a connection there is only one way back."""
        del port
        return self


class Allowed:
    """Which senders are heard.

    Errors: ParameterError for what is no network, such as ``192.168.1.0/24``.
    """

    def __init__(self, networks: Iterable[str] = ()) -> None:
        self._networks: list[Network] = []
        self._known: dict[str, bool] = {}
        for text in networks:
            try:
                self._networks.append(ipaddress.ip_network(text, strict=False))
            except ValueError:
                raise ParameterError(f"{text!r} is not a network, such as 192.168.1.0/24") from None

    def __contains__(self, host: str) -> bool:
        """Whether a host is heard: any, where no network is named."""
        if not self._networks:
            return True
        if host not in self._known:
            if len(self._known) > MOST_QUEUED:
                self._known.clear()
            address = ipaddress.ip_address(host.partition("%")[0])
            address = getattr(address, "ipv4_mapped", None) or address
            self._known[host] = any(address in network for network in self._networks)
        return self._known[host]


class OscPorts:
    """One UDP and one TCP port, and the thread that serves them.

    Errors: DeviceError where the address is taken or not this machine's.
    """

    def __init__(self, host: str, port: int, allowed: Allowed, handler: Handler) -> None:
        self.traffic = Traffic()
        self._allowed = allowed
        self._handler = handler
        self._queue: deque[tuple[bytes, Peer, int]] = deque()
        self._peers: dict[Address, UdpPeer] = {}
        self._selector = selectors.DefaultSelector()
        self._udp, self._tcp = _open(host, port)
        self.port = int(self._udp.getsockname()[1])
        self.host = str(self._udp.getsockname()[0])
        self.traffic.buffer_bytes = _widen(self._udp)
        self._wake_here, self._wake_there = socket.socketpair()
        for readable in (self._udp, self._tcp, self._wake_here):
            readable.setblocking(False)
            self._selector.register(readable, selectors.EVENT_READ)
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="OSC", daemon=True)

    def start(self) -> None:
        """Begin to serve."""
        self._thread.start()

    def stop(self) -> None:
        """Stop serving and close."""
        self._ending = True
        self._wake_there.send(b"!")
        if self._thread.is_alive():
            self._thread.join()
        for key in list(self._selector.get_map().values()):
            with contextlib.suppress(AttributeError):
                key.fileobj.close()  # type: ignore[union-attr]
        self._wake_there.close()
        self._selector.close()

    def _run(self) -> None:
        while not self._ending:
            asked = self._handler.wait_s()
            wait = LONGEST_WAIT_S if asked is None else min(asked, LONGEST_WAIT_S)
            for key, events in self._selector.select(0.0 if self._queue else wait):
                self._serve(key, events)
            try:
                for _ in range(min(HANDLED_AT_ONCE, len(self._queue))):
                    self._handler.handle(*self._queue.popleft())
                self._handler.tick()
            except Exception:  # a defect of ours must not silence the instrument's only ear
                self.traffic.failures += 1
                log.exception("OSC: a message could not be handled")

    def _serve(self, key: selectors.SelectorKey, events: int) -> None:
        if key.fileobj is self._udp:
            self._read_datagrams()
        elif key.fileobj is self._tcp:
            self._accept()
        elif isinstance(key.data, TcpPeer):
            if events & selectors.EVENT_WRITE:
                key.data.flush()
            if events & selectors.EVENT_READ:
                self._read_stream(key.data)

    def _read_datagrams(self) -> None:
        """Empty the socket, as far as one turn goes."""
        offset_ns = time.time_ns() - time.monotonic_ns()
        for _ in range(READ_AT_ONCE):
            try:
                packet, extras, _, address = self._udp.recvmsg(DATAGRAM_BYTES, 128)
            except BlockingIOError:
                return
            except OSError as error:  # of an earlier answer that nobody took
                log.debug("OSC: %s", error)
                continue
            arrived_ns = time.monotonic_ns() if not extras else 0
            for _, kind, data in extras:
                if kind == SO_TIMESTAMPNS:
                    seconds, ns = struct.unpack("qq", data[:16])
                    arrived_ns = min(seconds * 10**9 + ns - offset_ns, time.monotonic_ns())
                elif kind == SO_RXQ_OVFL:
                    self.traffic.kernel_drops = struct.unpack("I", data[:4])[0]
            if address[0] in self._allowed:
                self._enqueue(packet, self._peer(address), arrived_ns)
            else:
                self.traffic.refused += 1

    def _peer(self, address: Address) -> UdpPeer:
        peer = self._peers.get(address)
        if peer is None:
            if len(self._peers) > READ_AT_ONCE:
                self._peers.clear()
            peer = self._peers[address] = UdpPeer(self._udp, address, self.traffic)
        return peer

    def _enqueue(self, packet: bytes, peer: Peer, arrived_ns: int) -> None:
        self.traffic.packets += 1
        if len(self._queue) >= MOST_QUEUED:
            self.traffic.queue_drops += 1
        else:
            self._queue.append((packet, peer, arrived_ns))

    # -- TCP -----------------------------------------------------------------------------------

    def _accept(self) -> None:
        try:
            connection, address = self._tcp.accept()
        except OSError:
            return
        if address[0] not in self._allowed or self.traffic.connections >= MOST_CONNECTIONS:
            self.traffic.refused += 1
            connection.close()
            return
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.traffic.connections += 1
        self._selector.register(
            connection, selectors.EVENT_READ, TcpPeer(connection, address, self)
        )

    def _read_stream(self, peer: TcpPeer) -> None:
        # Not read while we are behind: the sender waits, and nothing is lost.
        if len(self._queue) >= READ_AT_ONCE:
            return
        try:
            data = peer.socket.recv(DATAGRAM_BYTES)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        arrived_ns = time.monotonic_ns()
        try:
            for packet in peer.framing.packets(data):
                self._enqueue(packet, peer, arrived_ns)
        except FramingError as error:
            log.warning("OSC: %s: %s; connection closed", peer.name, error)
            data = b""
        if not data:
            self.hang_up(peer)

    def watch(self, peer: TcpPeer) -> None:
        """Wait until a peer takes more, where it has not taken all."""
        events = selectors.EVENT_READ | (selectors.EVENT_WRITE if peer.unsent else 0)
        with contextlib.suppress(KeyError, ValueError):
            self._selector.modify(peer.socket, events, peer)

    def hang_up(self, peer: TcpPeer) -> None:
        """Close a connection."""
        peer.unsent.clear()
        try:
            self._selector.unregister(peer.socket)
        except (KeyError, ValueError):
            return  # already closed
        peer.socket.close()
        self.traffic.connections -= 1
        self._handler.gone(peer)


def parse_address(text: str, default_host: str, default_port: int) -> Address:
    """Read ``HOST:PORT``, ``HOST`` or ``:PORT``. Errors: ParameterError."""
    host, colon, port = text.rpartition(":")
    if not colon or text.endswith("]"):
        host, port = text, ""
    try:
        number = int(port) if port else default_port
    except ValueError:
        number = -1
    if not 0 <= number <= 65535:
        raise ParameterError(f"{text!r}: expected HOST:PORT, such as 127.0.0.1:9000")
    return host.strip("[]") or default_host, number


def _open(host: str, port: int) -> tuple[socket.socket, socket.socket]:
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0][0]
        for _ in range(TRIES_FOR_A_PORT if port == 0 else 0):
            with contextlib.suppress(OSError):  # free on UDP, but not on TCP
                return _bind(family, host, port)
        return _bind(family, host, port)
    except OSError as error:
        where = f"{host}:{port}"
        raise DeviceError(f"OSC: cannot listen at {where}: {error.strerror or error}") from error


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


def _widen(udp: socket.socket) -> int:
    """Ask for a large buffer, and for the kernel's stamps and counts; return what is granted."""
    with contextlib.suppress(OSError):
        udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
    if sys.platform == "linux":
        with contextlib.suppress(OSError):  # for the privileged only
            udp.setsockopt(socket.SOL_SOCKET, SO_RCVBUFFORCE, BUFFER_BYTES)
        for option in (SO_TIMESTAMPNS, SO_RXQ_OVFL):
            with contextlib.suppress(OSError):
                udp.setsockopt(socket.SOL_SOCKET, option, 1)
    return udp.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
