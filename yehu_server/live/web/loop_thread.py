"""A thread with an asyncio event loop that starts again after errors."""

import asyncio
import contextlib
import errno
import logging
import threading
import time
from collections.abc import Callable, Coroutine
from typing import Any

from yehu_server.util.files import error_reason
from yehu_server.util.retry import Backoff

log = logging.getLogger(__name__)

SHORT = {errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM}
REPORT_EVERY_S = 60.0


class LoopThread:
    """Runs a coroutine function in a thread, again after an error; `failed` gets each once."""

    def __init__(
        self,
        main: Callable[[], Coroutine[Any, Any, None]],
        name: str,
        failed: Callable[[BaseException], None],
        backoff: Backoff | None = None,
    ) -> None:
        self._main = main
        self._name = name
        self._failed = failed
        self._backoff = backoff or Backoff()
        self._reported_at = -REPORT_EVERY_S
        self._runner = asyncio.Runner(loop_factory=asyncio.new_event_loop)
        self.loop = self._runner.get_loop()
        self._ended = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def call(self, action: Callable[..., object], *arguments: Any) -> None:
        """Call a function in the loop, unless it has ended; any thread may call."""
        with contextlib.suppress(RuntimeError):
            self.loop.call_soon_threadsafe(action, *arguments)

    def stop(self) -> None:
        """Cancel the coroutine and wait until it has ended."""
        self.call(self._ended.set)
        if self._thread.is_alive():
            self._thread.join()
        self._runner.close()

    def _run(self) -> None:
        self.loop.set_exception_handler(self._handle_exception)
        with self._runner:
            self._runner.run(self._until_ended())

    async def _until_ended(self) -> None:
        ended = asyncio.ensure_future(self._ended.wait())
        while not ended.done():
            main = asyncio.ensure_future(self._main())
            await asyncio.wait((main, ended), return_when=asyncio.FIRST_COMPLETED)
            main.cancel()
            (error,) = await asyncio.gather(main, return_exceptions=True)
            if error is None:
                break
            if not isinstance(error, asyncio.CancelledError):
                if self._backoff.is_news(error_reason(error)):
                    log.debug("%s", self._name, exc_info=error)
                    self._failed(error)
                await asyncio.wait((ended,), timeout=self._backoff.failed())
        ended.cancel()

    def _handle_exception(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Log that files or memory are short, once a minute; asyncio itself tries again."""
        error = context.get("exception")
        if not (isinstance(error, OSError) and error.errno in SHORT):
            loop.default_exception_handler(context)
        elif time.monotonic() - self._reported_at >= REPORT_EVERY_S:
            self._reported_at = time.monotonic()
            log.warning("%s: %s; trying again", self._name, error_reason(error))
