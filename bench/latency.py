"""End-to-end latency: from sending a message to the first sample that it changes.

    .venv/bin/python bench/latency.py [--trials N] [--busy] [--save bench/results/NAME.json]

A JACK client in another process sends OSC or MIDI at random times and listens. A note sounds
throughout, and each message opens or closes its volume, so the message is heard at the first sample
that is not zero. The sample's time is the start of JACK's cycle on the monotonic clock plus its
place in the cycle; where JACK is late, so is the sample. The device's own latency, the last
column, comes on top. The instrument's own share is the time from the message's arrival, as stamped,
to the frame at which the player applies it.
"""

import os
import random
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import report
from load import JACK, MidiOut, compute, dummy_jack, helper, start

from yehu_server.core.engine.mailbox import MIDI_INPUTS, SMALL_RING
from yehu_server.core.midi.packing import PORT_SHIFT, packed
from yehu_server.core.player.commands import WRITE
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.midi.midi_inputs import MidiOptions
from yehu_server.live.options import ServeOptions
from yehu_server.live.osc.packets import pack, unpack
from yehu_server.live.server import Server

RATE = 48000
BLOCKS = (64, 128)
VOLUME = 7
PORT = 0xFF << PORT_SHIFT  # in the index of an event
OPEN_S, CLOSED_S = 0.04, 0.06  # longer than the volume's smoothing


class Listener:
    """A JACK client that finds the first sample after silence."""

    def __init__(self) -> None:
        import jack

        for silence in (jack.set_error_function, jack.set_info_function):
            silence(lambda _message: None)
        self.client = jack.Client("listener", servername=JACK, no_start_server=True)
        self._port = self.client.inports.register("in")
        self._was_silent = False
        self.changed: list[float] = []  # ns
        self.xruns = 0
        self.client.set_process_callback(self._hear)
        self.client.set_xrun_callback(self._late)
        self.client.activate()
        deadline = time.monotonic() + 10.0
        while not self.client.get_ports("yehu-server:out_0") and time.monotonic() < deadline:
            time.sleep(0.05)
        self.client.connect("yehu-server:out_0", self._port)

    def _hear(self, _frames: int) -> None:
        cycle_ns = time.monotonic_ns()
        samples = self._port.get_array()
        if self._was_silent and samples.any():
            self.changed.append(cycle_ns + 1e9 * int(np.flatnonzero(samples)[0]) / RATE)
        self._was_silent = not samples.any()

    def _late(self, _delay_us: float) -> None:
        self.xruns += 1


def measure(kind: str, port: int, trials: int, answer: Any) -> None:
    """Send and listen; answer with the latencies (ms) and the number of xruns."""
    osc = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    osc.connect(("127.0.0.1", port))
    midi = MidiOut("bench") if kind == "MIDI" else None
    listener = Listener()
    time.sleep(2.0)  # until the port is found

    def volume(value: int) -> None:
        if midi is not None:
            midi.send([0xB0, VOLUME, 127 * value])
        else:
            osc.send(pack("/yehu/playing/volume", float(value)))

    chance = random.Random(3)  # noqa: S311
    if midi is not None:
        midi.send([0x90, 69, 90])
    else:
        osc.send(pack("/yehu/note", 69.0, 90.0))
    time.sleep(0.3)
    latencies = []
    for _ in range(trials):
        volume(0)
        time.sleep(CLOSED_S + 0.01 * chance.random())
        listener.changed.clear()
        sent_ns = time.monotonic_ns()
        volume(1)
        time.sleep(OPEN_S)
        if listener.changed:
            latencies.append(1e-6 * (listener.changed[0] - sent_ns))
    answer.send((latencies, listener.xruns))
    answer.close()
    os._exit(0)


class Witness:
    """Notes the frames at which messages arrived and were applied."""

    def __init__(self, server: Server, kind: str) -> None:
        self._instrument = server.instrument
        self._arrived: list[float] = []
        self._instrument.report_commands()
        if kind == "OSC":
            handle = server.handler.handle

            def hear(packet: bytes, peer: Any, arrived_ns: int) -> Iterator[None]:
                (message,) = unpack(packet)
                if message.address == "/yehu/playing/volume" and message.arguments[0] == 1.0:
                    self._arrived.append(self._instrument.frame_at(arrived_ns))
                return handle(packet, peer, arrived_ns)

            vars(server.handler)["handle"] = hear
        else:
            threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self) -> None:
        """Read the arrivals of MIDI messages from their ring, soon: the clock is corrected."""
        rig, seen = self._instrument._rig, 0  # noqa: SLF001
        wanted = packed([0xB0, VOLUME, 127])
        while True:
            posted = int(rig["mail"]["posted"][0, MIDI_INPUTS, 0])
            for number in range(seen, posted):
                entry = rig["midi_ring"][0, number % SMALL_RING]
                if int(entry["index"]) & ~PORT == wanted:
                    self._arrived.append(self._instrument.frame_at(int(entry["frame"])))
            seen = posted
            time.sleep(0.02)

    def shares(self) -> list[float]:
        """Time from arrival to application (ms) of each message that opened the volume."""
        commands: Any = self._instrument.applied_commands()
        is_volume = (commands["kind"] == WRITE) & (commands["index"] == INDEX["/playing/volume"])
        opened = commands["frame"][is_volume & (commands["value"] == 1.0)]
        nexts = np.searchsorted(opened, self._arrived)
        return [
            1e3 * float(opened[at] - came) / RATE
            for at, came in zip(nexts, self._arrived, strict=True)
            if at < len(opened)
        ]


def run(kind: str, block: int, trials: int) -> dict[str, Any]:
    """One row of the table."""
    options = ServeOptions(
        output=OutputOptions(device="system, JACK", blocksize=block),
        midi=MidiOptions(api="jack") if kind == "MIDI" else None,
        has_room=False,  # whose sound would go on while the volume is 0
        osc=("127.0.0.1", 0),
    )
    server = Server(options, lambda _line: None)
    witness = Witness(server, kind)
    server.start()
    try:
        with helper(measure, kind, server.osc.port, trials) as client:
            latencies, xruns = client.recv()
    except EOFError:
        sys.exit("the JACK client ended before its time")
    finally:
        shares = witness.shares()
        late = int(server.instrument.meters()["late_events"])
        server.stop()
    if len(latencies) < 2 or len(shares) < 2:
        sys.exit("nothing was heard")
    share = report.quantiles(shares)
    return {
        "heard": f"{len(latencies)} of {trials}",
        **report.quantiles(latencies),
        **{f"own {what}": share[what] for what in ("median", "most", "jitter")},
        "within 2 blocks + 0.5": sum(s < 2e3 * block / RATE + 0.5 for s in shares) / len(shares),
        "device": 1e3 * device_frames() / RATE,
        "late events": late,
        "xruns": xruns,
    }


def device_frames() -> int:
    """Latency from JACK's cycle to the device's output, as the driver reports it."""
    out, _ = start(["jack_lsp", "-l", "system:playback_1"], subprocess.PIPE).communicate()
    found = re.search(rb"playback latency = \[ \d+ (\d+) \]", out)
    return int(found[1]) if found else 0


def main() -> None:
    """Measure and print everything."""
    parser = report.options(__doc__)
    parser.add_argument("--trials", type=int, default=200, help="of each (default: 200)")
    parser.add_argument("--busy", action="store_true", help="beside a thread that computes")
    arguments = parser.parse_args()
    if arguments.busy:
        compute()
    figures = {}
    for block in BLOCKS:
        with dummy_jack(block, RATE):
            for kind in ("OSC", "MIDI"):
                figures[f"{kind}, blocks of {block}"] = run(kind, block, arguments.trials)
    report.show(figures, "ms; jitter is the standard deviation")
    report.save(arguments.save, figures, device=report.NO_CARD, trials=arguments.trials)


if __name__ == "__main__":
    main()
