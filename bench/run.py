"""Speed of kernel, callback and render beside plain C++, of other kernels, and of the start.

    .venv/bin/python bench/run.py [--rounds 9] [--save bench/results/run.json]

The ratios are the time of `yardstick.cpp` over ours, for as much sound: above 1 we are faster. Each
of ours is measured in turn with a run of the yardstick, round after round, by the processor time of
the thread that computes; whole renders by the clock, the yardstick then being a process of its own
that writes nothing. Other kernels too are timed by the processor, and starts by the clock. Every
figure is the median of several, with the extremes.
`scripts/generate` puts saved figures into bench/results/performance.md.
"""

import argparse
import os
import statistics
import subprocess
import tempfile
import time
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import mido
import report
import soundfile
from budget import KERNEL, PLAIN, ROOT, TUNE, WITH_ALL, Worker
from kernel_loop import Kernel
from yardstick import RATE, Yardstick

RUNS = 9
SECONDS = 2.0
YARDSTICK_S = 20.0
ROUNDS_OF_A_PROCESS = 3
RENDER = "whole `render`, by the clock"


def kernel_runs(*case: Any, **options: Any) -> dict[str, Any]:
    """Real-time factors of the bare kernel, radiation included, from a steady state."""
    machine = Kernel(*case, **options)
    rows = machine.rows(round(SECONDS * machine.rate))
    times = report.timed(lambda: machine.advance(*rows), RUNS, time.thread_time)
    return report.spread([SECONDS / each for each in times], "x real time")


def render(score: Path, out: Path, environment: Mapping[str, str], *words: str) -> float:
    """Seconds of a whole `render` command, by the clock."""
    command = [*report.COMMAND, "render", str(score), "-o", str(out), *words]
    start = time.perf_counter()
    subprocess.run(command, check=True, env=environment, capture_output=True)  # noqa: S603
    return time.perf_counter() - start


def start_runs(folder: Path, environment: Mapping[str, str], runs: int) -> dict[str, Any]:
    """Seconds of whole `render` commands of one short note; the first sample comes earlier."""
    note = folder / "note.mid"
    midi = mido.MidiFile(ticks_per_beat=480)
    track = mido.MidiTrack()
    track.append(mido.Message("note_on", note=69, velocity=80))
    track.append(mido.Message("note_off", note=69, time=48))
    midi.tracks.append(track)
    midi.save(str(note))
    out = folder / "out.wav"
    times = [render(note, out, environment, "--tail", "0") for _ in range(runs)]
    return report.spread(times, "s")


def beside_plain_loop(
    folder: Path, environment: Mapping[str, str], rounds: int
) -> dict[str, dict[str, Any]]:
    """Ratios to the yardstick, and how many times real time both are (medians)."""
    yardstick, tune = Yardstick(folder), folder / "tune.wav"
    theirs, ours = defaultdict[str, list[float]](list), defaultdict[str, list[float]](list)
    render(TUNE, tune, environment)
    sound_s = soundfile.info(tune).duration
    for number in range(rounds):
        if number % ROUNDS_OF_A_PROCESS == 0:
            worker = Worker(ROOT)
        for name in (KERNEL, WITH_ALL, PLAIN):
            theirs[name].append(yardstick.run(YARDSTICK_S).cpu_s / YARDSTICK_S)
            ours[name].append(1e-9 * worker.ns(name) * RATE)
        theirs[RENDER].append(yardstick.run(sound_s, 0.0).clock_s / sound_s)
        ours[RENDER].append(render(TUNE, tune, environment) / sound_s)
        if number % ROUNDS_OF_A_PROCESS == ROUNDS_OF_A_PROCESS - 1 or number == rounds - 1:
            worker.close()
    rows = {}
    for name, own in ours.items():
        pairs = zip(theirs[name], own, strict=True)
        rows[name] = {
            **report.spread([plain / each for plain, each in pairs]),
            "ours, x real time": 1.0 / statistics.median(own),
            "plain C++, x real time": 1.0 / statistics.median(theirs[name]),
        }
    return rows


def speeds() -> dict[str, dict[str, Any]]:
    """Real-time factors of the kernel in other cases."""
    figures = {
        "kernel, open string": kernel_runs(1, 0, 0.5),
        "kernel, idle": kernel_runs(1, 0, 0.0, is_idle=True),
        "kernel, vibrato": kernel_runs(1, 1, 0.5, vibrato=True),
        "kernel, four fingers": kernel_runs(4, 4, 0.5),
    }
    for rate in (48.0, 96.0, 192.0):
        name = f"kernel, {rate:g} kHz, bowed and stopped"
        figures[name] = kernel_runs(1, 1, 0.5, rate=1e3 * rate)
    return figures


def main() -> None:
    """Measure, print, and save where wanted."""
    parser = report.options(__doc__ or "")
    parser.add_argument("--rounds", type=int, default=9, help="pairs of each ratio (default: 9)")
    arguments: argparse.Namespace = parser.parse_args()
    ratios: dict[str, dict[str, Any]] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        environment = os.environ | {
            "NUMBA_CACHE_DIR": str(folder / "cache"),
            "PYTHONDONTWRITEBYTECODE": "",  # as at a user's second start
            "PYTHONPYCACHEPREFIX": str(folder / "bytecode"),
        }
        starts = {"render, cold cache": start_runs(folder, environment, 1)}
        starts["render, warm cache"] = start_runs(folder, environment, 5)
        try:
            ratios = beside_plain_loop(folder, environment, arguments.rounds)
        except FileNotFoundError as error:
            print(error)
        else:
            report.show(ratios, "The time of a plain C++ loop over ours")
    kernels = speeds()
    report.show(kernels | starts)
    figures = {"ratios": ratios, "kernels": kernels, "starts": starts}
    report.save(arguments.save, figures, rounds=arguments.rounds)


if __name__ == "__main__":
    main()
