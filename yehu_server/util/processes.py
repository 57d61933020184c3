"""Start helper processes, exchange messages with them, and restart them; a lock for all of them.

PortAudio and a MIDI library may hang or crash when the sound server under them dies. Each runs in a
process of its own and exchanges lines of JSON: orders in, events out. The process ends when its
input does, so none outlives its parent.
"""

import contextlib
import json
import logging
import os
import platform
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import IO, Any

from yehu_server.system.files import open_private
from yehu_server.system.locks import lock, unlock
from yehu_server.system.processes import enlarge_pipe, spawn_options
from yehu_server.util import PACKAGE
from yehu_server.util.retry import Backoff, run_forever

Message = dict[str, Any]

log = logging.getLogger(__name__)

EXIT_S = 1.0  # for a process to end by itself
LOCK_S = 300.0  # for a lock: longer than a slow machine compiles
LOCK_EVERY_S = 0.05  # between two attempts


def python_command(module: str, *arguments: str) -> list[str]:
    """The command that runs a module of this package in another Python, with the same path.

    Not by ``-m``, which first searches all modules in the current folder, where anything may lie.
    """
    path = [*filter(None, sys.path), str(PACKAGE.parent)]
    code = (
        f"import sys; sys.path[:] = {path!r}; import runpy; "
        f"runpy.run_module({module!r}, run_name='__main__', alter_sys=True)"
    )
    return [sys.executable, "-P", "-c", code, *arguments]


class Child:
    """A helper process, seen from its parent.

    Raises OSError, MemoryError or RuntimeError where the system cannot start it.

    `module`: the module to run, as ``python -m``.
    `on_event`: called with each event, in a thread of its own; at the end with ``{"event":
    "gone"}``, however the process ended.
    `share`: file descriptors that the process inherits, under the same numbers.
    """

    def __init__(
        self, module: str, on_event: Callable[[Message], None], share: Sequence[int] = ()
    ) -> None:
        self._name = module.rpartition(".")[2]
        self._on_event = on_event
        self._sending = threading.Lock()
        self._process = subprocess.Popen(  # noqa: S603 - our own module
            python_command(module),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            **spawn_options(share),
        )
        if self._process.stdout is not None:
            with contextlib.suppress(OSError):  # it need not wait while we are stopped
                enlarge_pipe(self._process.stdout)
        events = threading.Thread(target=self._listen, name=f"{self._name} events", daemon=True)
        logger = threading.Thread(target=self._log_stderr, name=f"{self._name} log", daemon=True)
        try:
            logger.start()
            events.start()
        except BaseException:  # nobody would read its output
            self.kill()
            for pipe in (self._process.stdout, self._process.stderr):
                if pipe is not None:
                    pipe.close()
            raise

    @property
    def pid(self) -> int:
        """The number of the process."""
        return self._process.pid

    @property
    def is_alive(self) -> bool:
        """Whether the process runs."""
        return self._process.poll() is None

    def send(self, order: str, **details: Any) -> None:
        """Send an order; without effect where the process has ended."""
        line = json.dumps({"order": order, **details}) + "\n"
        pipe = self._process.stdin
        try:
            with self._sending:
                if pipe is not None:
                    pipe.write(line.encode())
                    pipe.flush()
        except (OSError, ValueError):
            log.debug("%s: gone before it got %s", self._name, order)

    def stop(self) -> None:
        """Let the process end by itself; kill it if it does not."""
        self._close_input()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(EXIT_S)
        self.kill()

    def kill(self) -> None:
        """Kill the process, and wait until it has ended."""
        self._process.kill()
        self._process.wait()
        self._close_input()

    def _close_input(self) -> None:
        pipe = self._process.stdin
        if pipe is not None:
            with self._sending, contextlib.suppress(OSError):
                pipe.close()

    def _listen(self) -> None:
        try:
            for line in self._lines(self._process.stdout):
                try:
                    message = json.loads(line)
                except ValueError:
                    log.debug("%s: %s", self._name, line.rstrip())
                else:
                    self._dispatch(message)
        except (OSError, MemoryError):  # it could not be read any more
            self._process.kill()
        self._process.wait()
        self._close_input()
        self._dispatch({"event": "gone"})

    def _dispatch(self, message: Message) -> None:
        try:
            self._on_event(message)
        except Exception:  # later events still count
            log.exception("%s: could not act on %s", self._name, message)

    def _log_stderr(self) -> None:
        with contextlib.suppress(OSError, MemoryError):
            for line in self._lines(self._process.stderr):
                log.debug("%s: %s", self._name, line.rstrip())

    @staticmethod
    def _lines(pipe: IO[bytes] | None) -> Iterator[str]:
        if pipe is not None:
            with pipe:
                for line in pipe:
                    yield line.decode(errors="replace")


class Parent:
    """The parent, seen from the helper process."""

    def __init__(self) -> None:
        self._channel = os.dup(1)
        os.dup2(2, 1)  # what libraries print is no event
        # On Windows a library that asks about its standard input, as numpy's do when they are
        # loaded, waits until nobody reads that.
        self._orders = os.fdopen(os.dup(0), "rb")
        with Path(os.devnull).open("rb") as nothing:
            os.dup2(nothing.fileno(), 0)
        self._sending = threading.Lock()

    def send(self, event: str, **details: Any) -> None:
        """Send an event; exit where the parent is gone."""
        line = json.dumps({"event": event, **details}) + "\n"
        try:
            with self._sending:
                os.write(self._channel, line.encode())
        except OSError:
            os._exit(0)

    def orders(self) -> Iterator[Message]:
        """Yield the orders as they come, until the input ends."""
        for line in self._orders:
            yield json.loads(line)


SHORTEST_RUN_S = 5.0  # a process that ends sooner is restarted only after a while


class Supervisor:
    """Runs a helper process, again after it ends; a subclass sends orders and handles events.

    `module`: the module to run, as ``python -m``.
    `what`: what the process does, for the thread's name and for messages of errors.
    `on_message`: called with a line where a process cannot be started; from another thread.
    `share`: file descriptors that the process inherits, under the same numbers.
    """

    def __init__(
        self, module: str, what: str, on_message: Callable[[str], None], share: Sequence[int]
    ) -> None:
        self._module = module
        self._share = share
        self._on_message = on_message
        self._ending, self._gone = threading.Event(), threading.Event()
        self._backoff = Backoff()
        turns = (self._serve, self._ending, 0.0, what, on_message)
        self._thread = threading.Thread(target=run_forever, args=turns, name=what, daemon=True)

    def attend(self, child: Child, gone: threading.Event) -> None:
        """Exchange messages with a new process until the event is set, when it is gone."""
        raise NotImplementedError

    def on_event(self, event: Message) -> None:
        """Handle an event, but for the last one; in a thread of its own."""

    def on_exit(self, *, by_itself: bool) -> None:
        """Handle the end of a process, by itself or by `stop`."""

    def start(self) -> None:
        """Start the process."""
        self._thread.start()

    def stop(self) -> None:
        """End the process, for good."""
        self._ending.set()
        self._gone.set()
        if self._thread.is_alive():
            self._thread.join()

    def _serve(self) -> None:
        """Run a process until it ends."""
        gone = self._gone = threading.Event()  # of its own: the last process may set it late
        if self._ending.is_set():  # `stop` set both before
            return
        begun = time.monotonic()
        child = Child(self._module, partial(self._on_child_event, gone), self._share)
        try:
            self.attend(child, gone)
        finally:
            child.stop()
            self.on_exit(by_itself=not self._ending.is_set())
        if time.monotonic() - begun > SHORTEST_RUN_S:
            self._backoff.worked()
        self._ending.wait(self._backoff.failed())

    def _on_child_event(self, gone: threading.Event, event: Message) -> None:
        if event["event"] == "gone":
            gone.set()
        else:
            self.on_event(event)


@contextlib.contextmanager
def machine_lock(folder: Path, name: str, within_s: float = LOCK_S) -> Iterator[None]:
    """Hold a lock of this machine in a folder of the user's, as long as a block lasts.

    So one process compiles, and the others load what it stored. Where the lock cannot be had within
    a time, as when its holder is stopped, the block goes on without it.
    """
    path = folder / f"{name}-{platform.node()}.lock"
    with contextlib.ExitStack() as stack:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            file = open_private(str(path))
            stack.callback(os.close, file)
            if _locked(file, within_s):
                stack.callback(unlock, file)
            else:
                log.warning(
                    "%s: held for %.0f s by another process; not waited for", path, within_s
                )
        except OSError:  # each compiles for itself then
            pass
        yield


def _locked(file: int, within_s: float) -> bool:
    """Lock an open file; whether it could be within a time."""
    end = time.monotonic() + within_s
    while True:
        try:
            lock(file)
        except BlockingIOError:
            if time.monotonic() >= end:
                return False
            time.sleep(LOCK_EVERY_S)
        else:
            return True
