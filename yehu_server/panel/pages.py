"""Plays the wishes of pages, which a process of its own serves; ends the notes of those that go."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from yehu_server.child import Child, Message
from yehu_server.child_keeper import ChildKeeper
from yehu_server.control.addresses import Address
from yehu_server.control.web import listen
from yehu_server.errors import DeviceError, ParameterError
from yehu_server.playing.live import Arrivals, LivePlayer
from yehu_server.playing.visitor import Wish

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
        self.refused = 0  # wishes that nobody can have
        host, port = options.address
        try:
            self._listening = listen(NAME, host, port)
        except DeviceError:
            if options.is_wished:
                raise
            self._listening = listen(NAME, host, 0)
        self.host, self.port = self._listening.getsockname()[:2]
        self._keeper = ChildKeeper(
            "yehu_server.panel.page_process",
            "pages",
            heard=self._heard,
            attend=self._attend,
            ended=self._ended,
            told=changed,
            share=[memory, self._listening.fileno()],
        )

    def start(self) -> None:
        """Start to serve."""
        self._keeper.start()

    def stop(self) -> None:
        """Stop serving, and end the notes of pages."""
        self._keeper.stop()
        self._listening.close()

    def _attend(self, child: Child, gone: threading.Event) -> None:
        """Tell the process what to serve, and the status whenever it is another."""
        allowed = list(self._options.networks)
        listening = self._listening.fileno()
        child.send("serve", memory=self._memory, socket=listening, allowed=allowed)
        told: Mapping[str, Any] = {}
        while not gone.wait(STATUS_S):
            if (status := self._status()) != told:
                child.send("tell", status=status)
                told = status

    def _ended(self, by_itself: bool) -> None:
        for page in list(self._known):
            self._dismiss(page)
        if by_itself:
            self._changed("pages: their process ended; it is started again")

    def _heard(self, event: Message) -> None:
        kind = event["event"]
        if kind == "wishes":
            self._fulfil(event["page"], event["at"], event["wishes"])
        elif kind == "left":
            self._dismiss(event["page"])

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
