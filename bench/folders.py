"""Speed and memory of rendering a folder of scores: on one process, on two, on a cluster.

    .venv/bin/python bench/folders.py [--files 1000] [--seconds 2] [--save bench/results/NAME.json]

Each score is a phrase of its own. Beside times by the clock there is the CPU time of all
processes: on a machine that others use too, only that can be compared. `--overhead N` also sends
N empty jobs through a Dask scheduler, which tells what one costs.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mido
import report

TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")
HERE = ("--host", "127.0.0.1", "--no-dashboard")
NOTES = (65, 67, 69, 72, 74, 77, 79, 81)


def write_scores(folder: Path, files: int, seconds: float) -> None:
    """Write MIDI files of four notes each, all different."""
    folder.mkdir()
    ticks = round(seconds * 960 / 4)
    for number in range(files):
        midi = mido.MidiFile(ticks_per_beat=480)
        track = mido.MidiTrack()
        for k in range(4):
            note = NOTES[(number // len(NOTES) ** k) % len(NOTES)]
            track.append(mido.Message("note_on", note=note, velocity=60 + number % 60))
            track.append(mido.Message("note_off", note=note, time=ticks))
        midi.tracks.append(track)
        midi.save(str(folder / f"{number:06}.mid"))


class PlotData:
    """CPU time and memory of a process and of those that it started."""

    def __init__(self, pid: int) -> None:
        self.pid = pid
        self.cpu_s: dict[int, float] = {}
        self.megabytes: list[float] = []  # of all together, once a look

    def look(self) -> None:
        """Read what they have used so far."""
        pids = [self.pid]
        for pid in pids:
            with contextlib.suppress(OSError):
                pids += map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split())
        total = 0.0
        for pid in pids:
            with contextlib.suppress(OSError, ValueError, IndexError):
                self.cpu_s[pid] = cpu_of(pid)
                total += int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * 4096 / 2**20
        if total:
            self.megabytes.append(total)


def cpu_of(pid: int) -> float:
    """CPU seconds that a process has used."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) * TICK_S


def render(scores: Path, out: Path, *words: str, beside: tuple[int, ...] = ()) -> dict[str, Any]:
    """Render a folder; figures of the whole command, the processes `beside` it included."""
    command = [*report.COMMAND, "render", str(scores), "-o", str(out), "--quiet"]
    before = sum(map(cpu_of, beside))
    start = time.perf_counter()
    process = subprocess.Popen([*command, *words])  # noqa: S603 - our own
    watch = PlotData(process.pid)
    while process.poll() is None:
        watch.look()
        time.sleep(0.2)
    elapsed = time.perf_counter() - start
    if process.returncode:
        raise SystemExit(process.returncode)
    made = len(list(out.glob("*.wav")))
    own = sum(watch.cpu_s.values())
    third = max(1, len(watch.megabytes) // 3)
    return {
        "files/s": made / elapsed,
        "CPU ms a file": 1e3 * (own + sum(map(cpu_of, beside)) - before) / made,
        "of the command": 1e3 * own / made,
        "MB early": max(watch.megabytes[:third]),
        "MB late": max(watch.megabytes[-third:]),
        "load": os.getloadavg()[0],
    }


@contextlib.contextmanager
def cluster(folder: Path, workers: int) -> Iterator[tuple[str, int, tuple[int, ...]]]:
    """Run a scheduler and workers; yield its file, its process and those of the workers."""
    file = folder / f"scheduler-{workers}.json"
    python = [sys.executable, "-m"]
    with contextlib.ExitStack() as stack, (folder / "log").open("a") as log:

        def start(*words: str) -> int:
            process = subprocess.Popen([*python, *words, *HERE], stdout=log, stderr=log)  # noqa: S603
            stack.callback(process.wait)
            stack.callback(process.terminate)
            return process.pid

        scheduler = start(
            "distributed.cli.dask_scheduler", "--port", "0", "--scheduler-file", str(file)
        )
        while not file.exists():
            time.sleep(0.1)
        own = ("--nthreads", "1", "--no-nanny", "--scheduler-file", str(file))
        pids = tuple(start("distributed.cli.dask_worker", *own) for _ in range(workers))
        yield str(file), scheduler, pids


def overhead(address: str, scheduler: int, jobs: int) -> dict[str, float]:
    """What an empty job costs: by the clock, and CPU time of client and scheduler."""
    from yehu_server.rendering.cluster import Cluster

    with Cluster(address) as connected:
        list(connected.perform_all(nothing, range(100)))
        start, here, there = time.perf_counter(), time.process_time(), cpu_of(scheduler)
        count = sum(event.is_end for event in connected.perform_all(nothing, range(jobs)))
        elapsed = time.perf_counter() - start
        return {
            "elapsed_ms": 1e3 * elapsed / count,
            "client_cpu_ms": 1e3 * (time.process_time() - here) / count,
            "scheduler_cpu_ms": 1e3 * (cpu_of(scheduler) - there) / count,
        }


def nothing(_task: object, _tell: object) -> None:
    """Do an empty job."""


def main() -> None:
    """Measure and print everything."""
    parser = report.options(__doc__)
    parser.add_argument("--files", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=2.0, help="of each score")
    parser.add_argument("--jobs", type=int, nargs="*", default=[1, 2])
    parser.add_argument("--workers", type=int, nargs="*", default=[1, 2, 4], help="of a cluster")
    parser.add_argument("--overhead", type=int, default=0, metavar="N", help="empty jobs")
    arguments = parser.parse_args()
    os.environ["PYTHONPATH"] = os.pathsep.join(
        filter(None, (str(Path(__file__).parent), os.environ.get("PYTHONPATH")))
    )
    figures: dict[str, dict[str, Any]] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scores = folder / "scores"
        write_scores(scores, arguments.files, arguments.seconds)
        for jobs in arguments.jobs:
            figures[f"--jobs {jobs}"] = render(scores, folder / f"{jobs}", "--jobs", f"{jobs}")
        for workers in arguments.workers:
            with cluster(folder, workers) as (file, scheduler, pids):
                figures[f"cluster of {workers}"] = render(
                    scores, folder / f"c{workers}", "--dask", file, beside=(scheduler, *pids)
                )
        again = "up to date, again"
        if arguments.jobs:
            figures[again] = render(scores, folder / f"{arguments.jobs[0]}")
        if arguments.overhead:
            from folders import nothing  # as workers find it, and not as of this script

            globals()["nothing"] = nothing
            with cluster(folder, 2) as (file, scheduler, _):
                figures["an empty job"] = overhead(file, scheduler, arguments.overhead)
    report.show(figures)
    report.save(arguments.save, figures, files=arguments.files, seconds=arguments.seconds)


if __name__ == "__main__":
    main()
