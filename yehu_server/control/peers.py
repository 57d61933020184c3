"""Who sends us OSC, and how to answer: by datagram, or over a connection.

None is answered without bound: a sender of datagrams so many bytes a second, since few that ask
can ask for much, and not even for itself; over a connection, what the other end takes.
"""

from __future__ import annotations

import selectors
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from yehu_server.control.addresses import Address
from yehu_server.control.allowance import Allowance
from yehu_server.control.framing import Framing

MOST_UNSENT_BYTES = 1 << 18  # to one peer
ANSWERED_AT_ONCE_BYTES, ANSWERED_BYTES_A_SECOND = 1 << 17, 1 << 17


class Peer(Protocol):
    """Someone who sent us something, and can be answered."""

    @property
    def name(self) -> str:
        """Host and port, for reading."""

    @property
    def host(self) -> str:
        """The host's address."""

    @property
    def takes_more(self) -> bool:
        """Whether there is room to tell it what it need not be told now."""

    def send(self, packet: bytes) -> None:
        """Send a packet, or drop it where the peer does not take it."""

    def at(self, port: int) -> Peer:
        """The same host at a port of its choice."""


@dataclass
class Traffic:
    """What came and went, since the start."""

    packets: int = 0
    refused: int = 0  # from senders who are not allowed, and connections that are not OSC
    excess: int = 0  # found no room beside others
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


def _answers() -> Allowance:
    """The bytes that a sender of datagrams may be answered."""
    return Allowance(ANSWERED_BYTES_A_SECOND, ANSWERED_AT_ONCE_BYTES)


@dataclass(frozen=True)
class UdpPeer:
    """A sender of datagrams."""

    socket: socket.socket = field(compare=False)
    address: Address
    traffic: Traffic = field(compare=False)
    allowance: Allowance = field(default_factory=_answers, compare=False)

    @property
    def name(self) -> str:
        """See `Peer`."""
        return f"{self.address[0]}:{self.address[1]}"

    @property
    def host(self) -> str:
        """See `Peer`."""
        return self.address[0]

    @property
    def takes_more(self) -> bool:
        """See `Peer`."""
        return self.allowance.left(time.monotonic()) > 0.0

    def send(self, packet: bytes) -> None:
        """See `Peer`."""
        if not self.takes_more:
            self.traffic.unsent += 1
            return
        self.allowance.spend(len(packet))
        try:
            self.socket.sendto(packet, self.address)
        except OSError:
            self.traffic.unsent += 1

    def at(self, port: int) -> UdpPeer:
        """See `Peer`; what is sent there counts for who asked for it."""
        address = (self.address[0], port, *self.address[2:])
        return UdpPeer(self.socket, address, self.traffic, self.allowance)


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
        self.host = address[0]
        self.framing = Framing()
        self.has_spoken = False  # a whole packet
        self.heard_s = time.monotonic()  # when it last spoke, or came
        self.is_being_heard = False  # then no more of it is read
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
    def takes_more(self) -> bool:
        """See `Peer`."""
        return len(self._unsent) < MOST_UNSENT_BYTES // 2

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
