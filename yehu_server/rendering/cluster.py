"""Do jobs on a cluster by Dask (docs/cluster.md), with the same results; also if workers die."""

import contextlib
import itertools
import logging
import pickle
import queue
import re
import secrets
import time
import warnings
from collections.abc import Callable, Generator, Iterable, Iterator
from pathlib import Path
from typing import Any, Self

from yehu_server.compile import levels
from yehu_server.errors import YehuError
from yehu_server.rendering import cluster_worker
from yehu_server.rendering.plain_unpickling import ForeignError, plain_client
from yehu_server.rendering.workers import Event, Perform
from yehu_server.util.documents import Document
from yehu_server.util.hints import require_package
from yehu_server.util.values import line

PORT = 8786  # Dask's own choice
_ADDRESS = re.compile(
    r"(?:(tcp|tls|ucx|ws|wss)://)?(\[[0-9a-fA-F:.]+\]|[^\s:/\[\]]+)(?::([0-9]{1,5}))?/?"
)
CONNECT_S = 10.0
CHECK_EVERY_S = 2.0  # at how many workers there are
JOBS_PER_THREAD = 4  # in flight, so that no worker waits for the next
MIN_JOBS = 16
BATCHES = 4  # in which they are sent off


def scheduler_address(text: str) -> str:
    """Complete HOST, HOST:PORT, tls://HOST:PORT or a scheduler's file, or raise YehuError."""
    if text.endswith(".json"):
        return _in_file(Path(text))
    found = _ADDRESS.fullmatch(text)
    if found is None or not 0 < int(found[3] or PORT) < 65536:
        raise YehuError(
            f"{text!r} is not the address of a scheduler, such as tcp://10.0.0.1:{PORT}"
        )
    return f"{found[1] or 'tcp'}://{found[2]}:{found[3] or PORT}"


def _in_file(path: Path) -> str:
    """The address in the file that ``dask scheduler --scheduler-file`` writes."""
    document = Document(path, "the file of a Dask scheduler", YehuError).read(path)
    return scheduler_address(document.json().need("address", line).removesuffix(".json"))


class Cluster:
    """A connection to a Dask scheduler, for the time of a `with` block.

    The address is that of the scheduler, such as ``tcp://10.0.0.1:8786``, or its file. `setup`,
    which has to be picklable, is called in each process of a worker before its first job, by one
    process of a machine at a time. `warn` is called with a line about what is no error. Raises
    YehuError where there is no such scheduler, no worker, or one that has another version; where
    Dask is not installed.
    """

    def __init__(
        self,
        address: str,
        setup: Callable[[], object] | None = None,
        warn: Callable[[str], None] = lambda _line: None,
    ) -> None:
        require_package("distributed", "--dask", "cluster")
        self.address = scheduler_address(address)
        self._setup, self._warn = pickle.dumps(setup or cluster_worker.no_setup), warn
        self._client: Any = None
        self._open = contextlib.ExitStack()
        self._code = cluster_worker.identity().code

    def __enter__(self) -> Self:
        for name in ("distributed", "tornado.application", "asyncio"):
            logging.getLogger(name).setLevel(logging.CRITICAL)  # what matters is one line of ours
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of versions: `_check` reports what matters
                self._client = self._open.enter_context(plain_client(self.address, CONNECT_S))
        except (OSError, ValueError, TypeError, ImportError, TimeoutError) as error:
            raise YehuError(f"{self.address}: no Dask scheduler answers there") from error
        try:
            self._check()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()

    def perform_all(self, perform: Perform, tasks: Iterable[Any]) -> Generator[Event]:
        """Do all tasks; yield what becomes of them, in the order in which they end.

        As of ``rendering.workers.perform_all``. Results are plain values:
        None, numbers, texts, bytes, and lists and dicts of them. Whoever takes one checks it:
        anybody who reaches the scheduler may have sent it. Raises YehuError where the scheduler is
        lost, or a worker has another version.
        """
        name = f"yehu-{secrets.token_hex(8)}"
        waiting = enumerate(tasks)
        ended: queue.SimpleQueue[Any] = queue.SimpleQueue()
        jobs: dict[str, int] = {}
        futures: dict[str, Any] = {}
        room, checked = 0, -CHECK_EVERY_S
        is_warned = False
        try:
            while True:
                if time.monotonic() - checked >= CHECK_EVERY_S:
                    threads = self._reached(self._client.nthreads)
                    room = max(MIN_JOBS, JOBS_PER_THREAD * len(threads))
                    checked = time.monotonic()
                    if not threads and not is_warned:
                        self._warn(f"{self.address}: no worker is left; waiting for one")
                    is_warned = not threads
                free = room - len(futures)
                if free >= room // BATCHES:
                    for job, future in self._begin(name, perform, itertools.islice(waiting, free)):
                        jobs[future.key], futures[future.key] = job, future
                        future.add_done_callback(ended.put)
                if not futures:
                    return
                for future, result in self._results(ended):
                    job = jobs.pop(future.key)
                    del futures[future.key]
                    yield self._event(future, job, result)
        finally:
            with contextlib.suppress(Exception):
                self._client.cancel(list(futures.values()), force=True)

    def _begin(
        self, name: str, perform: Perform, numbered: Iterable[tuple[int, Any]]
    ) -> list[tuple[int, Any]]:
        """Send some jobs off at once, as cheap as one; return their numbers and futures."""
        jobs = dict(numbered)
        packs = [pickle.dumps((perform, task, self._setup)) for task in jobs.values()]
        if not jobs:
            return []
        keys = [f"{name}-{job}" for job in jobs]
        more = {"code": self._code, "key": keys, "pure": False, "retries": 0}
        futures = self._reached(self._client.map, cluster_worker.do, packs, **more)
        return list(zip(jobs, futures, strict=True))

    def _results(self, ended: queue.SimpleQueue[Any]) -> Iterator[tuple[Any, Any]]:
        """Wait for a moment; return the futures that have ended, and their results."""
        futures = []
        with contextlib.suppress(queue.Empty):
            futures.append(ended.get(timeout=CHECK_EVERY_S))
            while True:
                futures.append(ended.get_nowait())
        done = [future for future in futures if future.status == "finished"]
        keys = {future.key for future in done}
        results = iter(self._reached(self._client.gather, done, errors="skip") if done else ())
        if self._client.status == "closed" or any(
            future.status in ("cancelled", "lost") for future in futures
        ):
            raise YehuError(f"{self.address}: the scheduler is lost")
        return ((future, next(results) if future.key in keys else None) for future in futures)

    def _event(self, future: Any, job: int, result: Any) -> Event:
        if future.status == "finished":
            kind, value = _unpacked(result)
            if kind == cluster_worker.UNLIKE:
                other = cluster_worker.identity_of(value)
                raise YehuError(self._unlike("a worker that came later", other))
            if kind == cluster_worker.FAILED:
                return Event(job, died=f"ended by {value}")
            return Event(job, result=value)
        error = future.exception()
        known: tuple[Any, ...] = getattr(error, "args", ())
        is_killed = type(error).__name__ == "KilledWorker" and len(known) == 3
        if is_killed and isinstance(known[2], int):
            return Event(job, died=f"killed on {known[2] + 1} workers")
        return Event(job, died=f"ended by {type(error).__name__}: {error}")

    def _check(self) -> None:
        """Check that there are workers, and that all are like this process."""
        deadline = time.monotonic() + CONNECT_S
        while not self._reached(self._client.nthreads):
            if time.monotonic() > deadline:
                raise YehuError(f"{self.address}: the scheduler has no workers")
            time.sleep(0.2)
        try:
            self._client.run_on_scheduler(cluster_worker.no_setup)
            answers = self._client.run(cluster_worker.who)
        except ForeignError as error:
            if type(error).__name__ in ("ImportError", "ModuleNotFoundError"):
                raise YehuError(
                    f"{self.address}: yehu-server is not installed there ({error})"
                ) from error
            # It is so old that it lacks the question.
            raise YehuError(f"{self.address}: has another version of yehu-server") from error
        own = cluster_worker.identity()
        found = {worker: cluster_worker.identity_of(answers[worker]) for worker in answers}
        for worker, other in sorted(found.items()):
            if other.code != own.code:
                raise YehuError(self._unlike(worker, other))
        others = {other.level for other in found.values()} - {own.level}
        if others:
            names = ", ".join(sorted(others))
            self._warn(
                f"{self.address}: workers have other levels of processors ({names}; here "
                f"{own.level}): samples differ. {levels.VARIABLE}={levels.lowest()} on all "
                "makes them equal"
            )

    def _unlike(self, worker: str, other: cluster_worker.Identity) -> str:
        return (
            f"{worker} has {other.shown}, and here is {cluster_worker.identity().shown}: "
            "install the same version"
        )

    def _reached(self, call: Callable[..., Any], *arguments: Any, **named: Any) -> Any:
        """Call something of the client; where that fails, the scheduler is lost."""
        from distributed import CancelledError

        try:
            return call(*arguments, **named)
        except (OSError, TimeoutError, CancelledError, RuntimeError) as error:
            raise YehuError(f"{self.address}: the scheduler is lost") from error


def _unpacked(result: Any) -> tuple[Any, Any]:
    """What `cluster_worker.do` packed; a failure where it is anything else."""
    import msgpack

    try:
        kind, value = msgpack.unpackb(result)
    except Exception:  # noqa: BLE001 - its errors have no common base
        return cluster_worker.FAILED, "an answer that is none"
    return kind, value
