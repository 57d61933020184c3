"""What OSC calls, OSCQuery and the page need of a server beside its players."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.live.audio.output import Output
from yehu_server.live.audio.recordings import Recordings
from yehu_server.live.midi.ports import MidiPorts
from yehu_server.live.osc.answering import WebTraffic
from yehu_server.live.osc.handler import OscHandler
from yehu_server.live.osc.receiving import OscPorts
from yehu_server.live.osc.status import PartSources, StatusSources, read_part_status, read_status
from yehu_server.live.part_addresses import part_of
from yehu_server.live.web.query import Snapshot
from yehu_server.live.web.server import WebServer
from yehu_server.playing.delay import Delay
from yehu_server.playing.parts import Part


class Services:
    """The services of a server: its status, its recordings, its log. See ``osc.context``.

    Attributes
    ----------
    handler, osc, takes, web, midi
        What it serves with, set as they are made, before the server starts.
    """

    handler: OscHandler
    osc: OscPorts
    takes: Recordings

    def __init__(
        self,
        parts: Sequence[Part],
        ensemble: Ensemble,
        delay: Delay,
        output: Output,
        blocksize: int,
        on_message: Callable[[str], None],
    ) -> None:
        self._parts = parts
        self._ensemble = ensemble
        self._delay = delay
        self._output = output
        self._blocksize = blocksize
        self.log = on_message
        self.web: WebServer | None = None
        self.midi: MidiPorts | None = None
        self._started = time.monotonic()
        self._background = ThreadPoolExecutor(1, "files")

    def call_soon(self, action: Callable[[], None]) -> None:
        """See `ServerServices`."""
        self.osc.call_soon(action)

    def run_in_background(self, action: Callable[[], None]) -> None:
        """See `ServerServices`."""
        self._background.submit(action)

    def close(self) -> None:
        """Wait until all is done that runs in the background."""
        self._background.shutdown()

    def tree_changed(self, path: str) -> None:
        """See `ServerServices`."""
        if self.web is not None:
            self.web.tree_changed(path)

    def start_recording(self, name: str) -> str:
        """See `ServerServices`."""
        return self.takes.start(name)

    def stop_recording(self) -> str:
        """See `ServerServices`."""
        return self.takes.stop()

    def status(self) -> dict[str, float | str]:
        """See `ServerServices`; any thread may call."""
        return read_status(
            StatusSources(
                parts=[_sources(part) for part in self._parts],
                ensemble=self._ensemble,
                delay=self._delay,
                output=self._output.state,
                blocksize=self._blocksize,
                osc=self.osc.traffic,
                messages=self.handler.counts,
                scheduled=self.handler.waiting,
                subscribers=self.handler.clients.subscribers,
                web=WebTraffic() if self.web is None else self.web.traffic,
                midi=self.midi,
                recording=self.takes.names,
                uptime_s=time.monotonic() - self._started,
            )
        )

    def part_status(self, part: int) -> dict[str, float]:
        """See `ServerServices`; any thread may call."""
        return read_part_status(_sources(self._parts[part]))

    def snapshot(self, addressed: str) -> Snapshot:
        """The values of a group of addresses; any thread may call."""
        if not addressed:
            return Snapshot(self._parts[0].player.values(), self.status())
        part = part_of(addressed)
        return Snapshot(self._parts[part].player.values(), self.part_status(part))

    def sound(self) -> dict[str, float | str | None]:
        """What pages show of the sound; any thread may call."""
        state = self._output.state
        delay_ms = 1e3 * self._parts[0].player.delay / self._ensemble.rate
        return {"device": state.device, "latencyMs": state.latency_ms + delay_ms}


def _sources(part: Part) -> PartSources:
    meters = [instrument.meters() for instrument in part.instruments]
    return PartSources(part.player, part.instruments, meters)
