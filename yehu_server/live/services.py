"""What OSC calls, OSCQuery and the page ask of a server beside its players."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

from yehu_server.live.osc.part_status import PartSources, read_part_status
from yehu_server.live.osc.peers import WebTraffic
from yehu_server.live.osc.status import StatusSources, read_status
from yehu_server.live.web.query import Told
from yehu_server.playing.parts import Part

if TYPE_CHECKING:
    from yehu_server.live.server import Server


class ServerDesk:
    """The services of a server: its status, its recordings, its lines. See ``request.Desk``."""

    def __init__(self, server: Server, said: Callable[[str], None]) -> None:
        self._server = server
        self._said = said
        self._started = time.monotonic()
        self._aside = ThreadPoolExecutor(1, "files")

    def soon(self, action: Callable[[], None]) -> None:
        """See `request.Desk`."""
        self._server.osc.call_soon(action)

    def aside(self, action: Callable[[], None]) -> None:
        """See `request.Desk`."""
        self._aside.submit(action)

    def close(self) -> None:
        """Wait until all is done that was to be done aside."""
        self._aside.shutdown()

    def say(self, line: str) -> None:
        """See `request.Desk`."""
        self._said(line)

    def tree_changed(self, path: str) -> None:
        """See `request.Desk`."""
        if self._server.web is not None:
            self._server.web.tree_changed(path)

    def start_recording(self, name: str) -> str:
        """See `request.Desk`."""
        return self._server.takes.start(name)

    def stop_recording(self) -> str:
        """See `request.Desk`."""
        return self._server.takes.stop()

    def status(self) -> dict[str, float | str]:
        """See `request.Desk`; any thread may call."""
        server = self._server
        return read_status(
            StatusSources(
                parts=[_sources(part) for part in server.parts],
                ensemble=server.ensemble,
                delay=server.delay,
                output=server.output.state,
                blocksize=server.options.output.blocksize,
                osc=server.osc.traffic,
                messages=server.handler.counts,
                scheduled=server.handler.waiting,
                subscribers=server.handler.clients.subscribers,
                web=WebTraffic() if server.web is None else server.web.traffic,
                midi=server.midi,
                recording=server.takes.names,
                uptime_s=time.monotonic() - self._started,
            )
        )

    def part_status(self, part: int) -> dict[str, float]:
        """See `request.Desk`; any thread may call."""
        return read_part_status(_sources(self._server.parts[part]))

    def told(self) -> Told:
        """What OSCQuery tells of addresses without a part; any thread may call."""
        return Told(self._server.player.values(), self.status())

    def told_of_parts(self) -> list[Told]:
        """What OSCQuery tells of each part; any thread may call."""
        return [
            Told(part.player.values(), self.part_status(number))
            for number, part in enumerate(self._server.parts)
        ]

    def for_pages(self) -> dict[str, float | str | None]:
        """What pages are told of the sound; any thread may call."""
        state, player = self._server.output.state, self._server.player
        delay_ms = 1e3 * player.delay / self._server.instrument.rate
        return {"device": state.device, "latencyMs": state.latency_ms + delay_ms}


def _sources(part: Part) -> PartSources:
    meters = [instrument.meters() for instrument in part.instruments]
    return PartSources(part.player, part.instruments, meters)
