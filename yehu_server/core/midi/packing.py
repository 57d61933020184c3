"""MIDI messages as the index of an event; without numba, for a process that starts soon."""

from collections.abc import Sequence

BYTE_BITS, LENGTH_SHIFT, PORT_SHIFT = 8, 24, 32  # bits
MAX_BYTES = 3


def packed(message: Sequence[int], port: int = 0) -> int:
    """A MIDI message as an index: 1 to 3 bytes (longer: none) from the lowest, length, port."""
    if len(message) > MAX_BYTES:
        return port << PORT_SHIFT
    index = len(message) << LENGTH_SHIFT | port << PORT_SHIFT
    for place, byte in enumerate(message):
        index |= (byte & 0xFF) << BYTE_BITS * place
    return index


def unpacked(index: int) -> tuple[bytes, int]:
    """The bytes and the port of a packed message."""
    length, port = index >> LENGTH_SHIFT & 0xFF, index >> PORT_SHIFT
    return bytes(index >> BYTE_BITS * place & 0xFF for place in range(length)), port
