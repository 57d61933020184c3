"""Messages of WebSockets: no other client waits for one that does not read, or that sends much."""

import asyncio
import struct
from collections.abc import AsyncIterator

from aiohttp import WSMessage, WSMsgType, web

TEXT, BINARY = 0x81, 0x82  # whole messages
SHORT, MIDDLE = 126, 1 << 16  # payloads below have lengths of one and of two bytes


def frame_of(payload: bytes, kind: int = BINARY) -> bytes:
    """A message as the server sends it (RFC 6455, section 5.2)."""
    size = len(payload)
    if size < SHORT:
        head = bytes((kind, size))
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


async def messages(socket: web.WebSocketResponse) -> AsyncIterator[WSMessage]:
    """Yield the messages of a WebSocket, made without `autoping`; after each, others have a turn.

    aiohttp hands out all that has come without a pause, and answers pings likewise.
    """
    async for message in socket:
        if message.type is WSMsgType.PING:
            await socket.pong(message.data)
        elif message.type is not WSMsgType.PONG:
            yield message
        await asyncio.sleep(0.0)
