"""Deadlines under load: an idle stream, the instrument, and an ordinary Python callback.

    .venv/bin/python bench/endurance.py [--seconds N] [--save bench/results/NAME.json]

Each of the three plays for N seconds (an hour by default), in short turns, so
that all meet the same machine. The load is dense MIDI and OSC from another process and a busy
Python thread in the process that plays. Without --audio-device it starts a JACK server with
the dummy driver, which waits for nobody and has no real-time rights: hence the idle stream.
"""

from __future__ import annotations

import argparse
import contextlib
import ctypes.util
import json
import multiprocessing
import os
import platform
import random
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from run import processor

from yehu_server import server
from yehu_server.audio.output import NULL, Output, OutputOptions, OutputState
from yehu_server.control.packets import pack
from yehu_server.control.ports import MidiOptions
from yehu_server.engine.telemetry import BINS_PER_DEADLINE
from yehu_server.server import ServeOptions, Server

TURN_S = 20.0
SETTLED_S = 1.0
COUNTED = ("callbacks", "missed", "late_callbacks", "underruns", "applied", "late_events")
QUANTILES = (0.5, 0.99, 0.999, 0.9999)
JACK = "yehu-bench"
SPAWN = multiprocessing.get_context("spawn")


# ---------------------------------------------------------------- a sound card, if need be


def start(program: list[str], out: int = subprocess.DEVNULL) -> subprocess.Popen[bytes]:
    """Start a program whose complaints are of no interest."""
    return subprocess.Popen(program, stdout=out, stderr=subprocess.DEVNULL)  # noqa: S603


@contextlib.contextmanager
def dummy_jack(period: int, rate: int = 48000) -> Iterator[None]:
    """A JACK server without a sound card, for all that is started meanwhile."""
    os.environ |= {"JACK_DEFAULT_SERVER": JACK, "JACK_NO_AUDIO_RESERVATION": "1"}
    os.environ["JACK_NO_START_SERVER"] = "1"
    card = ["-d", "dummy", "-r", str(rate), "-p", str(period)]
    program = ["jackd", "--no-realtime", "--no-mlock", "-p", "128", "-n", JACK, *card]
    jackd = start(program)
    deadline = time.monotonic() + 10.0
    try:
        while b"playback_1" not in start(["jack_lsp"], subprocess.PIPE).communicate()[0]:
            if time.monotonic() > deadline:
                sys.exit("JACK's server does not start")
            if jackd.poll() is not None:  # the one before is still in JACK's registry
                jackd = start(program)
            time.sleep(0.05)
        yield
    finally:
        jackd.terminate()
        try:
            jackd.wait(3.0)
        except subprocess.TimeoutExpired:
            jackd.kill()


def sound_card(wanted: str | None, period: int) -> contextlib.AbstractContextManager[object]:
    """The named output, or one that is made for the occasion."""
    if wanted is not None:
        return contextlib.nullcontext()
    if shutil.which("jackd") is None or ctypes.util.find_library("jack") is None:
        sys.exit("without JACK, name an output: --audio-device NAME")
    return dummy_jack(period)


# ---------------------------------------------------------------- the load


def midi_out(name: str) -> Any:
    """A MIDI output that others can open, of the first MIDI system there is."""
    import rtmidi

    for api in rtmidi.get_compiled_api():
        with contextlib.suppress(rtmidi.RtMidiError, SystemError, NotImplementedError):
            midi = rtmidi.MidiOut(api, name=name)
            midi.open_virtual_port("out")
            return midi
    sys.exit("there is no MIDI system")


def send_load(port: int) -> None:
    """Notes, wheels and touch over MIDI, 600 messages a second; OSC, 2,000 a second."""
    osc = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    osc.connect(("127.0.0.1", port))
    midi = midi_out("load")
    chance = random.Random(1)  # noqa: S311
    note, due = 65, time.monotonic()
    while True:
        midi.send_message([0x80, note, 64])
        note = chance.randrange(65, 90)
        midi.send_message([0x90, note, chance.randrange(20, 127)])
        for _ in range(50):
            for message in ([0xE0, chance.randrange(128)], [0xD0], [0xB0, 1]):
                midi.send_message([*message, chance.randrange(128)])
            with contextlib.suppress(ConnectionRefusedError):
                for _ in range(5):
                    osc.send(pack("/yehu/bow/position", chance.uniform(0.05, 0.2)))
                    osc.send(pack("/yehu/playing/pressure", chance.uniform(0.2, 0.6)))
            due += 0.005
            time.sleep(max(0.0, due - time.monotonic()))


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
    parser.add_argument("--seconds", type=float, default=3600.0, help="of each (default: 3600)")
    parser.add_argument("--blocksize", type=int, default=128)
    parser.add_argument("--audio-device", help="see yehu-server devices (default: a dummy)")
    parser.add_argument("--save", type=Path, help="write the figures to a JSON file")
    arguments = parser.parse_args()
    device = arguments.audio_device or "system, JACK"
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
