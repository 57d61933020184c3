"""What a rendered frame costs: the whole way by feature and by stage, and beside another checkout.

    .venv/bin/python bench/budget.py [--beside CHECKOUT] [--save bench/results/budget.json]

Nanoseconds of processor time a frame. Each row of the tune has all that the rows above it have, and
one thing more. The rows are measured in turn, round after round, so that a slow minute of the
machine meets all of them; what a row adds is the median of its differences within a round, given
with the quartiles. `scripts/generate` puts the saved budget into bench/results/performance.md. With
`--beside` the same is measured of another checkout (one of before), in a process of its own, a row
of each in turn. Where memory and stack of a process lie makes it up to 5 % faster or slower, so
each few rounds have processes of their own. Only processor time of the thread that computes
counts, so other work on the machine matters little.
"""

from __future__ import annotations

import io
import itertools
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import report

if TYPE_CHECKING:
    from yehu_server.rendering.performance import Performance

ROOT = Path(__file__).resolve().parent.parent
TUNE = ROOT / "examples" / "slow_air.mid"
BARE = {"/playing/variation": 0.0, "/playing/listening": 0.0, "/bow/noise": 0.0, "/body/width": 0.0}
# What each row adds to the one above: settings as shipped, and options of the render.
ROWS: dict[str, tuple[tuple[str, ...], dict[str, Any]]] = {
    "the tune: mono, dry, steady hands, no hair, no ear": ((), {"is_dry": True, "is_mono": True}),
    "hair": (("/bow/noise",), {"is_dry": True, "is_mono": True}),
    "hands that vary": (("/playing/variation",), {"is_dry": True, "is_mono": True}),
    "ear": (("/playing/listening",), {"is_dry": True, "is_mono": True}),
    "stereo": ((), {"is_dry": True}),
    "room, and a body that sounds differently to both sides": (("/body/width",), {}),
}
KERNEL, WRITING = "the kernel alone, one finger, bowed", "writing a WAV of 24 bits"
ALL = (KERNEL, *ROWS, WRITING)
# Not of the budget, but measured likewise, for run.py.
PLAIN = "callback and posting: mono, dry, steady hands, no hair, no ear"
WITH_ALL = "callback and posting: all on, as by default"
BLOCK, POSTED = 128, 1 << 14  # frames: of the callback, and for which notes are posted at once
ROUNDS = 2  # in one process
KERNEL_FRAMES = 4410


def kernel_row() -> Callable[[], int]:
    """The bare kernel, as it is called."""
    from kernel_loop import Kernel

    machine = Kernel(1, 1, 0.5)
    rows = machine.rows(KERNEL_FRAMES)

    def work() -> int:
        for _ in range(40):
            machine.advance(*rows)
        return 40 * KERNEL_FRAMES

    return work


def performances(name: str) -> Callable[[], Performance]:
    """Performances of the tune on one core, with all that rows up to this one have."""
    from yehu_server.playing.options import PlayingOptions
    from yehu_server.rendering.options import Options, Part
    from yehu_server.rendering.performance import Performance
    from yehu_server.scores.smf.reader import read_score

    score, settings = read_score(TUNE), dict(BARE)
    for row, (on, _) in ROWS.items():
        for address in on:
            del settings[address]
        if row == name:
            break
    part = Part(score, PlayingOptions(settings=tuple(settings.items())))
    return lambda: Performance([part], Options(jobs=1, **ROWS[name][1]))


def tune_row(name: str) -> Callable[[], int]:
    """The tune, from its score to samples."""
    perform = performances(name)
    return lambda: sum(len(samples) for samples in perform().blocks())


def callback_row(name: str) -> Callable[[], int]:
    """The tune as the audio callback computes it, block by block, its notes being posted."""
    import numpy as np

    perform = performances(name)

    def work() -> int:
        performance = perform()
        (player,), ensemble = performance.players, performance.ensemble
        out = np.zeros((BLOCK, ensemble.channels), np.float32)
        ends = range(POSTED, performance.score_frames, POSTED)
        for end in ends:
            player.play_before(end)
            for _ in range(POSTED // BLOCK):
                ensemble.process(out)
        return len(ends) * POSTED

    return work


def writing_row() -> Callable[[], int]:
    """Blocks of sound into a WAV file of 24 bits."""
    import numpy as np

    from yehu_server.util.sound_file import SoundWriter

    sound = (0.2 * np.random.default_rng(1).normal(size=(1 << 20, 2))).astype(np.float32)

    def work() -> int:
        with (
            tempfile.TemporaryDirectory() as folder,
            io.FileIO(Path(folder) / "x.wav", "w") as file,
        ):
            writer = SoundWriter(file, Path("x.wav"), 44100, "wav", "24", channels=2)
            for first in range(0, len(sound), 4096):
                writer.write(sound[first : first + 4096])
        return len(sound)

    return work


MAKE: dict[str, Callable[[], Callable[[], int]]] = {
    KERNEL: kernel_row,
    **{name: partial(tune_row, name) for name in ROWS},
    WRITING: writing_row,
    PLAIN: partial(callback_row, next(iter(ROWS))),
    WITH_ALL: partial(callback_row, next(reversed(ROWS))),
}


def answer() -> None:
    """Be a worker: for each name of a row on stdin, write the nanoseconds that a frame takes."""
    works: dict[str, Callable[[], int]] = {}
    for line in sys.stdin:
        name = line.strip()
        if name not in works:
            works[name] = MAKE[name]()
            works[name]()  # once, which does not count
        start = time.thread_time_ns()
        frames = works[name]()
        print((time.thread_time_ns() - start) / frames, flush=True)


class Worker:
    """A process that measures rows of one checkout."""

    def __init__(self, checkout: Path) -> None:
        self._process = subprocess.Popen(  # noqa: S603
            [sys.executable, __file__, "--answer"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | {"PYTHONPATH": str(checkout)},
        )

    def ns(self, name: str) -> float:
        """Nanoseconds of a frame of a row, this time."""
        question, answer = self._process.stdin, self._process.stdout
        if question is None or answer is None:
            raise ValueError("a worker has pipes")
        print(name, file=question, flush=True)
        return float(answer.readline())

    def close(self) -> None:
        """End the process."""
        self._process.communicate()


def measured(checkouts: dict[str, Path], processes: int) -> dict[str, dict[str, list[float]]]:
    """Nanoseconds of each row in each round, by checkout."""
    found: dict[str, dict[str, list[float]]] = {
        which: {name: [] for name in ALL} for which in checkouts
    }
    for _ in range(processes):
        workers = {which: Worker(checkout) for which, checkout in checkouts.items()}
        for _, name, (which, worker) in itertools.product(range(ROUNDS), ALL, workers.items()):
            found[which][name].append(worker.ns(name))
        for worker in workers.values():
            worker.close()
    return found


def table(found: dict[str, dict[str, list[float]]]) -> dict[str, dict[str, float]]:
    """Rows to show: medians, what each adds, and the ratio to the other checkout."""
    here = found["here"]
    rows: dict[str, dict[str, float]] = {}
    before: list[float] | None = None
    for name in ALL:
        row = {"ns a frame": statistics.median(here[name])}
        if name in ROWS:
            if before is not None:
                pairs = zip(here[name], before, strict=True)
                adds = [now - was for now, was in pairs]
                row["adds, from"], row["adds"], row["adds, to"] = statistics.quantiles(adds)
            before = here[name]
        if "beside" in found:
            other = found["beside"][name]
            row["beside"] = statistics.median(other)
            ratios = [now / was for now, was in zip(here[name], other, strict=True)]
            row["ratio"] = statistics.median(ratios)
            row["ratio, from"], row["ratio, to"] = min(ratios), max(ratios)
        rows[name] = row
    return rows


def main() -> None:
    """Measure, print, and save where wanted."""
    if "--answer" in sys.argv:
        answer()
        return
    parser = report.options(__doc__ or "")
    parser.add_argument(
        "--processes", type=int, default=6, help="each measures all rows twice (default: 6)"
    )
    parser.add_argument("--beside", type=Path, help="another checkout, measured in turn")
    arguments = parser.parse_args()
    checkouts = {"here": ROOT}
    if arguments.beside:
        checkouts["beside"] = arguments.beside.resolve()
    rows = table(measured(checkouts, arguments.processes))
    report.show(rows)
    report.save(arguments.save, rows, processes=arguments.processes)


if __name__ == "__main__":
    main()
