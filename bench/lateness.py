"""How many events come after their frame, with Python idle and busy, by the delay's handling part.

    .venv/bin/python bench/lateness.py [--seconds N] [--handling MS ...] [--blocks N ...]
                                       [--steady] [--parts N] [--listeners]
                                       [--audio-device NAME] [--save FILE.json]

A server plays in a process of its own. Another process sends it 2,000 OSC and 600 MIDI messages a
second (`load.py`). A busy server also has a thread that computes in Python without a pause. An
event is late where the callback takes it after the frame that it asked for; the table tells how
long after. Handling is the time from a message's arrival, as stamped, until its event is posted.
An event that is late though it was handled within the delay's handling part is the machine's doing:
its sound server called out of turn. Callbacks begun late, and under-runs, show how well it keeps
time. Without --audio-device a JACK server with the dummy driver is started, which has no real-time
rights; so the delay grows by itself. With --steady it stays at what it is by default on a device
that keeps time: a block and the handling part. With --parts several players share the load, and
with --listeners eight OSCQuery clients are told of every change of any value.
"""

from __future__ import annotations

import contextlib
import itertools
import threading
import time
from array import array
from collections import defaultdict, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import report
from endurance import PAGES, helper, listen
from load import CARD, SPAWN, send_load, sound_card
from rich.console import Console
from rich.table import Table

from yehu_server.audio.output import OutputOptions
from yehu_server.control.ports import MidiOptions
from yehu_server.control.web import WebOptions
from yehu_server.engine.warming import warm_up
from yehu_server.playing import delay as delays
from yehu_server.server import PartOptions, ServeOptions, Server

RATE = 48000
BLOCKS = (64, 128)
HANDLING_MS = (0.0, 0.25, 0.5, 1.0)
SETTLED_S = 3.0  # until ports are found and the delay has settled
TAKEN_EVERY_S = 5.0  # before the ring of reports is full
FULFILLED_S = 0.3  # after which the last event of a run must have been fulfilled
SOURCES = ("OSC", "MIDI")
# Of an event that was posted: what identifies it, its frame, the handling, the source, the delay,
# the part.
POSTED = 9
OF_PARTS, OF_ALL = ("late_events", "applied"), ("late_callbacks", "underruns", "callbacks")

Array = Any


# ---------------------------------------------------------------- the server


@dataclass(frozen=True)
class Setting:
    """What one row of the table is measured with."""

    device: str
    block: int
    handling_ms: float
    is_steady: bool
    is_busy: bool
    parts: int = 1
    has_listeners: bool = False

    @property
    def jitter_ms(self) -> float | None:
        """The fixed delay; None where the server adapts it."""
        return 1e3 * self.block / RATE + self.handling_ms if self.is_steady else None


class Witness:
    """Notes each event that is posted, and the time since its message arrived."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._arrived = threading.local()
        self._log = array("d")  # not objects: a collection of garbage takes time
        for number, part in enumerate(server.parts):
            instrument = part.instruments[0]
            instrument.report_wishes()
            vars(part.player)["frame_of"] = partial(self._hear, part.player.frame_of)
            vars(instrument)["post"] = partial(self._note, number, instrument.post)

    def _hear(self, frame_of: Callable[..., int], arrived_ns: int | None = None) -> int:
        self._arrived.ns = time.monotonic_ns() if arrived_ns is None else arrived_ns
        return frame_of(arrived_ns)

    def _note(self, part: int, post: Callable[..., bool], kind: int, **fields: Any) -> bool:
        took = post(kind, **fields)
        since_ns = time.monotonic_ns() - getattr(self._arrived, "ns", 0)
        is_osc = threading.current_thread().name == "OSC"
        what = (fields.get("index", 0), fields.get("value", 0.0), fields.get("other", 0.0))
        source = SOURCES.index("OSC" if is_osc else "MIDI")
        frame = fields.get("frame")
        frame = -1 if frame is None else frame
        delay = self._server.player.delay
        self._log.extend((kind, *what, frame, since_ns, source, delay, part))
        return took

    def take(self) -> tuple[bytes, list[Array]]:
        """The events posted since the last call, and those fulfilled, by part."""
        fulfilled = [part.instruments[0].applied_wishes() for part in self._server.parts]
        log, self._log = self._log, array("d")
        return log.tobytes(), fulfilled

    def counts(self) -> dict[str, int]:
        """The counters of the audio side."""
        instruments = self._server.ensemble.instruments
        meters = [instrument.meters() for instrument in instruments]
        counts = {what: sum(int(each[what]) for each in meters) for what in OF_PARTS}
        counts |= {what: int(meters[0][what]) for what in OF_ALL}
        counts["dropped"] = sum(instrument.dropped_events for instrument in instruments)
        counts["osc"] = self._server.osc.traffic.packets
        counts["osc_dropped"] = self._server.osc.traffic.kernel_drops
        counts["midi"] = 0 if self._server.midi is None else self._server.midi.received
        return counts


def serve(setting: Setting, pipe: Any) -> None:
    """Serve until told to stop; answer each request with counters and events."""
    delays.HANDLING_MS = setting.handling_ms
    options = ServeOptions(
        output=OutputOptions(device=setting.device, blocksize=setting.block, rate=RATE),
        midi=MidiOptions(),
        osc=("127.0.0.1", 0),
        http=WebOptions(("127.0.0.1", 0)) if setting.has_listeners else None,
        parts=[PartOptions()] * setting.parts,
        jitter_ms=setting.jitter_ms,
    )
    server = Server(options, lambda _line: None)
    witness = Witness(server)
    server.start()
    if setting.is_busy:
        threading.Thread(target=compute, daemon=True).start()
    pipe.send((server.osc.port, None if server.web is None else server.web.port))
    while pipe.recv():
        pipe.send((witness.counts(), *witness.take()))
    server.stop()


def compute() -> None:
    """Keep Python busy."""
    while True:
        sum(number * number for number in range(1000))


# ---------------------------------------------------------------- one row


def run(setting: Setting, seconds: float) -> dict[str, Any]:
    """Play under load for some seconds; return the figures of a row."""
    pipe, there = SPAWN.Pipe()
    server = SPAWN.Process(target=serve, args=(setting, there))
    server.start()
    there.close()
    port, http = pipe.recv()
    load = SPAWN.Process(target=send_load, args=(port, setting.parts), daemon=True)
    load.start()
    listeners = contextlib.nullcontext() if http is None else helper(listen, http)

    def ask() -> Any:
        pipe.send(True)
        return pipe.recv()

    logs, fulfilled, told = [], [], [0]
    try:
        with listeners as pages:
            time.sleep(SETTLED_S)
            before, *_ = ask()
            started = time.monotonic()
            while (left := started + seconds - time.monotonic()) > 0.0:
                time.sleep(min(left, TAKEN_EVERY_S))
                after, log, wishes = ask()
                logs.append(np.frombuffer(log).reshape(-1, POSTED))
                fulfilled.append(wishes)
            lasted = time.monotonic() - started
            load.kill()
            load.join()
            time.sleep(FULFILLED_S)
            fulfilled.append(ask()[2])
            if pages is not None:
                pages.send(None)
                told = pages.recv()
    finally:
        load.kill()
        pipe.send(False)
        server.join(10.0)
        server.kill()
    counts = {what: after[what] - before[what] for what in after}
    by_part = [np.concatenate(wishes) for wishes in zip(*fulfilled, strict=True)]
    return {
        **figures(setting, counts, lasted, np.concatenate(logs), by_part),
        "told_to_listeners": sum(told),
    }


def figures(
    setting: Setting, counts: dict[str, int], lasted: float, log: Array, fulfilled: list[Array]
) -> dict[str, Any]:
    """The figures of a row, from the events posted and those fulfilled, by part."""
    pairs = itertools.chain.from_iterable(
        matched(log[log[:, 8] == part], wishes) for part, wishes in enumerate(fulfilled)
    )
    late, handling = (np.array(row) for row in zip(*pairs, strict=True))
    per_ms = 1e-3 * RATE
    in_time = handling <= setting.handling_ms
    return {
        "block": setting.block,
        "busy": setting.is_busy,
        "parts": setting.parts,
        "listeners": PAGES if setting.has_listeners else 0,
        "handling_ms": setting.handling_ms,
        "delay_ms": float(np.median(log[:, 7])) / per_ms,
        "per_second": {what: counts[what] / lasted for what in ("osc", "midi", "applied")},
        "late": float(np.mean(late > 0)),
        "late_by_machine": float(np.mean((late > 0) & in_time)),
        "late_by_counter": counts["late_events"] / max(1, counts["applied"]),
        "late_ms": spread(late[late > 0] / per_ms),
        "took_ms": {
            source: spread(log[log[:, 6] == number, 5] * 1e-6)
            for number, source in enumerate(SOURCES)
        },
        "dropped": counts["dropped"] + counts["osc_dropped"],
        "late_callbacks": counts["late_callbacks"] / max(1, counts["callbacks"]),
        "underruns": counts["underruns"] / max(1, counts["callbacks"]),
    }


def matched(log: Array, fulfilled: Array) -> Iterator[tuple[float, float]]:
    """How late each event was fulfilled (frames), and how long it was handled (ms)."""
    frames: defaultdict[tuple[float, ...], deque[int]] = defaultdict(deque)
    for wish in np.sort(fulfilled, order="frame"):
        frames[tuple(wish[["kind", "index", "value", "other"]])].append(int(wish["frame"]))
    for kind, index, value, other, frame, took_ns, *_ in log[np.argsort(log[:, 4], kind="stable")]:
        found = frames[kind, index, value, other]
        while found and found[0] < frame:
            found.popleft()
        if found:
            yield found.popleft() - frame, 1e-6 * took_ns


def spread(values: Array) -> list[float]:
    """Median, 99 % and most."""
    if len(values) == 0:
        return [0.0, 0.0, 0.0]
    return [float(np.quantile(values, share)) for share in (0.5, 0.99, 1.0)]


# ---------------------------------------------------------------- the whole


def print_report(rows: list[dict[str, Any]]) -> None:
    """Print the figures."""
    table = Table(title="late events; times in ms: median, 99 %, most", title_justify="left")
    for column in (
        *("block", "Python", "handling", "delay", "late", "by the machine", "how late"),
        *("OSC took", "MIDI took", "dropped", "late callbacks", "under-runs"),
    ):
        table.add_column(column)
    for row in rows:
        table.add_row(
            str(row["block"]),
            "busy" if row["busy"] else "idle",
            f"{row['handling_ms']:g}",
            f"{row['delay_ms']:.2f}",
            f"{row['late']:.2%}",
            f"{row['late_by_machine']:.2%}",
            *(
                " ".join(f"{ms:.2f}" for ms in times)
                for times in (row["late_ms"], *(row["took_ms"][what] for what in SOURCES))
            ),
            str(row["dropped"]),
            f"{row['late_callbacks']:.2%}",
            f"{row['underruns']:.2%}",
        )
    Console(width=160).print(table)


def main() -> None:
    """Measure and print everything."""
    parser = report.options(__doc__)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each row (default: 10)")
    parser.add_argument("--handling", type=float, nargs="+", default=HANDLING_MS, metavar="MS")
    parser.add_argument("--blocks", type=int, nargs="+", default=BLOCKS, metavar="FRAMES")
    parser.add_argument("--steady", action="store_true", help="keep the delay as short as it gets")
    parser.add_argument("--parts", type=int, default=1, help="number of players (default: 1)")
    parser.add_argument("--listeners", action="store_true", help="eight OSCQuery clients listen")
    parser.add_argument("--audio-device", help="see yehu-server devices (default: a dummy)")
    arguments = parser.parse_args()
    warm_up()  # compile before processes wait for each other
    device = arguments.audio_device or CARD
    rows = []
    for block in arguments.blocks:
        with sound_card(arguments.audio_device, block):
            for handling_ms, is_busy in itertools.product(arguments.handling, (False, True)):
                setting = Setting(
                    device,
                    block,
                    handling_ms,
                    arguments.steady,
                    is_busy,
                    arguments.parts,
                    arguments.listeners,
                )
                rows.append(run(setting, arguments.seconds))
    print_report(rows)
    report.save(
        arguments.save,
        rows,
        device=arguments.audio_device or report.NO_CARD,
        seconds=arguments.seconds,
        steady=arguments.steady,
        parts=arguments.parts,
    )


if __name__ == "__main__":
    main()
