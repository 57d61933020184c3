"""Run a study: on the cores of this machine, or on a cluster; again where it was interrupted.

Every signal of its strokes is kept on demand, each in a file as `simulate` writes it.
"""

import os
import re
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from yehu_lab.regimes.columns import FINDING, HELMHOLTZ, REGIMES
from yehu_lab.regimes.strokes import find
from yehu_lab.sweeps.axes import coarse_points, finer_points
from yehu_lab.sweeps.journal import Done, Journal, journal_of
from yehu_lab.sweeps.result import Result, result_of
from yehu_lab.sweeps.study import Study, study_from_text
from yehu_server.errors import OutputError, ParameterError, YehuError
from yehu_server.simulation.run import simulate
from yehu_server.util.files import check_free, check_target, error_reason, replace_any, replace_none

Array = Any
Progress = Callable[[float, float], None]

CHUNK = 64  # strokes that are one task
_study = lru_cache(maxsize=4)(study_from_text)
MAX_FILES = 10_000
NAME = re.compile(r"[0-9]+\.npz")


def sweep(
    study: Study,
    *,
    workers: int | None = None,
    cluster: Any = None,
    progress: Progress | None = None,
) -> Result:
    """Run a study, and keep what it finds in memory.

    The same study finds the same, to the bit, with any number of workers. It runs in so many
    threads, `workers`, by default one per core, since the model runs without the GIL; or on a
    cluster (`rendering.cluster.Cluster`). `progress` is called with the number of strokes done, and
    of those known to be wanted.
    """
    known = Done()
    run_levels(study, known, workers, cluster, progress)
    return result_of(study, *known.done())


def sweep_to(
    study: Study,
    target: Path,
    *,
    workers: int | None = None,
    cluster: Any = None,
    progress: Progress | None = None,
    overwrite: bool = False,
) -> Result:
    """Run a study, and write what it finds to a file.

    Where it is interrupted, what is done is in a journal beside the file, and the next call with
    the same study goes on; a KeyboardInterrupt has a text that says so. `overwrite` replaces a
    result, or a journal, that is there; the rest is as of `sweep`. Raises OutputError where there
    is a result, or the file cannot be written.
    """
    check_free_result(target, overwrite=overwrite)
    journal = Journal(target, study, overwrite=overwrite)
    try:
        run_levels(study, journal, workers, cluster, progress)
        result = result_of(study, *journal.done())
        result.save(target, overwrite=True)  # checked before
        journal.close(remove=True)
    except KeyboardInterrupt:
        most = np.prod(study.shape, dtype=np.int64)
        done = f"{journal.count} of {'at most ' * (study.levels > 0)}{most} strokes"
        kept = f"{done} are in {journal_of(target)}; the same command goes on"
        raise KeyboardInterrupt(kept) from None
    finally:
        with suppress(OSError):
            journal.close()
    return result


def check_free_result(target: Path, *, overwrite: bool = False) -> None:
    """Check that a result may be written. Raises OutputError where it may not."""
    if target.suffix != ".npz":
        raise OutputError(f"{target}: name a file that ends in .npz")
    check_target(target)
    check_free(target, replace_any if overwrite else replace_none)


def run_levels(
    study: Study,
    known: Done,
    workers: int | None = None,
    cluster: Any = None,
    progress: Progress | None = None,
) -> None:
    """Compute what is not done, level by level of the refinement."""
    wanted = coarse_points(study.shape, study.refine, study.levels)
    for level in range(study.levels + 1):
        numbers, findings = known.done()
        if level > 0:
            # Not of all that is done: an earlier run may have come to finer levels.
            of_level = np.isin(numbers, wanted)
            kinds = findings["regime"][of_level]
            if study.border == "helmholtz":
                kinds = kinds == HELMHOLTZ
            shape, refine = study.shape, study.refine
            more = finer_points(shape, refine, study.levels, level - 1, numbers[of_level], kinds)
            wanted = np.union1d(wanted, more)
        missing = np.setdiff1d(wanted, numbers, assume_unique=True)
        before = len(wanted) - len(missing)
        total = len(wanted)
        if progress is not None:
            progress(before, total)
        for part, findings in _computed(study, missing, workers, cluster):
            known.add(part, findings)
            before += len(part)
            if progress is not None:
                progress(before, total)


def _computed(
    study: Study, numbers: Array, workers: int | None, cluster: Any
) -> Iterator[tuple[Array, Array]]:
    """Compute points in chunks; yield each chunk as it ends, with its findings."""
    chunks = [numbers[i : i + CHUNK] for i in range(0, len(numbers), CHUNK)]
    if cluster is not None:
        yield from _on_cluster(study, chunks, cluster)
        return
    count = workers or os.cpu_count() or 1
    pool = ThreadPoolExecutor(count)
    try:
        todo, running = iter(chunks), dict[Future[Array], Array]()
        while True:
            while len(running) < 2 * count and (chunk := next(todo, None)) is not None:
                running[pool.submit(findings_of, study, chunk)] = chunk
            if not running:
                return
            ended, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in ended:
                yield running.pop(future), future.result()
    finally:  # an interrupt or a failure: the others need not run
        pool.shutdown(cancel_futures=True)


def findings_of(study: Study, numbers: Array) -> Array:
    """Bow the strokes of some points of a study: findings [dtype=FINDING]."""
    index = np.stack(np.unravel_index(numbers, study.shape), axis=1)
    return find(*study.bow.strokes(study.axes, index))


def _on_cluster(study: Study, chunks: list[Array], cluster: Any) -> Iterator[tuple[Array, Array]]:
    text = study.as_text()
    tasks = [(text, chunk.tobytes()) for chunk in chunks]
    for event in cluster.perform_all(perform, tasks):
        if event.died:
            raise YehuError(f"a chunk of strokes ended its workers: {event.died}")
        if isinstance(event.result, str):
            raise YehuError(event.result)
        yield chunks[event.job], _received(event.result, len(chunks[event.job]))


def _received(found: Any, count: int) -> Array:
    """The findings that a cluster sent, whoever made them. Raises YehuError where they are none."""
    if type(found) is bytes and len(found) == count * FINDING.itemsize:
        findings = np.frombuffer(found, FINDING)
        if findings["regime"].max(initial=0) < len(REGIMES):
            return findings
    raise YehuError("a worker's answer is not a result")


def perform(task: tuple[str, bytes]) -> bytes | str:
    """Bow the strokes of a task of a cluster: their findings as bytes, or what is wrong as text."""
    text, numbers = task
    try:
        findings = findings_of(_study(text), np.frombuffer(numbers, np.int64))
        return bytes(findings.tobytes())
    except YehuError as error:
        return str(error)


def warm_up() -> None:
    """Compile what strokes need, before there are many."""
    study = study_from_text('{"vary": {"force": [0.5]}, "duration": 0.06}')
    findings_of(study, np.zeros(1, np.int64))


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

    Raises ParameterError where the study has more strokes than MAX_FILES, or is refined;
    OutputError where the folder has signals of another sweep and `overwrite` is false.
    """
    if study.levels:
        raise ParameterError("--signals: a study with [refine] keeps no signals")
    count = int(np.prod(study.shape, dtype=np.int64))
    if count > MAX_FILES:
        raise ParameterError(f"--signals: {count} strokes are more than {MAX_FILES}")
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
        raise OutputError(f"{folder}: {error_reason(error)}") from error
