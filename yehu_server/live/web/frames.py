"""Messages of WebSockets, written at once: no other client waits for one that does not read."""

from __future__ import annotations

import asyncio
import struct

TEXT, BINARY = 0x81, 0x82  # whole messages
SHORT, MIDDLE = 126, 1 << 16  # payloads below have lengths of one and of two bytes


def frame_of(payload: bytes, kind: int = BINARY) -> bytes:
    """A message as the server sends it (RFC 6455, section 5.2)."""
    size = len(payload)
    if size < SHORT:
        head = struct.pack(">BB", kind, size)
    elif size < MIDDLE:
        head = struct.pack(">BBH", kind, 126, size)
    else:
        head = struct.pack(">BBQ", kind, 127, size)
    return head + payload


def write(transport: asyncio.WriteTransport | None, frame: bytes, most_unsent: int) -> bool:
    """Write a frame, unless so many bytes wait to be sent already; return whether it was."""
    if transport is None or transport.is_closing():
        return False
    if transport.get_write_buffer_size() > most_unsent:
        return False
    transport.write(frame)
    return True
