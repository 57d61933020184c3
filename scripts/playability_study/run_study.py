"""Run the playability study: a million strokes, level by level, and again where it was interrupted.

    .venv/bin/python scripts/playability_study/run_study.py FOLDER [--workers N]

It writes a result for each study of this folder to FOLDER. Coarse maps of all studies come first,
so that what is done at any time is a whole, if coarser, study.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from yehu_server.lab.sweeps.journal import Journal
from yehu_server.lab.sweeps.result import result_of
from yehu_server.lab.sweeps.running import run_levels
from yehu_server.lab.sweeps.study import read_study

HERE = Path(__file__).parent
ORDER = (
    "schelleng_1",
    "schelleng_2",
    "guettler_1",
    "guettler_2",
    "repeats_1",
    "repeats_2",
    "speeds_1",
    "speeds_2",
)
LEVELS = 3


def main() -> None:
    """Run what is not done."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--workers", type=int, metavar="N")
    parser.add_argument("--write", action="store_true", help="only write what is done so far")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for level in range(LEVELS):
        for name in ORDER:
            study = read_study(HERE / f"{name}.toml")
            target = arguments.folder / f"{name}.npz"
            journal = Journal(target, study)
            before, start = journal.count, time.perf_counter()
            if level <= study.levels and not arguments.write:
                run_levels(study, journal.done, journal.add, arguments.workers, levels=level)
            done = journal.count - before
            if done:
                pace = done / (time.perf_counter() - start)
                print(f"{name}, level {level}: {done} strokes, {pace:.0f} a second", flush=True)
            if (level == study.levels or arguments.write) and journal.count:
                result_of(study, *journal.done()).save(target)
            journal.close()


if __name__ == "__main__":
    main()
