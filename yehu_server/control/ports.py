"""Play from MIDI inputs as they are connected; end the notes of those that disappear."""

from __future__ import annotations

import contextlib
import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import mido

from yehu_server.child import Child, Message
from yehu_server.child_keeper import ChildKeeper
from yehu_server.control.midi_routes import Route, Router
from yehu_server.playing.live import Arrivals, LivePlayer

log = logging.getLogger(__name__)


@dataclass
class MidiOptions:
    """The MIDI inputs to open; see ``yehu-server serve --help``."""

    patterns: Sequence[str] = ()  # empty: all but through ports
    virtual: str | None = None
    api: str | None = None  # None: the first there is
    routes: Sequence[Route] = ()  # see midi_routes.Router


class MidiPorts:
    """Passes MIDI messages from the process that holds the inputs to the players of all parts.

    Parameters
    ----------
    changed : callable
        Called with a line when a port or the MIDI system appears or disappears; from another
        thread.
    """

    def __init__(
        self,
        players: Sequence[LivePlayer],
        options: MidiOptions,
        changed: Callable[[str], None],
    ) -> None:
        self._players = players
        self._router = Router(options.routes, len(players))
        self._arrivals = Arrivals(players[0])
        self._options = options
        self._changed = changed
        self._numbers: dict[str, int] = {}  # a port that comes back gets its old one
        self._connected: dict[str, None] = {}
        self._keeper = ChildKeeper(  # it ends as JACK's server does
            "yehu_server.control.midi_process",
            "MIDI inputs",
            heard=self._heard,
            attend=self._attend,
            ended=self._ended,
            told=changed,
        )
        self._missing: set[str] = set()  # patterns reported as matching nothing
        self.received = 0
        self.malformed = 0
        self.problem = ""

    @property
    def connected(self) -> list[str]:
        """Names of the open ports."""
        return list(self._connected)

    def start(self) -> None:
        """Start to receive."""
        self._keeper.start()

    def stop(self) -> None:
        """Stop receiving."""
        self._keeper.stop()

    def _attend(self, child: Child, gone: threading.Event) -> None:
        options, routed = self._options, self._router.patterns
        child.send(
            "open",
            patterns=[*options.patterns, *routed],
            others=not options.patterns and self._router.wants_others,
            virtual=options.virtual,
            api=options.api,
        )
        gone.wait()

    def _ended(self, by_itself: bool) -> None:
        if by_itself:
            self._let_go()

    def _heard(self, event: Message) -> None:
        kind = event["event"]
        if kind == "midi":
            self._receive(event)
        elif kind == "appeared":
            self._connected[event["port"]] = None
            self._changed(f"MIDI: {event['port']} is connected{self._whose(event['port'])}")
        elif kind in ("vanished", "silent"):
            self._let_go_of(event["port"])
            if kind == "vanished":
                self._connected.pop(event["port"], None)
                self._changed(f"MIDI: {event['port']} is gone; its notes are ended")
            else:
                log.info("MIDI: %s fell silent (active sensing)", event["port"])
        elif kind == "missing":
            self._tell_missing(event["pattern"], event["present"])
        elif kind == "refused":
            self._changed(f"MIDI: {event['port']} cannot be opened: {event['reason']}")
        elif kind == "none":
            self.problem = event["reason"]
            self._changed(f"MIDI: none ({event['reason']}); looking again now and then")
        elif kind == "system":
            self.problem = ""
            log.info("MIDI: through %s", event["api"])

    def _whose(self, port: str) -> str:
        """What a port plays, where there are several parts."""
        if len(self._players) == 1:
            return ""
        parts = [str(part + 1) for part in self._router.parts_of(port)]
        if not parts:
            return ", and plays no part"
        return f" to part {parts[0]}" if len(parts) == 1 else f" to parts {', '.join(parts)}"

    def _tell_missing(self, pattern: str, present: Sequence[str]) -> None:
        if pattern not in self._missing:  # once, however often the process starts
            self._missing.add(pattern)
            there = ", ".join(present) or "none"
            self._changed(f"MIDI: no input matches {pattern!r} yet (there are: {there})")

    def _receive(self, event: Message) -> None:
        self.received += 1
        try:
            message = mido.Message.from_bytes(event["bytes"])
        except (ValueError, IndexError):
            self.malformed += 1
            return
        number = self._numbers.setdefault(event["port"], len(self._numbers))
        frame = self._arrivals.frame_of(event["at"])
        for part in self._router.parts_of(event["port"], getattr(message, "channel", None)):
            self._players[part].receive(message, frame=frame, port=number)

    def _let_go_of(self, port: str) -> None:
        with contextlib.suppress(KeyError):
            for part in self._router.parts_of(port):
                player = self._players[part]
                player.let_go_of(self._numbers[port], frame=player.frame_of())

    def _let_go(self) -> None:
        """End the notes of all ports."""
        for port in self._connected:
            self._let_go_of(port)
        if self._connected:
            self._changed(f"MIDI: {', '.join(self._connected)} gone; notes are ended")
        self._connected.clear()
