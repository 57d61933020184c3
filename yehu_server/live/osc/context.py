"""What the OSC calls of a part share: its player, its addresses, the server's services."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

from yehu_server.errors import OutputError, YehuError
from yehu_server.live.osc.answering import Peer
from yehu_server.live.osc.clients import Clients
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.request import Request
from yehu_server.params.table import PREFIX
from yehu_server.playing.live_player import LivePlayer
from yehu_server.playing.mapping import Mapping as ControllerMapping
from yehu_server.util.token_bucket import TokenBucket

SAVES_A_SECOND, SAVES_AT_ONCE = 1.0, 10.0  # of all clients together: each writes a file

Act = Callable[[Request], None]


class ServerServices(Protocol):
    """The services of the server that OSC calls need beside the player."""

    def status(self) -> Mapping[str, float | str]:
        """The status values, by name."""

    def part_status(self, part: int) -> Mapping[str, float]:
        """The status values of a part, counted from 0, by name."""

    def start_recording(self, name: str) -> str:
        """Record to a file of a plain name; return the file's name. Raises YehuError."""

    def stop_recording(self) -> str:
        """End the recording; return the file's name. Raises YehuError."""

    def call_soon(self, action: Callable[[], None]) -> None:
        """Call a function in the thread that handles packets; any thread may call."""

    def run_in_background(self, action: Callable[[], None]) -> None:
        """Call a function that may take long, such as one that writes a file, in another thread.

        Those that are given one after another are called in this order.
        """

    def tree_changed(self, path: str) -> None:
        """Announce that the tree of addresses has changed at a path or below."""

    def log(self, line: str) -> None:
        """Print or log a line for whoever runs the server."""


@dataclass(frozen=True)
class CallContext:
    """What the calls of all parts share."""

    clients: Clients
    services: ServerServices
    send_error: Callable[[Peer, str, str], None]  # to a peer, with the address it sent to
    drop_scheduled: Callable[[str], None]  # the messages of a group that wait for their time
    tree_changed: Callable[[str], None]  # announces a change of the tree, below each group
    remap: Callable[[LivePlayer, ControllerMapping], None]  # a player and its like
    writes: set[object] = field(default_factory=set)  # a mark for each file that is being written
    saves: TokenBucket = field(default_factory=lambda: TokenBucket(SAVES_A_SECOND, SAVES_AT_ONCE))


class PlayerCalls:
    """Calls of a player at a group of addresses.

    Attributes
    ----------
    by_address : dict
        What carries out each address after the group; each raises YehuError where it refuses.
    """

    def __init__(self, player: LivePlayer, addressed: str, context: CallContext) -> None:
        self._player = player
        self._addressed = addressed
        self._prefix = PREFIX + addressed
        self._context = context
        self._clients, self._services = context.clients, context.services
        self.by_address: dict[str, Act] = {}

    def _check_rate(self) -> None:
        """Refuse what writes a file where that is done too often."""
        if not self._context.saves.takes(time.monotonic()):
            raise OutputError("files are written too often; try again in a second")

    def _write(self, peer: Peer, address: str, write: Callable[[], Callable[[], None]]) -> None:
        """Write a file aside, as a disk may be slow; then call what `write` returns."""
        mark = object()

        def aside() -> None:
            try:
                then = write()
            except YehuError as error:
                then = partial(self._send_error, peer, address, str(error))
            self._services.call_soon(partial(end, then))

        def end(then: Callable[[], None]) -> None:
            self._context.writes.discard(mark)
            try:
                then()
            except YehuError as error:
                self._send_error(peer, address, str(error))

        self._context.writes.add(mark)
        self._services.run_in_background(aside)

    def _after_writes(self, call: Request, address: str, act: Act) -> None:
        """Do what reads files: after those that are being written, where there are any."""
        if self._context.writes:
            self._write(call.peer, address, lambda: partial(act, call))
        else:
            act(call)

    def _send(self, peer: Peer, address: str, *arguments: float | str) -> None:
        """Send a peer an answer of the group."""
        peer.send(pack(self._prefix + address, *arguments))

    def _send_error(self, peer: Peer, address: str, reason: str) -> None:
        """Tell a peer why a call of the group was refused."""
        self._context.send_error(peer, self._prefix + address, reason)
