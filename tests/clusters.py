"""A Dask cluster on this machine, for tests: a scheduler and workers, processes of their own."""

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import forks
import pytest
from waiting import LONG_S, until

TESTS = Path(__file__).resolve().parent
PYTHONPATH = f"{TESTS}:{TESTS.parent}"
WORKER = (
    f"import sys; sys.path[:0] = {PYTHONPATH.split(':')};"
    "from distributed.cli.dask_worker import main; main()"
)
HERE = ("--host", "127.0.0.1", "--no-dashboard")

needs_distributed = pytest.mark.skipif(find_spec("distributed") is None, reason="no distributed")


class Processes:
    """A scheduler and its workers, each of one thread, without anybody who starts them again."""

    def __init__(self, folder: Path, **environment: str) -> None:
        self.file = folder / "scheduler.json"
        self.log = folder / "log"
        self.environment = {**os.environ, "PYTHONPATH": PYTHONPATH, **environment}
        self.scheduler = self._start("dask_scheduler", "--port", "0", "--scheduler-file", self.file)
        until(
            lambda: self.file.exists() and self.file.read_text().endswith("}"),
            "a scheduler",
            LONG_S,
        )
        self.workers: list[subprocess.Popen] = []

    def add_worker(self, **environment: str) -> subprocess.Popen:
        self.environment |= environment
        words = ("--scheduler-file", self.file, "--nthreads", "1", "--no-nanny")
        self.workers.append(self._start("dask_worker", *words))
        return self.workers[-1]

    def _start(self, what: str, *words: object) -> subprocess.Popen:
        with self.log.open("a") as log:
            how = {"env": self.environment, "stdout": log, "stderr": log, "cwd": self.file.parent}
            if what == "dask_worker" and self.environment["PYTHONPATH"] == PYTHONPATH:
                return forks.start(*words, *HERE, code=WORKER, **how)
            # The scheduler loads little, and a worker with other code must not have ours.
            command = [sys.executable, "-m", f"distributed.cli.{what}", *map(str, words), *HERE]
            return subprocess.Popen(command, **how)

    def end(self) -> None:
        for process in (*self.workers, self.scheduler):
            process.send_signal(signal.SIGKILL)
            process.wait()


@contextlib.contextmanager
def cluster_in(folder: Path, workers: int = 2, **environment: str) -> Iterator[Processes]:
    """A cluster with its files in a folder, for the time of a block."""
    processes = Processes(folder, **environment)
    try:
        for _ in range(workers):
            processes.add_worker()
        yield processes
    finally:
        processes.end()
