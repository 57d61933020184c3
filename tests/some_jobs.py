"""Jobs for tests of processes: functions that another process can find by their name."""

import os
import signal
import time
from pathlib import Path


def double(task):
    return 2 * task


def fall(task):
    """Die at -1; at a path, die at the first time only."""
    if task == -1:
        os.kill(os.getpid(), signal.SIGKILL)
    if isinstance(task, Path) and not task.exists():
        task.touch()
        os._exit(3)
    return os.getpid()


def hold(task):
    """Hold a file as long as it is not interrupted."""
    try:
        task.touch()
        time.sleep(600.0)
    finally:
        task.unlink()


def slow(task):
    """Take some seconds; tell who did."""
    time.sleep(task)
    return os.getpid()


class SetUp:
    """Writes when it began and ended, to a file of each process."""

    def __init__(self, folder):
        self.folder = folder

    def __call__(self):
        began = time.monotonic()
        time.sleep(0.3)
        with (self.folder / f"set-up-{os.getpid()}").open("a") as file:
            file.write(f"{began} {time.monotonic()}\n")


def poison(touched):
    """Make a worker answer with an object that touches a file where it is unpickled."""
    from yehu_server.rendering import cluster_worker

    cluster_worker.do = lambda *_, **__: Touching(touched)


class Touching:
    """Touches a file where it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)
