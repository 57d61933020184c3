"""A browser's part of a page without a browser: it watches and plays, and others listen."""

from __future__ import annotations

import asyncio
import itertools
import time
from typing import Any

import aiohttp
import numpy as np

from yehu_server.core.player.commands import WRITE
from yehu_server.core.player.parameter_indices import INDEX

COMMAND_S = 0.05
PARAMETER, STEPS = "/playing/variation", 10_000  # whose values distinguish commands


def visit(url: str, listeners: int, seconds: float | None, results: Any) -> None:
    """Watch, play and listen.

    `seconds` (float or None): for so long; None is until it is killed.
    `results`: gets the values requested and the times, and of one listener the frames heard and the
    times.
    """
    sent: list[tuple[float, float]] = []
    heard: list[list[tuple[int, float]]] = [[] for _ in range(listeners)]

    async def meet() -> None:
        connector = aiohttp.TCPConnector(limit=0)
        async with aiohttp.ClientSession(connector=connector) as session:
            tasks = [_listen(session, url, one) for one in heard]
            ended, _ = await asyncio.wait(
                [asyncio.ensure_future(task) for task in (*tasks, _play(session, url, sent))],
                timeout=seconds,
                return_when=asyncio.FIRST_COMPLETED,  # none should
            )
            for task in ended:
                task.result()

    asyncio.run(meet())
    results.put((sent, heard[0] if heard else []))


async def _listen(session: aiohttp.ClientSession, url: str, heard: list[tuple[int, float]]) -> None:
    async with session.ws_connect(f"{url}sound", max_msg_size=0) as socket:
        async for message in socket:
            frame = int(np.frombuffer(message.data[:8], "<f8")[0])
            heard.append((frame + (len(message.data) - 8) // 4, time.monotonic()))


async def _play(session: aiohttp.ClientSession, url: str, sent: list[tuple[float, float]]) -> None:
    async with session.ws_connect(f"{url}socket") as socket:
        await socket.send_str('{"snapshots": true, "sounds": false}')
        reading = asyncio.ensure_future(_read(socket))
        for number in itertools.count():
            value = (number % STEPS) / STEPS
            command = [-1.0, WRITE, INDEX[PARAMETER], value, 0.0]
            sent.append((value, time.monotonic()))
            await socket.send_bytes(np.array(command, "<f8").tobytes())
            await asyncio.sleep(COMMAND_S)
        await reading


async def _read(socket: aiohttp.ClientWebSocketResponse) -> None:
    async for _ in socket:
        pass
