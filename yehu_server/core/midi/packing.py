"""MIDI messages as numbers: the index of the event that carries one.

Nothing of numba is loaded with it: the process that holds the MIDI inputs has to start soon.
"""

from __future__ import annotations

from collections.abc import Sequence

BYTE_BITS, LENGTH_SHIFT, PORT_SHIFT = 8, 24, 32  # bits
MAX_BYTES = 3


def packed(message: Sequence[int], port: int = 0) -> int:
    """The index of a MIDI message of 1 to 3 bytes: its bytes from the lowest, its length, its port.

    Longer ones are packed as if they had no byte, and change nothing.
    """
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
