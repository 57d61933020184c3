"""A thread with an asyncio loop survives errors in it."""

import asyncio
import errno
import logging
import os
import urllib.request

import pytest

from yehu_server.live.web.loop_thread import LoopThread
from yehu_server.live.web.request_filter import Connections
from yehu_server.live.web.server import WebOptions
from yehu_server.util.retry import Backoff

TOO_MANY = OSError(errno.EMFILE, os.strerror(errno.EMFILE))


@pytest.mark.parametrize("error", [TOO_MANY, MemoryError(), RuntimeError("no thread")])
def test_what_fails_is_begun_again_and_said_once(until, error):
    begun, said = [], []

    async def main() -> None:
        begun.append(1)
        if len(begun) < 4:
            raise error
        await asyncio.Event().wait()

    thread = LoopThread(main, "work", said.append, Backoff(0.01, 0.01))
    thread.start()
    until(lambda: len(begun) == 4, "four tries")
    thread.stop()
    assert said == [error]
    begun.clear()  # fails again: it ends at once while it waits to try once more
    thread = LoopThread(main, "work", said.append, Backoff(3600.0, 3600.0))
    thread.start()
    until(lambda: len(said) == 2, "an error")
    thread.stop()
    assert not thread._thread.is_alive()


def test_a_loop_that_is_short_of_files_says_so_once_in_a_line(until, caplog):
    done = []

    async def main() -> None:
        loop = asyncio.get_running_loop()
        for _ in range(100):
            loop.call_exception_handler({"message": "accept", "exception": TOO_MANY})
        done.append(1)

    thread = LoopThread(main, "OSCQuery", lambda _error: None)
    with caplog.at_level(logging.WARNING):
        thread.start()
        until(lambda: done, "its errors")
        thread.stop()
    assert caplog.messages == [f"OSCQuery: {os.strerror(errno.EMFILE).lower()}; trying again"]


def test_oscquery_answers_again_after_its_server_failed(make_live, until, monkeypatch):
    fails = [TOO_MANY, None]
    limit = Connections.limit

    def failing(connections: Connections, of: object) -> None:
        if fails and (error := fails.pop(0)) is not None:
            raise error
        limit(connections, of)

    monkeypatch.setattr(Connections, "limit", failing)
    live = make_live(http=WebOptions(("127.0.0.1", 0)))
    until(lambda: not fails, "a failure, and another try")
    with urllib.request.urlopen(f"http://127.0.0.1:{live.server.web.port}/?HOST_INFO") as answer:
        assert answer.status == 200
