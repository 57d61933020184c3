"""What silence costs: parts at rest beside the same parts playing, and an idle `serve`.

    .venv/bin/python bench/silence.py [--save bench/results/NAME.json]

A frame by the processor time of the thread that computes, in blocks of 128 at 48 kHz, the least of
many runs. Of `serve` the time of all its processes, as a share of one core: over JACK's dummy
driver, half a minute after its start, without a page. Linux only.
"""

from __future__ import annotations

import argparse
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import load
import numpy as np
import report

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.commands import BEGIN

RATE, BLOCK = 48000.0, 128
PARTS = (1, 4, 16)
RUNS, BLOCKS = 60, 40
SETTLED_S, WATCHED_S = 30.0, 20.0


def frame_ns(parts: int, *, is_playing: bool) -> float:
    """Nanoseconds of a frame of all parts and the room, after three seconds."""
    ensemble = Ensemble([InstrumentSpec(RATE, seed=part) for part in range(parts)])
    for part, instrument in enumerate(ensemble.instruments):
        if is_playing:
            instrument.post(BEGIN, value=66.0 + part % 12, other=66.0 + part % 12)
    out = np.zeros((BLOCK, 2), np.float32)
    for _ in range(round(3.0 * RATE / BLOCK)):
        ensemble.process(out)
    runs = []
    for _ in range(RUNS):
        began_ns = time.thread_time_ns()
        for _ in range(BLOCKS):
            ensemble.process(out)
        runs.append((time.thread_time_ns() - began_ns) / (BLOCKS * BLOCK))
    return min(runs)


def family(process: int) -> list[int]:
    """A process and those it has started."""
    threads = Path(f"/proc/{process}/task").glob("*/children")
    started = [int(child) for thread in threads for child in thread.read_text().split()]
    return [process, *(each for child in started for each in family(child))]


def spent_s(process: int) -> float:
    """Processor time of all threads of a process and of those it has started."""
    threads = [
        thread
        for each in family(process)
        for thread in Path(f"/proc/{each}/task").glob("*/schedstat")
    ]
    return sum(int(thread.read_text().split()[0]) for thread in threads) / 1e9


def idle_share(parts: int) -> float:
    """Share of a core that an idle server takes, over JACK."""
    program = [*report.COMMAND, "serve", "--audio-device", load.CARD, "--parts", str(parts)]
    server = load.start(program)
    try:
        time.sleep(SETTLED_S)
        began, before = time.monotonic(), spent_s(server.pid)
        time.sleep(WATCHED_S)
        if server.poll() is not None:
            sys.exit("the server has ended")
        return (spent_s(server.pid) - before) / (time.monotonic() - began)
    finally:
        server.send_signal(signal.SIGINT)
        try:
            server.wait(10.0)
        except subprocess.TimeoutExpired:
            server.kill()


def measure(_: argparse.Namespace) -> dict[str, dict[str, Any]]:
    figures = {}
    with load.sound_card(None, BLOCK):
        for parts in PARTS:
            silent, playing = (frame_ns(parts, is_playing=which) for which in (False, True))
            figures[f"{parts} parts"] = {
                "silent, ns a frame": silent,
                "playing, ns a frame": playing,
                "silent over playing": silent / playing,
                "idle serve, % of a core": 100.0 * idle_share(parts),
            }
    return figures


if __name__ == "__main__":
    report.run(__doc__, measure)
