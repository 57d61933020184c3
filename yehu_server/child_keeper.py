"""Keeps a helper process running: whenever it ends, it is started again, after a while."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from functools import partial

from yehu_server.child import Child, Message
from yehu_server.lasting import Backoff, keep_on

LIVES_S = 5.0  # a process that ends sooner is started again only after a while


class ChildKeeper:
    """A helper process and its successors.

    Parameters
    ----------
    module : str
        The module to run, as ``python -m``.
    what : str
        What the process does, for the thread's name and for messages of errors.
    heard : callable
        Called with each event but the last, in a thread of its own.
    attend : callable
        Called with each new process and an event that is set when it is gone, until which it
        should not return.
    ended : callable
        Called when the process has ended: True where it did so by itself, not by `stop`.
    told : callable
        Called with a line where a process cannot be started; from another thread.
    share : sequence of int
        File descriptors that the process inherits, under the same numbers.
    """

    def __init__(
        self,
        module: str,
        what: str,
        *,
        heard: Callable[[Message], None],
        attend: Callable[[Child, threading.Event], None],
        ended: Callable[[bool], None],
        told: Callable[[str], None],
        share: Sequence[int] = (),
    ) -> None:
        self._module = module
        self._heard = heard
        self._attend = attend
        self._ended = ended
        self._share = share
        self._ending, self._gone = threading.Event(), threading.Event()
        self._backoff = Backoff()
        turns = (self._serve, self._ending, 0.0, what, told)
        self._thread = threading.Thread(target=keep_on, args=turns, name=what, daemon=True)

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
        gone = self._gone = threading.Event()  # of its own: the last process may tell it late
        if self._ending.is_set():  # `stop` set both before
            return
        begun = time.monotonic()
        child = Child(self._module, partial(self._hear, gone), self._share)
        try:
            self._attend(child, gone)
        finally:
            child.stop()
            self._ended(not self._ending.is_set())
        if time.monotonic() - begun > LIVES_S:
            self._backoff.worked()
        self._ending.wait(self._backoff.failed())

    def _hear(self, gone: threading.Event, event: Message) -> None:
        if event["event"] == "gone":
            gone.set()
        else:
            self._heard(event)
