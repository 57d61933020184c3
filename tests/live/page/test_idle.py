"""What the process of pages does while no page is there: nothing."""

import asyncio
from typing import Any

from yehu_server.live.page.page_sockets import PageSockets


class Loop(asyncio.SelectorEventLoop):
    """A loop that counts what it is asked to do later."""

    def __init__(self) -> None:
        super().__init__()
        self.timers = 0

    def call_at(self, *arguments: Any, **named: Any) -> asyncio.TimerHandle:
        self.timers += 1
        return super().call_at(*arguments, **named)


class View:
    """Instruments that nobody may look at."""

    rate = 48000.0

    def frame_of(self, time_ns: int) -> int:
        raise AssertionError(time_ns)


def test_without_a_page_nothing_is_looked_at_and_nothing_wakes_the_process() -> None:
    view: Any = View()
    sockets = PageSockets(view, [0], {})

    async def serve() -> None:
        tasks = (sockets.send_snapshots, sockets.send_sound, sockets.send_status)
        running = [asyncio.ensure_future(task()) for task in tasks]
        for _ in range(10):
            await asyncio.sleep(0)
        assert not any(task.done() for task in running)
        for task in running:
            task.cancel()

    with asyncio.Runner(loop_factory=Loop) as runner:
        runner.run(serve())
        loop = runner.get_loop()
        assert isinstance(loop, Loop)
        assert loop.timers == 0
