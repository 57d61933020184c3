"""A WebSocket that sends much takes no turns of others."""

import asyncio
from types import SimpleNamespace

import pytest
from aiohttp import WSMsgType

from yehu_server.live.web.frames import messages

COUNT = 100


class Full:
    """A WebSocket of which all messages have come already."""

    def __init__(self, kind: WSMsgType) -> None:
        self._kind = kind
        self.answered = 0

    async def __aiter__(self):
        for _ in range(COUNT):
            yield SimpleNamespace(type=self._kind, data=b"")

    async def pong(self, _data: bytes) -> None:
        self.answered += 1


@pytest.mark.parametrize("kind", [WSMsgType.BINARY, WSMsgType.TEXT, WSMsgType.PING, WSMsgType.PONG])
def test_after_each_message_others_have_their_turn(kind):
    socket, turns = Full(kind), 0

    async def take_turns() -> None:
        nonlocal turns
        while True:
            turns += 1
            await asyncio.sleep(0.0)

    async def serve() -> int:
        other = asyncio.create_task(take_turns())
        found = [message async for message in messages(socket)]
        other.cancel()
        return len(found)

    is_for_us = kind in (WSMsgType.BINARY, WSMsgType.TEXT)
    assert asyncio.run(serve()) == (COUNT if is_for_us else 0)
    assert socket.answered == (COUNT if kind is WSMsgType.PING else 0)
    assert turns >= COUNT
