"""A thread with an asyncio loop of its own."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Callable, Coroutine
from typing import Any


class LoopThread:
    """Runs one coroutine function in a thread, from `start` to `stop`, which cancels it."""

    def __init__(self, main: Callable[[], Coroutine[Any, Any, None]], name: str) -> None:
        self._main = main
        self._runner = asyncio.Runner(loop_factory=asyncio.new_event_loop)
        self.loop = self._runner.get_loop()
        self._ended = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def call(self, action: Callable[..., object], *arguments: Any) -> None:
        """Let the loop do something, unless it is over; any thread may call."""
        with contextlib.suppress(RuntimeError):
            self.loop.call_soon_threadsafe(action, *arguments)

    def stop(self) -> None:
        """Cancel the coroutine and wait until it has cleaned up."""
        self.call(self._ended.set)
        if self._thread.is_alive():
            self._thread.join()
        self._runner.close()

    def _run(self) -> None:
        with self._runner:
            self._runner.run(self._until_ended())

    async def _until_ended(self) -> None:
        main = asyncio.ensure_future(self._main())
        ended = asyncio.ensure_future(self._ended.wait())
        await asyncio.wait((main, ended), return_when=asyncio.FIRST_COMPLETED)
        ended.cancel()
        main.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await main
