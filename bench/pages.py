"""What pages cost: events that are late without and with listeners; and from a wish to the ear.

    .venv/bin/python bench/pages.py [--listeners N] [--seconds N] [--turns N] [--blocksize N]
                                    [--audio-device NAME] [--save FILE.json]

A server plays under the load of `load.py`: 2,000 OSC and 600 MIDI messages a second. In turns
nobody looks or listens, or a page looks and plays, beside so many listeners. The time to the ear
is from a page's wish being sent until a listener receives the sample at which it is fulfilled,
and the fill that a page aims at. The page's own device is added to that.
"""

from __future__ import annotations

import asyncio
import itertools
import threading
import time
from typing import Any

import aiohttp
import numpy as np
import report
from load import CARD, SPAWN, send_load, sound_card

from yehu_server.audio.output import OutputOptions
from yehu_server.control.ports import MidiOptions
from yehu_server.engine.warming import warm_up
from yehu_server.panel.pages import PageOptions
from yehu_server.player.rows import ROW
from yehu_server.player.wishes import WRITE
from yehu_server.server import ServeOptions, Server

HOST = "127.0.0.1"
FILL = 512  # frames
SETTLED_S = 4.0
WISH_S = 0.05
PARAMETER, STEPS = "/playing/variation", 10_000  # whose values tell wishes apart
COUNTERS = ("late_events", "applied", "late_callbacks", "callbacks", "underruns")


async def _listen(session: aiohttp.ClientSession, url: str, heard: list[tuple[int, float]]) -> None:
    async with session.ws_connect(f"{url}sound", max_msg_size=0) as socket:
        async for message in socket:
            frame = int(np.frombuffer(message.data[:8], "<f8")[0])
            heard.append((frame + (len(message.data) - 8) // 4, time.monotonic()))


async def _play(session: aiohttp.ClientSession, url: str, sent: list[tuple[float, float]]) -> None:
    async with session.ws_connect(f"{url}socket") as socket:
        await socket.send_str('{"looks": true, "sounds": false}')
        reading = asyncio.ensure_future(_read(socket))
        for number in itertools.count():
            value = (number % STEPS) / STEPS
            wish = [-1.0, WRITE, ROW[PARAMETER], value, 0.0]
            sent.append((value, time.monotonic()))
            await socket.send_bytes(np.array(wish, "<f8").tobytes())
            await asyncio.sleep(WISH_S)
        await reading


async def _read(socket: aiohttp.ClientWebSocketResponse) -> None:
    async for _ in socket:
        pass


def visit(url: str, listeners: int, seconds: float, results: Any) -> None:
    """Look, play and listen; what is told is for one listener."""
    sent: list[tuple[float, float]] = []
    heard: list[list[tuple[int, float]]] = [[] for _ in range(listeners)]

    async def meet() -> None:
        connector = aiohttp.TCPConnector(limit=0)
        async with aiohttp.ClientSession(connector=connector) as session:
            tasks = [_listen(session, url, one) for one in heard]
            await asyncio.wait(
                [asyncio.ensure_future(task) for task in (*tasks, _play(session, url, sent))],
                timeout=seconds,
            )

    asyncio.run(meet())
    results.put((sent, heard[0] if heard else []))


class Fulfilled:
    """The frames at which recognized wishes were fulfilled."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._ending = threading.Event()
        self.frames: list[tuple[float, int]] = []
        self._thread = threading.Thread(target=self._run, daemon=True)
        server.instrument.report_wishes()
        self._thread.start()

    def _run(self) -> None:
        row = ROW[PARAMETER]
        while not self._ending.wait(0.2):
            wishes = self._server.instrument.applied_wishes()
            ours = wishes[(wishes["kind"] == WRITE) & (wishes["index"] == row)]
            self.frames += zip(ours["value"].tolist(), ours["frame"].tolist(), strict=True)

    def stop(self) -> None:
        """Stop to look."""
        self._ending.set()
        self._thread.join()


def counters(server: Server) -> dict[str, int]:
    """The counters of the callback."""
    meters = server.instrument.meters()
    return {name: int(meters[name]) for name in COUNTERS}


def turn(server: Server, listeners: int | None, seconds: float) -> dict[str, Any]:
    """Measure for a while, with so many listeners and a page, or with nobody (None)."""
    results = SPAWN.Queue()
    visitor = None
    if listeners is not None:
        assert server.pages is not None  # noqa: S101 - it was asked for
        url = f"http://{HOST}:{server.pages.port}/"
        visitor = SPAWN.Process(target=visit, args=(url, listeners, seconds + SETTLED_S, results))
        visitor.start()
    time.sleep(SETTLED_S)
    fulfilled = Fulfilled(server)
    before = counters(server)
    time.sleep(seconds)
    after = counters(server)
    row: dict[str, Any] = {name: after[name] - before[name] for name in COUNTERS}
    row["late"] = row["late_events"] / max(1, row["applied"])
    row["delay_ms"] = 1e3 * server.player.delay / server.instrument.rate
    if visitor is not None:
        sent, heard = results.get()
        visitor.join()
        row["to_ear_ms"] = to_ear(sent, heard, fulfilled.frames, server.instrument.rate)
    fulfilled.stop()
    return row


def to_ear(sent: Any, heard: Any, fulfilled: Any, rate: float) -> list[float]:
    """Median, 95 % and most of the time from wish to ear (ms)."""
    if not heard:
        return []
    ends, times = np.array(heard).T
    when = dict(sent)
    taken = [
        1e3 * (times[np.searchsorted(ends, frame, "right")] - when[value] + FILL / rate)
        for value, frame in fulfilled
        if value in when and frame < ends[-1]
    ]
    return [round(float(np.quantile(taken, share)), 2) for share in (0.5, 0.95, 1.0)]


def main() -> None:
    """Measure and print everything."""
    parser = report.options(__doc__)
    parser.add_argument("--listeners", type=int, default=20, help="(default: 20)")
    parser.add_argument("--seconds", type=float, default=10.0, help="of each turn (default: 10)")
    parser.add_argument("--turns", type=int, default=3, help="of each kind (default: 3)")
    parser.add_argument("--blocksize", type=int, default=128, help="frames (default: 128)")
    parser.add_argument("--audio-device", help="see yehu-server devices (default: a dummy)")
    arguments = parser.parse_args()
    warm_up()
    rows = []
    with sound_card(arguments.audio_device, arguments.blocksize):
        options = ServeOptions(
            output=OutputOptions(arguments.audio_device or CARD, blocksize=arguments.blocksize),
            midi=MidiOptions(["load"]),
            osc=(HOST, 0),
            page=PageOptions((HOST, 0)),
        )
        server = Server(options, print)
        server.start()
        load = SPAWN.Process(target=send_load, args=(server.osc.port,), daemon=True)
        load.start()
        try:
            for _ in range(arguments.turns):
                for listeners in (None, arguments.listeners):
                    row = turn(server, listeners, arguments.seconds)
                    rows.append({"listeners": listeners} | row)
                    print(rows[-1], flush=True)
        finally:
            load.kill()
            server.hurry()
            server.stop()
    report.save(arguments.save, rows, device=arguments.audio_device or report.NO_CARD)


if __name__ == "__main__":
    main()
