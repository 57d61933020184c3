"""Keep every signal of the strokes of a study, each in a file as `simulate` writes it."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.errors import OutputError, ParameterError
from yehu_server.lab.simulation import simulate
from yehu_server.lab.sweeps.result import Result
from yehu_server.lab.sweeps.study import Study
from yehu_server.util.files import why

Progress = Callable[[float, float], None]

MOST_FILES = 10_000
NAME = re.compile(r"[0-9]+\.npz")


def keep_signals(
    study: Study,
    result: Result,
    folder: Path,
    *,
    energy: bool = False,
    strings_every: int = 0,
    workers: int | None = None,
    progress: Progress | None = None,
) -> int:
    """Simulate the strokes of a result again, and write the arrays of each to ``NUMBER.npz``.

    The number is that of the stroke in the result, from 0. A file that is there is kept, so that an
    interrupted call goes on. `prepare_folder` comes first. Returns the number of files. `energy`
    and `strings_every` are as of `simulate`; so many `workers` run at a time, by default one per
    core; `progress` is called with the number of runs done, and of all. Raises OutputError where
    one cannot be written.
    """
    width = len(str(len(result) - 1))

    def run(number: int) -> None:
        target = folder / f"{number:0{width}}.npz"
        if target.exists():
            return
        gesture = study.bow.gesture(study.axes, result.index[number].tolist())
        run = simulate(gesture, energy=energy, strings_every=strings_every)
        run.save(target)

    pool = ThreadPoolExecutor(workers or os.cpu_count())
    try:
        for done, _ in enumerate(pool.map(run, range(len(result))), start=1):
            if progress is not None:
                progress(done, len(result))
    finally:  # an interrupt or a failed run: the others need not run
        pool.shutdown(cancel_futures=True)
    return len(result)


def prepare_folder(study: Study, folder: Path, *, overwrite: bool = False) -> None:
    """Make the folder for signals, or check the one that is there.

    Raises ParameterError where the study has more strokes than MOST_FILES, or is refined;
    OutputError where the folder has signals of another sweep and `overwrite` is false.
    """
    if study.levels:
        raise ParameterError("--signals: a study that is refined keeps none")
    count = int(np.prod(study.shape, dtype=np.int64))
    if count > MOST_FILES:
        raise ParameterError(f"--signals: {count} strokes are more than {MOST_FILES}")
    mark: Any = folder / "study.json"
    text = study.as_text() + "\n"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        files = [file for file in folder.glob("*.npz") if NAME.fullmatch(file.name)]
        ours = mark.is_file() and mark.read_text(encoding="utf-8") == text
        if files and not ours and not overwrite:
            raise OutputError(f"{folder}: there are signals of another sweep; --overwrite them")
        for file in files:
            if overwrite or not ours:
                file.unlink()
        mark.write_text(text, encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{folder}: {why(error)}") from error
