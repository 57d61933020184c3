"""Framing of OSC packets in a TCP stream: by a length before each packet, or by SLIP.

A peer's first byte shows which: a length begins with 0, SLIP with its END byte or directly with a
packet. A stream that is not OSC is ended at its first byte: a page in a player's browser can make
it send HTTP or STUN to this port, with OSC packets of the page's own further on.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from pythonosc import slip

# Of a packet: as in a datagram, and less than the beginning of a STUN message says as a length.
MOST_BYTES = (1 << 16) - 1
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
            if length > MOST_BYTES:
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
            if max(end, self._sought) > 2 * MOST_BYTES:  # SLIP may send a byte as two
                raise FramingError(f"a packet of more than {MOST_BYTES} bytes is too long")
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
    if len(packet) > MOST_BYTES:
        raise FramingError(f"a packet of {len(packet)} bytes is too long")
    return packet
