"""The peers that send OSC, and how each is answered: by datagram, or over a connection.

Answers are limited, since a small request may have large ones. Each port of this machine that
sends datagrams has a token bucket of bytes; another host, whose address may be forged, has one for
all of its ports, and all other hosts share a larger one. A connection gets what its other end
reads.
"""

from __future__ import annotations

import selectors
import socket
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from yehu_server.live.network import Address
from yehu_server.live.osc.framing import Framing
from yehu_server.util.token_bucket import TokenBucket

MOST_UNSENT_BYTES = 1 << 18  # waiting for one peer
ANSWERED_BYTES = 1 << 17  # to a port, at once and a second
TO_A_HOST, TO_ALL_HOSTS = 2, 16  # times as much


class Peer(Protocol):
    """A sender of OSC, which can be answered."""

    @property
    def host(self) -> str:
        """IP address of the host."""

    @property
    def takes_more(self) -> bool:
        """Whether it may be sent more than it must be."""

    def send(self, packet: bytes) -> None:
        """Send a packet, or drop it where the limit is reached."""

    def at(self, port: int) -> Peer:
        """A peer at another port of the same host."""


@dataclass
class Traffic:
    """Counters of OSC traffic since the start, and what there is now."""

    packets: int = 0
    refused: int = 0  # packets from senders that are not allowed, and refused connections
    excess: int = 0  # packets dropped because too many wait
    kernel_drops: int = 0  # packets dropped by the kernel, its buffer being full
    unsent: int = 0
    failures: int = 0  # messages that met a defect of the server
    connections: int = 0
    buffer_bytes: int = 0  # of the UDP socket, as the kernel grants


@dataclass
class WebTraffic:
    """Counters of HTTP and WebSocket traffic since the start, and what there is now."""

    requests: int = 0
    refused: int = 0
    failures: int = 0  # requests that met a defect of the server
    unsent: int = 0
    web_sockets: int = 0  # open now


def answer_bucket(times: int = 1) -> TokenBucket:
    """The bytes of answers to a port, or to several together."""
    return TokenBucket(times * ANSWERED_BYTES, times * ANSWERED_BYTES)


@dataclass(frozen=True)
class UdpPeer:
    """A sender of datagrams; bytes that it is sent are taken from each of its buckets."""

    socket: socket.socket = field(compare=False)
    address: Address
    traffic: Traffic = field(compare=False)
    buckets: Sequence[TokenBucket] = field(compare=False)

    @property
    def host(self) -> str:
        """See `Peer`."""
        return self.address[0]

    @property
    def takes_more(self) -> bool:
        """See `Peer`."""
        now = time.monotonic()
        return all(bucket.left(now) > 0.0 for bucket in self.buckets)

    def send(self, packet: bytes) -> None:
        """See `Peer`."""
        if not self.takes_more:
            self.traffic.unsent += 1
            return
        for bucket in self.buckets:
            bucket.spend(len(packet))
        try:
            self.socket.sendto(packet, self.address)
        except OSError:
            self.traffic.unsent += 1

    def at(self, port: int) -> UdpPeer:
        """See `Peer`; bytes sent there count for this peer too."""
        address = (self.address[0], port, *self.address[2:])
        return UdpPeer(self.socket, address, self.traffic, self.buckets)


class TcpPeer:
    """A TCP connection.

    `watch`: called with the peer when its `events` may have changed.
    `drain_and_close`: called with the peer when its connection is broken.
    """

    def __init__(
        self,
        connection: socket.socket,
        address: Address,
        traffic: Traffic,
        watch: Callable[[TcpPeer], None],
        drain_and_close: Callable[[TcpPeer], None],
    ) -> None:
        self.socket = connection
        self.name = f"{address[0]}:{address[1]} (TCP)"
        self.host = address[0]
        self.framing = Framing()
        self.has_sent_packet = False  # sent a whole packet
        self.last_packet_s = time.monotonic()  # time of its last packet, or of its connecting
        self.has_pending_packets = False  # packets of it wait or are handled; no more are read
        self.reads = True  # until its end of the connection is closed
        self._unsent = bytearray()
        self._finished = False
        self._traffic = traffic
        self._watch = watch
        self._drain_and_close = drain_and_close

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
        """The events that a selector should wait for."""
        return (selectors.EVENT_READ if self.reads else 0) | (
            selectors.EVENT_WRITE if self._unsent else 0
        )

    def send(self, packet: bytes) -> None:
        """See `Peer`; packets are dropped while the peer does not read."""
        if len(self._unsent) > MOST_UNSENT_BYTES:
            self._traffic.unsent += 1
        elif not self._finished:
            self._unsent += self.framing.wrap(packet)
            self.flush()

    def flush(self) -> None:
        """Send waiting bytes, as many as the connection takes now."""
        try:
            while self._unsent:
                del self._unsent[: self.socket.send(self._unsent)]
        except BlockingIOError:
            pass
        except OSError:
            self.cut_off()
        self._watch(self)

    def cut_off(self) -> None:
        """End the connection at once."""
        self._unsent.clear()
        self._finished = True
        if self.reads:
            self._drain_and_close(self)

    def finish(self) -> None:
        """End the connection once all waiting bytes are sent."""
        self._finished = True
        self._watch(self)

    def at(self, port: int) -> TcpPeer:
        """See `Peer`: a connection has no other port."""
        del port
        return self
