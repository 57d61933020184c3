"""What pages cost: events that are late without and with listeners; and from a wish to the ear.

    .venv/bin/python bench/pages.py [--listeners N] [--seconds N] [--turns N] [--blocksize N]
                                    [--audio-device NAME] [--save FILE.json]

A server plays under the load of `load.py`: 2,000 OSC and 600 MIDI messages a second. In turns
nobody looks or listens, or a page looks and plays, beside so many listeners. The time to the ear
is from a page's wish being sent until a listener's clock reaches the sample that fulfils it:
as in `web/sound/jitter_buffer.js`, that clock runs evenly, so far behind what is received on
average as the fill that a page aims at. A gap is where sound came after its time. The page's own
device is added to that. Without --audio-device, or with the device `null`, a JACK server with the
dummy driver is started, which also carries MIDI.
"""

from __future__ import annotations

import os
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import report
from load import CARD, SPAWN, loaded, sound_card
from visitors import PARAMETER, visit

from yehu_server.core.engine.warming import warm_up
from yehu_server.core.player.rows import ROW
from yehu_server.core.player.wishes import WRITE
from yehu_server.live.audio.output import NULL, OutputOptions
from yehu_server.live.midi.ports import MidiOptions
from yehu_server.live.options import ServeOptions
from yehu_server.live.page.pages import PageOptions
from yehu_server.live.server import Server

HOST = "127.0.0.1"
FILL = 512  # frames
MOST_DRIFT = 0.005  # of the device's clock, that a listener follows; beyond, no time is told
AVERAGE_S = 0.5  # over which a listener's clock follows what it receives
SETTLED_S = 4.0
COUNTERS = ("late_events", "applied", "late_callbacks", "callbacks", "underruns")


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


def cpu_of_pages() -> float:
    """Seconds that the process of pages has computed, so far; Linux only."""
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            words = (entry / "stat").read_text().rpartition(")")[2].split()
            command = (entry / "cmdline").read_text()
        except OSError:
            continue
        if words[1] == str(os.getpid()) and "live.page.process" in command:
            return sum(map(int, words[11:13])) / os.sysconf("SC_CLK_TCK")
    return 0.0


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
    before, computed = counters(server), cpu_of_pages()
    time.sleep(seconds)
    after, computed = counters(server), cpu_of_pages() - computed
    rate = server.instrument.rate
    row: dict[str, Any] = {name: after[name] - before[name] for name in COUNTERS}
    row["late"] = row["late_events"] / max(1, row["applied"])
    row["pace"] = row["callbacks"] * server.options.output.blocksize / rate / seconds
    row["cpu_of_pages"] = computed / seconds
    row["delay_ms"] = 1e3 * server.player.delay / rate
    if visitor is not None:
        sent, heard = results.get()
        visitor.join()
        if abs(row["pace"] - 1.0) < MOST_DRIFT:
            row |= to_ear(sent, heard, fulfilled.frames, rate)
    fulfilled.stop()
    return row


def to_ear(sent: Any, heard: Any, fulfilled: Any, rate: float) -> dict[str, Any]:
    """Median, 95 % and most of the time from wish to ear (ms), and the number of gaps."""
    if not heard:
        return {}
    ends, times = np.array(heard).T
    packet = float(np.median(np.diff(ends)))
    count = round(AVERAGE_S * rate / packet)
    # Frames received, in the average over a packet, are half of one fewer than with the packet.
    behind = times - (ends - packet / 2.0 - FILL) / rate
    behind = np.convolve(behind, np.full(count, 1.0 / count), "valid")
    ends, times = ends[count - 1 :], times[count - 1 :]
    when = dict(sent)
    taken = [
        1e3 * (behind[np.searchsorted(ends, frame, "right")] + frame / rate - when[value])
        for value, frame in fulfilled
        if value in when and ends[0] <= frame < ends[-1]
    ]
    shares = {"median": 0.5, "95 %": 0.95, "most": 1.0}
    return {
        **{f"to ear, ms, {name}": float(np.quantile(taken, at)) for name, at in shares.items()},
        "gaps": int(np.count_nonzero(times[1:] > behind[1:] + ends[:-1] / rate)),
    }


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
    rows: dict[str, dict[str, Any]] = {}
    card = None if arguments.audio_device == NULL else arguments.audio_device
    with sound_card(card, arguments.blocksize):
        options = ServeOptions(
            output=OutputOptions(arguments.audio_device or CARD, blocksize=arguments.blocksize),
            midi=MidiOptions(["load"]),
            osc=(HOST, 0),
            page=PageOptions((HOST, 0)),
        )
        server = Server(options, print)
        server.start()
        try:
            with loaded(server.osc.port):
                for number in range(arguments.turns):
                    for listeners in (None, arguments.listeners):
                        name = f"{number + 1}, {listeners or 'no'} listeners"
                        rows[name] = turn(server, listeners, arguments.seconds)
        finally:
            server.skip_fade_out()
            server.stop()
    report.show(rows)
    report.save(arguments.save, rows, device=arguments.audio_device or report.NO_CARD)


if __name__ == "__main__":
    main()
