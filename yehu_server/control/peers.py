"""Who sends us OSC, and how to answer: by datagram, or over a connection."""

from __future__ import annotations

import selectors
import socket
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from yehu_server.control.addresses import Address
from yehu_server.control.framing import Framing

MOST_UNSENT_BYTES = 1 << 20


class Peer(Protocol):
    """Someone who sent us something, and can be answered."""

    @property
    def name(self) -> str:
        """Host and port, for reading."""

    def send(self, packet: bytes) -> None:
        """Send a packet, or drop it where the peer does not take it."""

    def at(self, port: int) -> Peer:
        """The same host at a port of its choice."""


@dataclass
class Traffic:
    """What came and went, since the start."""

    packets: int = 0
    refused: int = 0  # from senders who are not allowed
    kernel_drops: int = 0  # found the socket's buffer full
    unsent: int = 0
    failures: int = 0  # defects of ours
    connections: int = 0
    buffer_bytes: int = 0  # of the UDP socket, as granted


@dataclass
class WebTraffic:
    """What came and went by HTTP and WebSocket, since the start."""

    requests: int = 0
    refused: int = 0
    failures: int = 0  # defects of ours
    unsent: int = 0
    web_sockets: int = 0  # that are open


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
    """One TCP connection.

    `watch` is told when there is something else to wait for, `hear_out` when the peer is gone.
    """

    def __init__(
        self,
        connection: socket.socket,
        address: Address,
        traffic: Traffic,
        watch: Callable[[TcpPeer], None],
        hear_out: Callable[[TcpPeer], None],
    ) -> None:
        self.socket = connection
        self.name = f"{address[0]}:{address[1]} (TCP)"
        self.framing = Framing()
        self.reads = True  # until the peer will say no more
        self._unsent = bytearray()
        self._finished = False
        self._traffic = traffic
        self._watch = watch
        self._hear_out = hear_out

    @property
    def is_finished(self) -> bool:
        """Whether nothing more will be sent."""
        return self._finished

    @property
    def events(self) -> int:
        """What to wait for, for a selector."""
        return (selectors.EVENT_READ if self.reads else 0) | (
            selectors.EVENT_WRITE if self._unsent else 0
        )

    def send(self, packet: bytes) -> None:
        """See `Peer`; one who reads nothing for long misses what does not fit."""
        if len(self._unsent) > MOST_UNSENT_BYTES:
            self._traffic.unsent += 1
        elif not self._finished:
            self._unsent += self.framing.wrap(packet)
            self.flush()

    def flush(self) -> None:
        """Send what is waiting, as far as the peer takes it now."""
        try:
            while self._unsent:
                del self._unsent[: self.socket.send(self._unsent)]
        except BlockingIOError:
            pass
        except OSError:
            self.cut_off()
        self._watch(self)

    def cut_off(self) -> None:
        """Say and hear no more."""
        self._unsent.clear()
        self._finished = True
        if self.reads:
            self._hear_out(self)

    def finish(self) -> None:
        """Close as soon as the peer has taken what is waiting."""
        self._finished = True
        self._watch(self)

    def at(self, port: int) -> TcpPeer:
        """See `Peer`: over a connection there is only one way back."""
        del port
        return self
