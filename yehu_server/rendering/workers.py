"""Do jobs on several processes; one that dies takes none of the others with it.

Processes begin anew (spawn). Each ends when its parent does, however that ends, and puts away what
it was making.
"""

import contextlib
import multiprocessing
import os
import queue
import signal
import threading
from collections import deque
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any

from yehu_server.errors import YehuError
from yehu_server.system.processes import on_termination, terminate_main_thread
from yehu_server.util.files import error_reason

Perform = Callable[[Any], Any]
MAX_TRIES = 2  # of a job whose process dies
EXIT_WAIT_S = 10.0


@dataclass(frozen=True)
class Event:
    """What became of a job that is over: its result, or why its processes died."""

    job: int  # the number of its task, from 0
    result: Any = None  # what was returned
    died: str = ""  # how its process ended, such as "killed by signal 9"


class _Worker:
    """A process, seen from its parent."""

    def __init__(self, context: Any, perform: Perform) -> None:
        self.job = -1
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, perform), daemon=True)
        try:
            self.process.start()
        except OSError as error:
            raise YehuError(f"a process cannot be started: {error_reason(error)}") from error
        finally:
            theirs.close()

    def begin(self, job: int, task: Any) -> None:
        self.job = job
        with contextlib.suppress(OSError):  # it died: that is found when we listen
            self.connection.send(task)

    def end(self) -> str:
        """Wait until it has ended; return how it did."""
        self.process.join(EXIT_WAIT_S)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()
        code = self.process.exitcode or 0
        return f"killed by signal {-code}" if code < 0 else f"ended with code {code}"


def perform_all(perform: Perform, tasks: Sequence[Any], workers: int) -> Generator[Event]:
    """Do all tasks; yield what becomes of them, as it does.

    `perform` is a function of a module, called in another process with a task. Its result, and
    tasks, have to be picklable; it must not raise. At most `workers` processes run.
    Raises YehuError where no process can be started.
    """
    context = multiprocessing.get_context("spawn")
    waiting = deque((job, 1) for job in range(len(tasks)))
    tries: dict[int, int] = {}
    pool: list[_Worker] = []
    try:
        while waiting or any(worker.job >= 0 for worker in pool):
            for worker in pool:
                if worker.job < 0 and waiting:
                    job, tries[job] = waiting.popleft()
                    worker.begin(job, tasks[job])
            while waiting and len(pool) < workers:
                pool.append(_Worker(context, perform))
                job, tries[job] = waiting.popleft()
                pool[-1].begin(job, tasks[job])
            ready = wait([worker.connection for worker in pool])
            for worker in [each for each in pool if each.connection in ready]:
                job = worker.job
                try:
                    result = worker.connection.recv()
                except (EOFError, OSError):
                    pool.remove(worker)
                    worker.connection.close()
                    how = worker.end()
                    if job < 0:
                        continue
                    if tries[job] < MAX_TRIES:
                        waiting.appendleft((job, tries[job] + 1))
                    else:
                        yield Event(job, died=how)
                    continue
                worker.job = -1
                yield Event(job, result)
    finally:
        for worker in pool:
            worker.connection.close()
        for worker in pool:
            worker.end()


def _serve(connection: Connection, perform: Perform) -> None:
    """Do tasks as they come, until the parent hangs up."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent
    on_termination(_interrupt)
    tasks: queue.SimpleQueue[Any] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(connection, tasks), daemon=True).start()
    try:
        while (task := tasks.get()) is not None:
            connection.send(perform(task[0]))
    except (KeyboardInterrupt, OSError):  # what was being made has been put away
        os._exit(0)


def _listen(connection: Connection, tasks: queue.SimpleQueue[Any]) -> None:
    try:
        while True:
            tasks.put((connection.recv(),))
    except (EOFError, OSError):
        tasks.put(None)
        terminate_main_thread()


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt
