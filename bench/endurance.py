"""An hour of playing: deadlines beside an idle stream, memory, and a replay of all of it.

    .venv/bin/python bench/endurance.py [--seconds N] [--save bench/results/NAME.json]
    .venv/bin/python bench/endurance.py --parts 8

`yehu-server serve` plays with --record and --capture. Another process sends dense OSC and MIDI, and
OSCQuery clients listen to every address. An idle stream on the same device shows which deadlines
the machine itself misses, and a program that only receives the same OSC how much of it the machine
gives to Python too late. Memory is sampled every few seconds. In the end the capture is replayed
and compared with the recording, sample by sample. Without --audio-device the benchmark starts a
JACK server with the dummy driver, which has no real-time rights. Each bound is judged, and the exit
code is 1 where one is missed.

With --parts several players are on the stage, each with an input of its own and some of the OSC.
"""

import asyncio
import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import IO, Any
from urllib.request import urlopen

import numpy as np
import report
import soundfile
from load import CARD, helper, loaded, sound_card

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.engine.warming import warm_up
from yehu_server.live import traffic_limits as limits
from yehu_server.live.audio.devices import NULL
from yehu_server.live.audio.output import Output, OutputOptions
from yehu_server.system.sockets import prepare, receive

STARTED_WITHIN_S, ENDED_WITHIN_S = 120.0, 60.0
SETTLED_S = 8.0  # also what pages need is prepared by then
SAMPLE_EVERY_S = 10.0
PAGES = 8
RATE = 48000  # of the dummy device
RECEIVED = ("received", "late")
CALLBACKS = ("callbacks", "missed", "late_callbacks", "underruns")
COUNTERS = (
    *("frame", "missed_deadlines", "late_callbacks", "underruns", "device_losses"),
    *("applied_events", "late_events", "dropped_events", "unconverged_solves", "lost_states"),
    *("osc_messages", "osc_dropped", "osc_failures"),
    *("midi_messages", "midi_late", "midi_malformed"),
    *("http_failures", "http_unsent"),
)
SHOWN = ("missed_deadlines", "late_callbacks", "underruns", "late_events", "midi_late")
COMPARED_FRAMES = 1 << 20
NONE = ("dropped_events", "osc_dropped", "osc_failures", "lost_states", "http_failures")
MORE_LATE = 0.001  # beyond what the idle stream misses, and the idle receiver gets late
MORE_MEMORY_MB = 5.0  # since the second quarter


# ---------------------------------------------------------------- beside the instrument


def play_idle(device: str, blocksize: int, answer: Any) -> None:
    """Play silence with the same callback; answer each request with the callback's counters."""
    output = Output(OutputOptions(device=device, blocksize=blocksize), lambda _line: None)
    rate = output.find()
    ensemble = Ensemble([InstrumentSpec(rate)], memory=output.memory.buffer)
    output.begin(ensemble)
    while True:
        answer.send({what: int(ensemble.meters()[what]) for what in CALLBACKS})
        if not answer.recv():
            break
    output.end()
    os._exit(0)


def receive_idle(block_ms: float, answer: Any) -> None:
    """Receive OSC and do nothing; answer each request with messages received, and how many late.

    A request is the server's delay (ms). Late is what is read, after the kernel has it, when a
    server that took no time could not have played it in time: a block has begun, at some moment
    of the delay's last `block_ms`.
    """
    udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    udp.bind(("127.0.0.1", 0))
    prepare(udp, limits.SOCKET_BUFFER)
    delay_ms, counts = float("inf"), {"received": 0, "late": 0.0}

    def receive_all() -> None:
        while True:
            stamp_ns = receive(udp, limits.DATAGRAM).stamp_ns
            left_ms = delay_ms - 1e-6 * (time.time_ns() - stamp_ns)
            counts["received"] += 1
            counts["late"] += min(1.0, max(0.0, 1.0 - left_ms / block_ms))

    threading.Thread(target=receive_all, daemon=True).start()
    answer.send(udp.getsockname()[1])
    while delay_ms := answer.recv():
        answer.send(dict(counts))


def listen(port: int, answer: Any) -> None:
    """Listen as several pages to every address that has a value; answer with messages received."""
    counts = [0] * PAGES
    answer.send(asyncio.run(_listen(port, counts, answer)))


async def _listen(port: int, counts: list[int], answer: Any) -> list[int]:
    import aiohttp

    async with aiohttp.ClientSession() as session:
        async with session.get(f"http://127.0.0.1:{port}/") as response:
            paths = list(_paths(await response.json()))
        pages = [asyncio.create_task(_page(session, port, paths, counts, i)) for i in range(PAGES)]
        await asyncio.to_thread(answer.recv)
        for page in pages:
            page.cancel()
        await asyncio.gather(*pages, return_exceptions=True)
    return counts


def _paths(node: dict[str, Any]) -> Iterator[str]:
    if "VALUE" in node:
        yield node["FULL_PATH"]
    for child in node.get("CONTENTS", {}).values():
        yield from _paths(child)


async def _page(session: Any, port: int, paths: list[str], counts: list[int], i: int) -> None:
    async with session.ws_connect(f"ws://127.0.0.1:{port}/") as page:
        for path in paths:
            await page.send_json({"COMMAND": "LISTEN", "DATA": path})
        async for _message in page:
            counts[i] += 1


# ---------------------------------------------------------------- the instrument


class Playing:
    """``yehu-server serve`` as a command, with more words of its own; its messages and metrics."""

    def __init__(self, device: str, blocksize: int, *words: str) -> None:
        card = ["--audio-device", device, "--blocksize", str(blocksize)]
        ports = ["--osc", "127.0.0.1:0", "--http", "127.0.0.1:0"]
        self.lines: list[str] = []
        self.process = subprocess.Popen(  # noqa: S603 - our own command
            [*report.COMMAND, "serve", *card, *ports, *words], stderr=subprocess.PIPE, text=True
        )
        threading.Thread(target=self._read, args=(self.process.stderr,), daemon=True).start()
        self.osc = int(self.said(r"OSC at [\d.]+:(\d+)"))
        self.http = int(self.said(r"OSCQuery at http://[\d.]+:(\d+)"))

    def _read(self, pipe: IO[str]) -> None:
        self.lines.extend(line.rstrip() for line in pipe)

    def said(self, pattern: str) -> str:
        """Wait for a message; return the group of the pattern."""
        deadline = time.monotonic() + STARTED_WITHIN_S
        while time.monotonic() < deadline and self.process.poll() is None:
            for line in list(self.lines):
                if found := re.search(pattern, line):
                    return found[1]
            time.sleep(0.05)
        sys.exit("serve does not start:\n" + "\n".join(self.lines))

    def status(self) -> dict[str, float]:
        """Its metrics, by status value."""
        with urlopen(f"http://127.0.0.1:{self.http}/metrics", timeout=10.0) as page:
            lines = page.read().decode().splitlines()
        pairs = (line.split() for line in lines if not line.startswith("#"))
        return {
            name.removeprefix("yehu_").removesuffix("_total"): float(value) for name, value in pairs
        }

    def malformed(self) -> str:
        """The last MIDI message that was none."""
        url = f"http://127.0.0.1:{self.http}/yehu/status/midi_malformed_last"
        with urlopen(url, timeout=10.0) as node:
            return str(json.load(node)["VALUE"][0])

    def memory_mb(self) -> float | None:
        """Memory of the server and its helper processes, shared pages counted once; Linux only."""
        total = 0
        for pid in [self.process.pid, *_children(self.process.pid)]:
            try:
                text = Path(f"/proc/{pid}/smaps_rollup").read_text(encoding="ascii")
            except OSError:
                return None
            found = re.search(r"^Pss: +(\d+) kB", text, re.MULTILINE)
            total += int(found[1]) if found else 0
        return total / 1000.0

    def end(self) -> int:
        """End it; return its exit code."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(ENDED_WITHIN_S)


def _children(pid: int) -> list[int]:
    children = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            children += [int(child) for child in task.read_text(encoding="ascii").split()]
    return children


def replayed_equal(folder: Path) -> tuple[int, int]:
    """Replay the capture; return the frames recorded, and how many differ or are missing."""
    again = folder / "again.wav"
    words = ["replay", str(folder / "take.jsonl"), "-o", str(again), "--quiet"]
    subprocess.run([*report.COMMAND, *words], check=True)  # noqa: S603
    with soundfile.SoundFile(folder / "take.wav") as take, soundfile.SoundFile(again) as other:
        frames, differing = take.frames, abs(take.frames - other.frames)
        while len(samples := take.read(COMPARED_FRAMES, dtype="float32")):
            same = other.read(len(samples), dtype="float32")
            differing += int((samples[: len(same)] != same).any(axis=1).sum())
    return frames, differing


# ---------------------------------------------------------------- the whole


def counted(idle: Any, receiver: Any, playing: Playing) -> tuple[Any, Any, dict[str, float]]:
    """The counts of idle stream, idle receiver and instrument, as they are now."""
    status = playing.status()
    idle.send(True)
    receiver.send(status["delay_ms"])
    return idle.recv(), receiver.recv(), status


def play(
    device: str, blocksize: int, seconds: float, folder: Path, *, parts: int = 1
) -> dict[str, Any]:
    """Play under load, replay the take, and return all counts."""
    with (
        helper(play_idle, device, blocksize) as idle,
        helper(receive_idle, 1e3 * blocksize / RATE) as receiver,
    ):
        idle.recv()
        beside = receiver.recv()
        words = ["--record", str(folder / "take.wav"), "--capture", str(folder / "take.jsonl")]
        playing = Playing(device, blocksize, "--parts", str(parts), "--no-panel", *words)
        with helper(listen, playing.http) as pages, loaded(playing.osc, parts, beside):
            time.sleep(SETTLED_S)
            idle_before, received_before, before = counted(idle, receiver, playing)
            samples, started = [], time.monotonic()
            while (left := started + seconds - time.monotonic()) > 0.0:
                time.sleep(min(SAMPLE_EVERY_S, left))
                samples.append((time.monotonic() - started, playing.memory_mb()))
                if playing.process.poll() is not None:
                    sys.exit("serve ended:\n" + "\n".join(playing.lines))
            idle_after, received_after, after = counted(idle, receiver, playing)
            pages.send(None)
            sent, malformed = pages.recv(), playing.malformed()
        code = playing.end()
        for each in (idle, receiver):
            each.send(False)
    frames, differing = replayed_equal(folder)
    return {
        "exit_code": code,
        "said": [line for line in playing.lines if "could not" in line or "so far" in line],
        "instrument": {what: int(after[what] - before[what]) for what in COUNTERS},
        "midi_malformed_last": malformed,
        "load": after["load"],
        "worst_load": after["worst_load"],
        "idle_stream": {what: idle_after[what] - idle_before[what] for what in CALLBACKS},
        "idle_receiver": {what: received_after[what] - received_before[what] for what in RECEIVED},
        "sent_to_pages": sent,
        "memory_mb": [[round(at_s), mb] for at_s, mb in samples],
        "recorded_frames": frames,
        "replay_differs_in": differing,
    }


def quarters(memory: list[list[float]]) -> list[float]:
    """Median memory of each quarter of the time."""
    edges = np.linspace(0, len(memory), 5).astype(int)
    return [float(np.median([mb for _, mb in memory[a:b]])) for a, b in pairwise(edges) if b > a]


def counts(figures: dict[str, Any]) -> dict[str, Any]:
    """A row of the table: what the instrument missed, and beside it an idle stream."""
    idle, own = figures["idle_stream"], figures["instrument"]
    row = {what.replace("_", " "): own[what] for what in SHOWN}
    return row | {f"idle: {what}".replace("_", " "): idle[what] for what in CALLBACKS[1:]}


def print_figures(figures: dict[str, Any]) -> None:
    """Print what is beside the table."""
    print(", ".join(f"{what} {count}" for what, count in figures["instrument"].items()))
    print(f"last malformed MIDI: {figures['midi_malformed_last'] or 'none'}")
    receiver = figures["idle_receiver"]
    print(f"idle receiver: {receiver['late']:.0f} late of {receiver['received']} messages")
    print(f"load {figures['load']:.3f}, worst {figures['worst_load']:.3f}")
    if None not in [mb for _, mb in figures["memory_mb"]]:
        shown = ", ".join(f"{mb:.0f}" for mb in quarters(figures["memory_mb"]))
        print(f"memory, median of each quarter: {shown} MB")
    print(f"sent to {PAGES} pages: {sum(figures['sent_to_pages'])} messages")
    print(
        f"replay differs in {figures['replay_differs_in']} of {figures['recorded_frames']} frames"
    )


def judged(figures: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Each bound: what was found, the most that may be, and whether it passes."""
    own, idle = figures["instrument"], figures["idle_stream"]
    late_osc = (own["late_events"] - own["midi_late"]) / max(1, own["osc_messages"])
    late_midi = own["midi_late"] / max(1, own["midi_messages"])
    misses = (idle["missed"] + idle["late_callbacks"]) / max(1, idle["callbacks"])
    receiver = figures["idle_receiver"]
    unread = receiver["late"] / max(1, receiver["received"])
    bounds: dict[str, tuple[float, float]] = {
        what.replace("_", " "): (own[what], 0) for what in NONE
    }
    bounds["share of MIDI that came late"] = late_midi, misses + MORE_LATE
    bounds["share of OSC that came late"] = late_osc, misses + unread + MORE_LATE
    memory = figures["memory_mb"]
    if len(memory) >= 4 and None not in [mb for _, mb in memory]:
        _, second, *_, last = quarters(memory)
        bounds["memory gained (MB)"] = last - second, MORE_MEMORY_MB
    bounds["frames in which the replay differs"] = figures["replay_differs_in"], 0
    bounds["exit code"] = figures["exit_code"], 0
    return {
        what: {"found": found, "at most": most, "": "PASS" if found <= most else "FAIL"}
        for what, (found, most) in bounds.items()
    }


def main() -> None:
    """Measure and print everything."""
    parser = report.options(__doc__)
    parser.add_argument("--seconds", type=float, default=3600.0, help="default: 3600")
    parser.add_argument("--blocksize", type=int, default=64)
    parser.add_argument("--parts", type=int, default=1, help="number of players (default: 1)")
    parser.add_argument("--audio-device", help="see yehu-server devices (default: a dummy)")
    arguments = parser.parse_args()
    device = arguments.audio_device or CARD
    if device == NULL:
        sys.exit("the silent clock has no deadlines")
    warm_up()  # compile before processes wait for each other
    how = {"blocksize": arguments.blocksize, "seconds": arguments.seconds, "parts": arguments.parts}
    card = sound_card(arguments.audio_device, arguments.blocksize)
    with card, tempfile.TemporaryDirectory() as folder:
        figures = play(device, folder=Path(folder), **how)
    figures["judged"] = judged(figures)
    print_figures(figures)
    report.show(figures["judged"])
    report.show({"playing": counts(figures)})
    report.save(arguments.save, figures, device=arguments.audio_device or report.NO_CARD, **how)
    if any(bound[""] == "FAIL" for bound in figures["judged"].values()):
        sys.exit(1)


if __name__ == "__main__":
    main()
