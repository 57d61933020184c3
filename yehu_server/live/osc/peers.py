"""The peers that send OSC, and how each is answered: by datagram, or over a connection.

Answers are limited, since a small request may have large ones. Each port of this machine that
sends datagrams has a token bucket of bytes; another host, whose address may be forged, has one for
all of its ports, and all other hosts share a larger one. A connection gets what its other end
reads.

The first byte of a connection shows how packets are framed in it: a length before each begins with
0, SLIP with its END byte or directly with a packet. A stream that is not OSC is ended at its first
byte: a page in a player's browser can make it send HTTP or STUN to this port, with OSC packets of
the page's own further on.
"""

from __future__ import annotations

import re
import selectors
import socket
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from pythonosc import slip

from yehu_server.live import traffic_limits as limits
from yehu_server.live.network import Address
from yehu_server.util.token_bucket import TokenBucket

LENGTH_BYTES = 4
STARTS = b"/#"  # first bytes that a packet may have
ENDS = re.compile(b"\xc0+")


class FramingError(ValueError):
    """A stream in neither framing, or a packet that is too long."""


class Framing:
    """The framing of one connection, found from the first byte received."""

    def __init__(self) -> None:
        self._received = bytearray()
        self._sought = 0  # bytes of it that hold no END
        self._is_slip: bool | None = None

    def packets(self, data: bytes) -> Iterator[bytes]:
        """The packets that `data` completes; take all of them before the next call.

        Raises FramingError where the stream is not OSC; its connection should be closed.
        """
        self._received += data
        if self._is_slip is None and self._received:
            self._is_slip = self._received[0] != 0
        yield from self._slip() if self._is_slip else self._prefixed()

    def wrap(self, packet: bytes) -> bytes:
        """Frame a packet for this peer; by SLIP (OSC 1.1) until it has sent something."""
        if self._is_slip is False:
            return len(packet).to_bytes(LENGTH_BYTES, "big") + packet
        return slip.encode(packet)

    def _prefixed(self) -> Iterator[bytes]:
        received = self._received
        while len(received) >= LENGTH_BYTES:
            length = int.from_bytes(received[:LENGTH_BYTES], "big")
            if length > limits.PACKET:
                raise FramingError(f"a packet of {length} bytes is too long")
            end = LENGTH_BYTES + length
            if length:
                _check_start(received[LENGTH_BYTES : LENGTH_BYTES + 1])
            if len(received) < end:
                return
            packet = bytes(received[LENGTH_BYTES:end])
            del received[:end]
            yield packet

    def _slip(self) -> Iterator[bytes]:
        received = self._received
        while True:
            if self._sought == 0:
                if ends := ENDS.match(received):
                    at = ends.end()
                    del ends  # or the buffer could not be resized
                    del received[:at]
                _check_start(received[:1])
            end = received.find(slip.END, self._sought)
            if end < 0:
                self._sought = len(received)
            if max(end, self._sought) > 2 * limits.PACKET:  # SLIP may send a byte as two
                raise FramingError(f"a packet of more than {limits.PACKET} bytes is too long")
            if end < 0:
                return
            frame = bytes(received[:end])
            del received[: end + 1]
            self._sought = 0
            yield _decoded(frame)


def _check_start(first: bytearray) -> None:
    """Raise FramingError where no packet begins with a byte."""
    if first and first not in STARTS:
        raise FramingError("not OSC")


def _decoded(frame: bytes) -> bytes:
    """Undo SLIP's escapes; raise FramingError where the packet is too long."""
    try:
        packet = slip.decode(frame)
    except slip.ProtocolError:
        return b""  # damaged: counted as a malformed packet
    if len(packet) > limits.PACKET:
        raise FramingError(f"a packet of {len(packet)} bytes is too long")
    return packet


class Peer(ABC):
    """A sender of OSC, which can be answered, and the IP address of its `host`."""

    host: str

    @property
    @abstractmethod
    def takes_more(self) -> bool:
        """Whether it may be sent more than it must be."""

    @abstractmethod
    def send(self, *packets: bytes) -> None:
        """Send packets, or drop those beyond its limit."""

    def at(self, _port: int) -> Peer:
        """A peer at another port of the same host; a connection has none."""
        return self


@dataclass
class Traffic:
    """Counters of OSC traffic since the start, and what there is now."""

    packets: int = 0
    refused: int = 0  # packets from senders that are not allowed, and refused connections
    excess: int = 0  # packets dropped: too long, or their sender has too much waiting
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
    return TokenBucket(times * limits.ANSWERED, times * limits.ANSWERED)


class UdpPeer(Peer):
    """A sender of datagrams; bytes that it is sent are taken from each of its buckets.

    There is one of an address (`peer_at`): each message looks a dozen things up by its sender.
    """

    def __init__(
        self,
        socket: socket.socket,
        address: Address,
        traffic: Traffic,
        buckets: Sequence[TokenBucket],
        peer_at: Callable[[Address, Sequence[TokenBucket]], UdpPeer],
    ) -> None:
        self.host = address[0]
        self._socket, self._address = socket, address
        self._traffic, self._buckets = traffic, buckets
        self._peer_at = peer_at

    @property
    def takes_more(self) -> bool:
        """See `Peer`."""
        now = time.monotonic()
        return all(bucket.left(now) > 0.0 for bucket in self._buckets)

    def send(self, *packets: bytes) -> None:
        """See `Peer`."""
        for packet in packets:
            if not self.takes_more:
                self._traffic.unsent += 1
                continue
            for bucket in self._buckets:
                bucket.spend(len(packet))
            try:
                self._socket.sendto(packet, self._address)
            except OSError:
                self._traffic.unsent += 1

    def at(self, port: int) -> UdpPeer:
        """See `Peer`; bytes sent there count for this peer too."""
        return self._peer_at((self._address[0], port, *self._address[2:]), self._buckets)


class TcpPeer(Peer):
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
        self.reads = True  # until its end of the connection is closed
        self._unsent = bytearray()
        self.is_finished = False  # whether nothing more will be sent
        self._traffic = traffic
        self._watch = watch
        self._drain_and_close = drain_and_close

    @property
    def takes_more(self) -> bool:
        """See `Peer`."""
        return len(self._unsent) < limits.UNSENT // 2

    @property
    def events(self) -> int:
        """The events that a selector should wait for."""
        reading = selectors.EVENT_READ if self.reads else 0
        return reading | (selectors.EVENT_WRITE if self._unsent else 0)

    def send(self, *packets: bytes) -> None:
        """See `Peer`; packets are dropped while the peer does not read."""
        if len(self._unsent) > limits.UNSENT:
            self._traffic.unsent += len(packets)
        elif not self.is_finished:
            self._unsent += b"".join(map(self.framing.wrap, packets))
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
        self.is_finished = True
        if self.reads:
            self._drain_and_close(self)

    def finish(self) -> None:
        """End the connection once all waiting bytes are sent."""
        self.is_finished = True
        self._watch(self)
