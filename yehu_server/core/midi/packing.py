"""MIDI messages as numbers: the index of the event that carries one.

Nothing of numba is loaded with it: the process that holds the MIDI inputs has to start soon.
"""

from __future__ import annotations

from collections.abc import Sequence

BYTE, LENGTH_AT, PORT_AT = 8, 24, 32  # bits
MAX_BYTES = 3


def packed(message: Sequence[int], port: int = 0) -> int:
    """The index of a MIDI message of 1 to 3 bytes: its bytes from the lowest, its length, its port.

    Longer ones are packed as if they had no byte, and change nothing.
    """
    if len(message) > MAX_BYTES:
        return port << PORT_AT
    index = len(message) << LENGTH_AT | port << PORT_AT
    for place, byte in enumerate(message):
        index |= (byte & 0xFF) << BYTE * place
    return index


def unpacked(index: int) -> tuple[bytes, int]:
    """The bytes and the port of a packed message."""
    length, port = index >> LENGTH_AT & 0xFF, index >> PORT_AT
    return bytes(index >> BYTE * place & 0xFF for place in range(length)), port
