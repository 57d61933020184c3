"""Keeps the process that serves pages, which posts what they play by itself."""

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from yehu_server.core.midi.section_players import OWN
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.errors import DeviceError
from yehu_server.live import traffic_limits as limits
from yehu_server.live.network import Address
from yehu_server.live.page.guests import Guests
from yehu_server.live.page.players import CHANNELS, FIRST
from yehu_server.live.web.server import listen
from yehu_server.playing.parts import SECTION
from yehu_server.playing.player import Player
from yehu_server.system import sockets
from yehu_server.system.memory import SharedMemory
from yehu_server.util.processes import Child, Supervisor

STATUS_S = 0.5
NAME = "the page"


@dataclass(frozen=True)
class PageOptions:
    """Where pages are served, and to whom."""

    address: Address
    networks: Sequence[str] = ()  # that are answered; without any, all are
    is_required: bool = False  # whether the port has to be this one; else a free one may do
    guests: Guests | None = None  # on other machines; None: they may do all, without a PIN


class Pages(Supervisor):
    """A port for pages, and the process that serves them.

    Raises DeviceError where the address is in use or not this machine's.

    `players`: the player of each part.
    `memory`: the memory that has the instruments.
    `status`: what pages are sent of the server, of JSON's types; any thread may call.
    `on_message`: called with a line when the process had to be started again; from another thread.
    `rigs`: the instrument that shows each part.
    """

    def __init__(
        self,
        players: Sequence[Player],
        options: PageOptions,
        memory: SharedMemory,
        status: Callable[[], Mapping[str, Any]],
        on_message: Callable[[str], None],
        rigs: Sequence[int],
    ) -> None:
        self._players = tuple(players)
        self._rigs = rigs
        self._options = options
        self._memory = memory
        self._status = status
        host, port = options.address
        try:
            self._listening = listen(NAME, host, port)
        except DeviceError:
            if options.is_required:
                raise
            self._listening = listen(NAME, host, 0)
        self.host, self.port = self._listening.getsockname()[:2]
        share = [*memory.inherited, *sockets.inherited(self._listening)]
        super().__init__("yehu_server.live.page.process", "pages", on_message, share)

    def stop(self) -> None:
        """Stop serving, and end the notes of pages."""
        super().stop()
        self._listening.close()

    def attend(self, child: Child, gone: threading.Event) -> None:
        """Send the process what to serve, and the status whenever it is another."""
        allowed = list(self._options.networks)
        guests = self._options.guests
        child.send(
            "serve",
            memory=self._memory.handle,
            rigs=self._rigs,
            socket=sockets.share(self._listening, child.pid),
            allowed=allowed,
            guests=None if guests is None else asdict(guests),
            open_notes=self._players[0].notes.open_notes,
            reaches=self._players[0].notes.reaches,
        )
        sent: Any = None
        while not gone.wait(STATUS_S):
            if (state := (self._status(), self._own())) != sent:
                child.send("state", status=state[0], own=state[1])
                sent = state

    def _own(self) -> list[list[tuple[int, float]]]:
        """Of each part that is a section, the values that each of its players has of its own."""
        return [
            [(INDEX[address], player.value(address)) for address in OWN]
            if player.value(SECTION) > 1
            else []
            for player in self._players
        ]

    def on_exit(self, *, by_itself: bool) -> None:
        """End what the pages held, whose process is gone."""
        for player in self._players:
            player.end_channel_notes(FIRST, limits.WEB_SOCKETS * CHANNELS, frame=player.frame_of())
        if by_itself:
            self._on_message("pages: their process ended; it is started again")
