"""Plays the wishes of pages, which a process of its own serves; ends the notes of those that go."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from yehu_server.child import Child, Message
from yehu_server.control.addresses import Address
from yehu_server.control.web import listen
from yehu_server.errors import DeviceError, ParameterError
from yehu_server.lasting import Backoff, keep_on
from yehu_server.playing.live import Arrivals, LivePlayer
from yehu_server.playing.visitor import Wish

log = logging.getLogger(__name__)

LIVES_S = 5.0  # a process that ends sooner is started again only after a while
STATUS_S = 0.5
AHEAD_S = 3.0  # by which a wish may lie ahead
NAME = "the page"


@dataclass(frozen=True)
class PageOptions:
    """Where pages are served, and to whom."""

    address: Address
    networks: Sequence[str] = ()  # that are answered; without any, all are
    is_wished: bool = False  # whether the port has to be this one; else a free one may do


class Pages:
    """A port for pages, and the process that serves them.

    Parameters
    ----------
    memory : int
        File descriptor of the memory that has the instrument.
    status : callable
        What pages are told of the server, of JSON's types; any thread may call.
    changed : callable
        Called with a line when the process had to be started again; from another thread.

    Raises
    ------
    DeviceError
        Where the address is in use or not this machine's.
    """

    def __init__(
        self,
        player: LivePlayer,
        options: PageOptions,
        memory: int,
        status: Callable[[], Mapping[str, Any]],
        changed: Callable[[str], None],
    ) -> None:
        self._player = player
        self._options = options
        self._memory = memory
        self._status = status
        self._changed = changed
        self._arrivals = Arrivals(player)
        self._known: set[int] = set()  # numbers of pages that wished something
        self._ending, self._gone = threading.Event(), threading.Event()
        self._backoff = Backoff()
        self._thread = threading.Thread(target=self._supervise, name="pages", daemon=True)
        self.refused = 0  # wishes that nobody can have
        host, port = options.address
        try:
            self._listening = listen(NAME, host, port)
        except DeviceError:
            if options.is_wished:
                raise
            self._listening = listen(NAME, host, 0)
        self.host, self.port = self._listening.getsockname()[:2]

    def start(self) -> None:
        """Start to serve."""
        self._thread.start()

    def stop(self) -> None:
        """Stop serving, and end the notes of pages."""
        self._ending.set()
        self._gone.set()
        if self._thread.is_alive():
            self._thread.join()
        self._listening.close()

    def _supervise(self) -> None:
        keep_on(self._serve, self._ending, 0.0, "pages", self._changed)

    def _serve(self) -> None:
        """Run a process that serves pages, until it ends."""
        self._gone.clear()
        if self._ending.is_set():  # `stop` set both before `_gone` was cleared
            return
        begun = time.monotonic()
        share = [self._memory, self._listening.fileno()]
        child = Child("yehu_server.panel.page_process", self._heard, share)
        try:
            allowed = list(self._options.networks)
            child.send("serve", memory=share[0], socket=share[1], allowed=allowed)
            told: Mapping[str, Any] = {}
            while not self._gone.wait(STATUS_S):
                if (status := self._status()) != told:
                    child.send("tell", status=status)
                    told = status
        finally:
            child.stop()
            self._dismiss_all()
        if self._ending.is_set():
            return
        self._changed("pages: their process ended; it is started again")
        if time.monotonic() - begun > LIVES_S:
            self._backoff.worked()
        self._ending.wait(self._backoff.failed())

    def _heard(self, event: Message) -> None:
        kind = event["event"]
        if kind == "wishes":
            self._fulfil(event["page"], event["at"], event["wishes"])
        elif kind == "left":
            self._dismiss(event["page"])
        elif kind == "gone":
            self._gone.set()

    def _fulfil(self, page: int, arrived_ns: int, wishes: Sequence[Sequence[float]]) -> None:
        self._known.add(page)
        now = self._arrivals.frame_of(arrived_ns)
        latest = now + round(AHEAD_S * self._player.instrument.rate)
        for frame, kind, index, value, other in wishes:
            try:
                wish = Wish(int(kind), int(index), value, other)
                self._player.fulfil(page, wish, frame=min(max(int(frame), now), latest))
            except ParameterError:
                self.refused += 1

    def _dismiss(self, page: int) -> None:
        self._known.discard(page)
        self._player.dismiss(page, frame=self._player.frame_of())

    def _dismiss_all(self) -> None:
        for page in list(self._known):
            self._dismiss(page)
