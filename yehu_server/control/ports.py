"""MIDI inputs, live: what comes in is played, what goes away is silenced."""

from __future__ import annotations

import contextlib
import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import mido

from yehu_server.child import Child, Message
from yehu_server.playing.live import Arrivals, LivePlayer

log = logging.getLogger(__name__)

AGAIN_AFTER_S = 0.5


@dataclass
class MidiOptions:
    """Which inputs; see ``yehu-server serve --help``."""

    patterns: Sequence[str] = ()  # none: all but through ports
    virtual: str | None = None
    api: str | None = None  # None: the first that is there


class MidiPorts:
    """Passes on what the inputs' process hears.

    Parameters
    ----------
    changed : callable
        Told in a line when a port or the MIDI system comes or goes; from another thread.
    """

    def __init__(
        self, player: LivePlayer, options: MidiOptions, changed: Callable[[str], None]
    ) -> None:
        self._player = player
        self._arrivals = Arrivals(player)
        self._options = options
        self._changed = changed
        self._numbers: dict[str, int] = {}  # a port keeps its number when it comes back
        self._connected: dict[str, None] = {}
        self._ending = threading.Event()
        self._child: Child | None = None
        self.received = 0
        self.malformed = 0
        self.problem = ""

    @property
    def connected(self) -> list[str]:
        """The names of the open ports."""
        return list(self._connected)

    def start(self) -> None:
        """Begin to listen."""
        options = self._options
        self._child = Child("yehu_server.control.midi_process", self._heard)
        self._child.send(
            "open", patterns=list(options.patterns), virtual=options.virtual, api=options.api
        )

    def stop(self) -> None:
        """Stop listening."""
        self._ending.set()
        if self._child is not None:
            self._child.stop()

    def _heard(self, event: Message) -> None:
        kind = event["event"]
        if kind == "midi":
            self._receive(event)
        elif kind == "appeared":
            self._connected[event["port"]] = None
            self._changed(f"MIDI: {event['port']} is connected")
        elif kind in ("vanished", "silent"):
            self._let_go_of(event["port"])
            if kind == "vanished":
                self._connected.pop(event["port"], None)
                self._changed(f"MIDI: {event['port']} is gone; its notes are ended")
            else:
                log.info("MIDI: %s fell silent (active sensing)", event["port"])
        elif kind == "refused":
            self._changed(f"MIDI: {event['port']} cannot be opened: {event['reason']}")
        elif kind == "none":
            self.problem = event["reason"]
            self._changed(f"MIDI: none ({event['reason']}); looking again now and then")
        elif kind == "system":
            self.problem = ""
            log.info("MIDI: through %s", event["api"])
        elif kind == "gone" and not self._ending.is_set():
            self._replace()

    def _receive(self, event: Message) -> None:
        self.received += 1
        try:
            message = mido.Message.from_bytes(event["bytes"])
        except (ValueError, IndexError):
            self.malformed += 1
            return
        number = self._numbers.setdefault(event["port"], len(self._numbers))
        self._player.receive(message, frame=self._arrivals.frame_of(event["at"]), port=number)

    def _let_go_of(self, port: str) -> None:
        with contextlib.suppress(KeyError):
            self._player.let_go_of(self._numbers[port], frame=self._player.frame_of())

    def _replace(self) -> None:
        """Begin anew after the process ended, as it does with JACK's server."""
        for port in self._connected:
            self._let_go_of(port)
        if self._connected:
            self._changed(f"MIDI: {', '.join(self._connected)} gone; notes are ended")
        self._connected.clear()
        if not self._ending.wait(AGAIN_AFTER_S):
            self.start()
