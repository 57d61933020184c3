"""OSC packets in a stream of bytes, in either framing: a length before each, or SLIP.

A peer's first byte tells which: a length begins with 0, SLIP with its END byte or at once with a
packet. Whatever cannot be OSC ends the stream with its first byte, since the next could be one: a
page in a player's browser can send us HTTP or STUN, and put OSC of its own into it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from pythonosc import slip

MOST_BYTES = (1 << 16) - 1  # of one packet: as in a datagram, and less than any STUN begins with
LENGTH_BYTES = 4
STARTS = b"/#"  # of a packet
ENDS = re.compile(b"\xc0+")


class FramingError(ValueError):
    """A stream that is neither framing, or a packet that is too long."""


class Framing:
    """The framing of one connection, as soon as the peer has shown it."""

    def __init__(self) -> None:
        self._received = bytearray()
        self._sought = 0  # bytes of it that were looked at for an END
        self._is_slip: bool | None = None

    def packets(self, data: bytes) -> Iterator[bytes]:
        """The packets that `data` completes; all of them are taken before there is more data.

        Errors: FramingError.
        """
        self._received += data
        if self._is_slip is None and self._received:
            self._is_slip = self._received[0] != 0
        yield from self._slip() if self._is_slip else self._prefixed()

    def wrap(self, packet: bytes) -> bytes:
        """A packet as bytes for this peer; SLIP (OSC 1.1) until it has shown its framing."""
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
                    del ends  # else it holds on to the bytes
                    del received[:at]
                _check_start(received[:1])
            end = received.find(slip.END, self._sought)
            if end < 0:
                self._sought = len(received)
            if max(end, self._sought) > 2 * MOST_BYTES:  # each byte may take two
                raise FramingError(f"a packet of more than {MOST_BYTES} bytes is too long")
            if end < 0:
                return
            frame = bytes(received[:end])
            del received[: end + 1]
            self._sought = 0
            yield _decoded(frame)


def _check_start(first: bytearray) -> None:
    """Errors: FramingError where no packet begins with a byte."""
    if first and first not in STARTS:
        raise FramingError("this is no OSC")


def _decoded(frame: bytes) -> bytes:
    """A packet without SLIP's escapes. Errors: FramingError."""
    try:
        packet = slip.decode(frame)
    except slip.ProtocolError:
        return b""  # damaged: to be counted with the malformed ones
    if len(packet) > MOST_BYTES:
        raise FramingError(f"a packet of {len(packet)} bytes is too long")
    return packet
