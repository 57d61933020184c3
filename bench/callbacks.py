"""Deadlines under load: an idle stream, the instrument, and an ordinary Python callback.

    .venv/bin/python bench/callbacks.py [--seconds N] [--save bench/results/NAME.json]

Each of the three plays for N seconds (a minute by default), in short turns, so
that all meet the same machine. The load is dense MIDI and OSC from another process and a busy
Python thread in the process that plays. Without --audio-device it starts a JACK server with
the dummy driver, which waits for nobody and has no real-time rights: hence the idle stream.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import platform
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from load import CARD, SPAWN, send_load, sound_card
from rich.console import Console
from rich.table import Table
from run import processor

from yehu_server import server
from yehu_server.audio.output import NULL, Output, OutputOptions, OutputState
from yehu_server.control.ports import MidiOptions
from yehu_server.engine.telemetry import BINS_PER_DEADLINE
from yehu_server.server import ServeOptions, Server

TURN_S = 20.0
SETTLED_S = 1.0
COUNTED = ("callbacks", "missed", "late_callbacks", "underruns", "applied", "late_events")
QUANTILES = (0.5, 0.99, 0.999, 0.9999)


@contextlib.contextmanager
def load_on(port: int) -> Iterator[None]:
    """The load, from without and within."""
    sender = SPAWN.Process(target=send_load, args=(port,))
    sender.start()
    ending = threading.Event()

    def work() -> None:
        while not ending.is_set():
            sum(number * number for number in range(1000))

    busy = threading.Thread(target=work)
    busy.start()
    try:
        yield
    finally:
        ending.set()
        busy.join()
        sender.kill()
        sender.join()


# ---------------------------------------------------------------- who plays


class PythonOutput(Output):
    """What most programs do: a Python callback, in the process that handles messages."""

    underruns = 0

    def __init__(self, options: OutputOptions, changed: Callable[[str], None]) -> None:
        super().__init__(options, changed)
        self._asked = options
        self._stream: Any = None

    def find(self) -> float:
        """See `Output`."""
        import sounddevice

        from yehu_server.audio.devices import choose, outputs

        self._card = choose(outputs(sounddevice), self._asked.device)
        return float(self._card.rate)

    def begin(self, instrument: Any) -> None:
        """See `Output`."""
        import sounddevice

        def play(out: Any, _frames: int, _times: Any, status: Any) -> None:
            self.underruns += bool(status.output_underflow)
            instrument.process(out)

        instrument.channels = min(self._asked.channels, self._card.channels)
        self._stream = sounddevice.OutputStream(
            device=self._card.index,
            samplerate=instrument.rate,
            blocksize=self._asked.blocksize,
            channels=instrument.channels,
            latency=self._asked.latency,
            dtype="float32",
            clip_off=True,
            dither_off=True,
            callback=play,
        )
        self._stream.start()
        self.state = OutputState(self._card.full_name, 1e3 * self._stream.latency)

    def end(self) -> None:
        """See `Output`."""
        if self._stream is not None:
            self._stream.close()


def take_turn(kind: str, seconds: float, device: str, block: int, answer: Any) -> None:
    """Play for a while; answer with what was counted."""
    if kind == "python":
        vars(server)["Output"] = PythonOutput
    options = ServeOptions(
        output=OutputOptions(device=device, blocksize=block),
        midi=MidiOptions() if kind != "idle" else None,
        osc=("127.0.0.1", 0),
    )
    playing = Server(options, lambda _line: None)
    playing.start()
    with contextlib.nullcontext() if kind == "idle" else load_on(playing.osc.port):
        time.sleep(SETTLED_S + (0.0 if kind == "idle" else 2.0))
        before = counts(playing)
        time.sleep(seconds)
        after = counts(playing)
    answer.send({what: after[what] - before[what] for what in before})
    playing.stop()
    os._exit(0)


def counts(playing: Server) -> dict[str, Any]:
    """All that is counted, so far."""
    meters = playing.instrument.meters()
    counted: dict[str, Any] = {what: int(meters[what]) for what in COUNTED}
    if isinstance(playing.output, PythonOutput):
        counted["underruns"] = playing.output.underruns
    counted["frames"] = int(meters["frame"])
    counted["loads"] = meters["loads"].copy()
    counted["midi"] = playing.midi.received if playing.midi else 0
    counted["osc"] = playing.osc.traffic.packets
    return counted


def quantile(loads: Any, share: float) -> float:
    """The load that so large a share of callbacks stays below, to a sixty-fourth."""
    return (int(np.searchsorted(np.cumsum(loads), share * loads.sum())) + 1) / BINS_PER_DEADLINE


def main() -> None:
    """Measure and print everything."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60.0, help="of each (default: 60)")
    parser.add_argument("--blocksize", type=int, default=128)
    parser.add_argument("--audio-device", help="see yehu-server devices (default: a dummy)")
    parser.add_argument("--save", type=Path, help="write the figures to a JSON file")
    arguments = parser.parse_args()
    device = arguments.audio_device or CARD
    if device == NULL:
        sys.exit("the silent clock has no deadlines")

    names = {
        "idle": "idle stream",
        "instrument": "the instrument, under load",
        "python": "a Python callback, under load",
    }
    totals: dict[str, dict[str, Any]] = {}
    left = arguments.seconds
    with sound_card(arguments.audio_device, arguments.blocksize):
        while left > 0.0:
            for kind, name in names.items():
                here, there = SPAWN.Pipe()
                turn = SPAWN.Process(
                    target=take_turn,
                    args=(kind, min(left, TURN_S), device, arguments.blocksize, there),
                )
                turn.start()
                there.close()
                try:
                    counted = here.recv()
                except EOFError:
                    sys.exit(f"{name}: ended before its time")
                finally:
                    turn.join()
                total = totals.setdefault(kind, dict.fromkeys(counted, 0))
                for what, count in counted.items():
                    total[what] = total[what] + count
            left -= TURN_S

    table = Table(title=f"blocks of {arguments.blocksize} frames, {arguments.seconds:g} s each")
    table.add_column("", no_wrap=True)
    for column in ("callbacks", "missed", "late", "under-runs", "MIDI", "OSC", "late events"):
        table.add_column(column)
    for share in QUANTILES:
        table.add_column(f"load {100 * share:g} %")
    figures = {}
    for kind, name in names.items():
        total = totals[kind]
        loads = total.pop("loads")
        row = [total[what] for what in ("callbacks", "missed", "late_callbacks", "underruns")]
        row += [total["midi"], total["osc"], total["late_events"]]
        total["load_quantiles"] = {str(share): quantile(loads, share) for share in QUANTILES}
        shares = [f"{share:.2f}" for share in total["load_quantiles"].values()]
        table.add_row(name, *map(str, row), *shares)
        figures[name] = total
    Console(width=150).print(table)
    if arguments.save:
        arguments.save.parent.mkdir(parents=True, exist_ok=True)
        record = {
            "machine": f"{processor()}, {os.cpu_count()} cores, {platform.system()}",
            "python": platform.python_version(),
            "device": arguments.audio_device or "JACK, dummy driver, no real-time rights",
            "seconds": arguments.seconds,
            "blocksize": arguments.blocksize,
            "figures": figures,
        }
        arguments.save.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
