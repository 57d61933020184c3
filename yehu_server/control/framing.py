"""OSC packets in a stream of bytes, in either framing: a length before each, or SLIP.

A peer's first byte tells which: a length below 16 MiB begins with 0, SLIP with its END byte
or at once with a packet.
"""

from __future__ import annotations

from collections.abc import Iterator

from pythonosc import slip

MOST_BYTES = 1 << 20  # of one packet
LENGTH_BYTES = 4


class FramingError(ValueError):
    """A stream that is neither framing, or a packet that is too long."""


class Framing:
    """The framing of one connection, as soon as the peer has shown it."""

    def __init__(self) -> None:
        self._received = bytearray()
        self._is_slip: bool | None = None

    def packets(self, data: bytes) -> Iterator[bytes]:
        """The packets that `data` completes. Errors: FramingError."""
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
            if len(received) < end:
                return
            packet = bytes(received[LENGTH_BYTES:end])
            del received[:end]
            yield packet

    def _slip(self) -> Iterator[bytes]:
        *frames, rest = self._received.split(slip.END)
        self._received = rest
        if len(rest) > 2 * MOST_BYTES:
            raise FramingError(f"a packet of more than {MOST_BYTES} bytes is too long")
        for frame in frames:
            if frame:
                try:
                    yield slip.decode(bytes(frame))
                except slip.ProtocolError:
                    yield b""  # damaged: to be counted with the malformed ones
