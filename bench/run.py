"""Speed of the kernel, of the instrument, of the start; printed, and saved as JSON on request.

    .venv/bin/python bench/run.py [--save bench/results/NAME.json]

Each figure is the median of several runs, with the spread from the fastest to the slowest.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import mido
import numpy as np
import report
from parts import Kernel

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.rendering.options import Options
from yehu_server.rendering.performance import Performance
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).resolve().parent.parent
RUNS = 9
SECONDS = 2.0


def kernel_runs(*case: Any, **options: Any) -> dict[str, Any]:
    """Real-time factors of the bare kernel, radiation included, from a steady state."""
    machine = Kernel(*case, **options)
    rows = machine.rows(round(SECONDS * machine.rate))
    return factors(report.timed(lambda: machine.advance(*rows), RUNS))


def factors(times: list[float], seconds: float = SECONDS) -> dict[str, Any]:
    return report.spread([seconds / each for each in times], "x real time")


def instrument_runs() -> dict[str, Any]:
    """Real-time factors of `Instrument.process`, a stopped note, blocks of 128."""
    instrument = Instrument(InstrumentSpec(44100.0))
    instrument.write("/finger/1/position", 0.1, ramp_ms=0.0)
    instrument.write("/finger/1/press", 1.5)
    instrument.write("/bow/side", 1.0)
    instrument.write("/bow/speed", 0.2)
    block = np.zeros(128, np.float32)
    blocks = round(SECONDS * 44100 / len(block))

    def work() -> None:
        for _ in range(blocks):
            instrument.process(block)

    return factors(report.timed(work, RUNS))


def tune_runs() -> dict[str, Any]:
    """Real-time factors of the example tune, from score to samples."""
    score = read_score(ROOT / "examples" / "shi_bei_jiu.mid")

    def play() -> int:
        return sum(len(samples) for samples in Performance(score, Options()).blocks())

    return factors(report.timed(play, 3), play() / 44100)


def start_runs(cache: str, runs: int) -> dict[str, Any]:
    """Seconds of whole `render` commands of one short note; the first sample comes earlier."""
    with tempfile.TemporaryDirectory() as folder:
        note = Path(folder) / "note.mid"
        midi = mido.MidiFile(ticks_per_beat=480)
        track = mido.MidiTrack()
        track.append(mido.Message("note_on", note=69, velocity=80))
        track.append(mido.Message("note_off", note=69, time=48))
        midi.tracks.append(track)
        midi.save(str(note))
        words = ["render", str(note), "-o", str(Path(folder) / "out.wav"), "--tail", "0"]
        command, environment = [*report.COMMAND, *words], os.environ | {"NUMBA_CACHE_DIR": cache}
        times = []
        for _ in range(runs):
            start = time.perf_counter()
            subprocess.run(command, check=True, env=environment, capture_output=True)  # noqa: S603
            times.append(time.perf_counter() - start)
    return report.spread(times, "s")


def measure(_: argparse.Namespace) -> dict[str, dict[str, Any]]:
    figures = {
        "kernel, open string": kernel_runs(1, 0, 0.5),
        "kernel, idle": kernel_runs(1, 0, 0.0, is_idle=True),
        "kernel, vibrato": kernel_runs(1, 1, 0.5, vibrato=True),
        "kernel, four fingers": kernel_runs(4, 4, 0.5),
    }
    for rate in (44.1, 48.0, 96.0, 192.0):
        name = f"kernel, {rate:g} kHz, bowed and stopped"
        figures[name] = kernel_runs(1, 1, 0.5, rate=1e3 * rate)
    figures["instrument, 44.1 kHz, blocks of 128"] = instrument_runs()
    figures["example tune, score to samples"] = tune_runs()
    with tempfile.TemporaryDirectory() as cache:
        figures["render, cold cache"] = start_runs(cache, 1)
        figures["render, warm cache"] = start_runs(cache, 5)
    return figures


if __name__ == "__main__":
    report.run(__doc__, measure)
