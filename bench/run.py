"""Speed of the kernel, of the instrument, of the start; printed, and saved as JSON on request.

    .venv/bin/python bench/run.py [--save bench/results/NAME.json]

Each figure is the median of several runs, with the spread from the fastest to the slowest.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mido
import numpy as np
import report
from rich.console import Console
from rich.table import Table

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics import kernel, layout
from yehu_server.core.physics.quantities import Quantities
from yehu_server.rendering.options import Options
from yehu_server.rendering.performance import Performance
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).resolve().parent.parent
RUNS = 9
SECONDS = 2.0


def measured(work: Callable[[], object], runs: int = RUNS) -> list[float]:
    """Seconds of each run, after a first one that does not count."""
    work()
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return times


def kernel_runs(rate: float, fingers: int, *, bowed: bool, stopped: bool, moving: bool) -> Any:
    """Real-time factors of the bare kernel, radiation included, from a steady state."""
    model = kernel.prepare(Quantities(), rate, fingers)
    state = kernel.at_rest(model)
    frames = round(SECONDS * rate)
    controls = np.zeros((frames, layout.control_columns(fingers)))
    controls[:, layout.F_N] = 0.5 if bowed else 0.0
    controls[:, layout.V_B] = 0.2 if bowed else 0.0
    controls[:, layout.X_B] = 0.27
    wander = 1e-3 * np.sin(np.arange(frames) / rate * 2.0 * np.pi * 6.0) * moving
    for finger in range(fingers):
        at = layout.FINGER_CONTROLS + layout.CONTROLS_PER_FINGER * finger
        controls[:, at] = 0.1 - 0.02 * finger + wander
        controls[:, at + 1] = 1.5 if stopped else 0.0
    probes = np.zeros((frames, layout.probe_columns(fingers)))
    times = measured(lambda: kernel.advance(model, state, controls, probes, None))
    return [SECONDS / t for t in times]


def instrument_runs() -> Any:
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

    return [SECONDS / t for t in measured(work)]


def tune_runs() -> Any:
    """Real-time factors of the example tune, from score to samples."""
    score = read_score(ROOT / "examples" / "shi_bei_jiu.mid")
    factors = []
    for _ in range(3):
        performance = Performance(score, Options())
        start = time.perf_counter()
        frames = sum(len(samples) for samples in performance.blocks())
        factors.append(frames / 44100 / (time.perf_counter() - start))
    return factors


def start_runs(cache: Path, runs: int) -> list[float]:
    """Seconds of whole `render` commands of one short note; the first sample comes earlier."""
    with tempfile.TemporaryDirectory() as folder:
        note = Path(folder) / "note.mid"
        midi = mido.MidiFile(ticks_per_beat=480)
        track = mido.MidiTrack()
        track.append(mido.Message("note_on", note=69, velocity=80))
        track.append(mido.Message("note_off", note=69, time=48))
        midi.tracks.append(track)
        midi.save(str(note))
        command = [sys.executable, "-c", "from yehu_server.cli import main; main()"]
        command += ["render", str(note), "-o", str(Path(folder) / "out.wav"), "--tail", "0"]
        environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
        times = []
        for _ in range(runs):
            start = time.perf_counter()
            subprocess.run(command, check=True, env=environment, capture_output=True)  # noqa: S603
            times.append(time.perf_counter() - start)
    return times


def main() -> None:
    """Measure and print everything."""
    arguments = report.options(__doc__).parse_args()

    figures: dict[str, tuple[str, list[float]]] = {}
    unit = "x real time"
    for name, rate, fingers, options in (
        ("kernel, 44.1 kHz, bowed and stopped", 44100.0, 1, {"bowed": True, "stopped": True}),
        ("kernel, 44.1 kHz, open string", 44100.0, 1, {"bowed": True, "stopped": False}),
        ("kernel, 44.1 kHz, idle", 44100.0, 1, {"bowed": False, "stopped": False}),
        ("kernel, 44.1 kHz, vibrato", 44100.0, 1, {"bowed": True, "stopped": True}),
        ("kernel, 44.1 kHz, four fingers", 44100.0, 4, {"bowed": True, "stopped": True}),
        ("kernel, 48 kHz, bowed and stopped", 48000.0, 1, {"bowed": True, "stopped": True}),
        ("kernel, 96 kHz, bowed and stopped", 96000.0, 1, {"bowed": True, "stopped": True}),
        ("kernel, 192 kHz, bowed and stopped", 192000.0, 1, {"bowed": True, "stopped": True}),
    ):
        figures[name] = (unit, kernel_runs(rate, fingers, moving="vibrato" in name, **options))
    figures["instrument, 44.1 kHz, blocks of 128"] = (unit, instrument_runs())
    figures["example tune, score to samples"] = (unit, tune_runs())
    with tempfile.TemporaryDirectory() as cache:
        figures["render, cold cache"] = ("s", start_runs(Path(cache), 1))
        figures["render, warm cache"] = ("s", start_runs(Path(cache), 5))

    table = Table("what", "median", "from", "to", "")
    for name, (unit, values) in figures.items():
        row = [f"{value:.2f}" for value in (statistics.median(values), min(values), max(values))]
        table.add_row(name, *row, unit)
    Console().print(table)
    record = {
        name: {"unit": unit, "median": statistics.median(values), "all": values}
        for name, (unit, values) in figures.items()
    }
    report.save(arguments.save, record)


if __name__ == "__main__":
    main()
