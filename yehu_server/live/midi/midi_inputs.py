"""Play from MIDI inputs as they are connected; report those that come and go."""

import contextlib
import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass

import mido

from yehu_server.core.engine.mailbox import MIDI_INPUTS
from yehu_server.core.engine.rig import ring_place
from yehu_server.core.midi.events import DISCONNECT, MESSAGE
from yehu_server.live.midi.routes import Route, Router
from yehu_server.playing.player import Player
from yehu_server.system.memory import SharedMemory
from yehu_server.util.processes import Child, Message, Supervisor

log = logging.getLogger(__name__)


@dataclass
class MidiOptions:
    """The MIDI inputs to open; see ``yehu-server serve --help``."""

    patterns: Sequence[str] = ()  # empty: all but through ports
    virtual: str | None = None
    api: str | None = None  # None: the first there is
    routes: Sequence[Route] = ()  # see routes.Router


class MidiInputs(Supervisor):
    """Keeps the process that holds the MIDI inputs, and plays all parts from them.

    Its messages reach the audio callback by shared `memory`; the server receives them only where
    something is to be learned. `rigs`: the first instrument of each part. `on_message`: called,
    from another thread, with a line when a port or the MIDI system appears or disappears.
    """

    def __init__(
        self,
        players: Sequence[Player],
        options: MidiOptions,
        memory: SharedMemory,
        rigs: Sequence[int],
        on_message: Callable[[str], None],
    ) -> None:
        module = "yehu_server.live.midi.input_process"  # it ends as JACK's server does
        super().__init__(module, "MIDI inputs", on_message, memory.inherited)
        self._players = players
        self._router = Router(options.routes, len(players))
        self._memory, self._rigs = memory, rigs
        self._options = options
        self._numbers: dict[str, int] = {}  # a port that comes back gets its old one
        self._connected: dict[str, None] = {}
        self._child: Child | None = None
        self._missing: set[str] = set()  # patterns reported as matching nothing
        self.problem = ""
        for player in players:
            player.learning.on_change = self._send_forwarding

    @property
    def connected(self) -> list[str]:
        """Names of the open ports."""
        return list(self._connected)

    def name_of(self, number: int) -> str:
        """The name of the port that has or last had a number; empty for none."""
        return next((name for name, of in self._numbers.items() if of == number), "")

    def attend(self, child: Child, gone: threading.Event) -> None:
        """See `Supervisor`."""
        options, routed = self._options, self._router.patterns
        child.send(
            "open",
            patterns=[*options.patterns, *routed],
            others=not options.patterns and self._router.wants_others,
            virtual=options.virtual,
            api=options.api,
            routes=[astuple(route) for route in options.routes],
            known=self._router.others,
            numbers=self._numbers,
            memory=self._memory.handle,
            rings=[ring_place(MIDI_INPUTS, rig) for rig in self._rigs],
            message=MESSAGE,
            disconnect=DISCONNECT,
        )
        self._child = child
        self._send_forwarding()
        gone.wait()

    def _send_forwarding(self) -> None:
        """Let the process forward messages only while something is to be learned."""
        if self._child is not None:
            waits = any(player.learning.waits for player in self._players)
            self._child.send("forward", on=waits)

    def on_exit(self, *, by_itself: bool) -> None:
        """End the notes of all ports, whose process is gone."""
        if not (by_itself and self._connected):
            return
        for port in self._connected:
            for part in self._router.parts_of(port):
                player = self._players[part]
                player.end_port_notes(self._numbers[port], frame=player.frame_of())
        self._on_message(f"MIDI: {', '.join(self._connected)} gone; notes are ended")
        self._connected.clear()

    def on_event(self, event: Message) -> None:
        """See `Supervisor`."""
        kind = event["event"]
        if kind == "midi":
            self._learn_from(event["port"], event["bytes"])
        elif kind == "appeared":
            self._connected[event["port"]] = None
            self._number(event["port"], event["number"])
            self._on_message(f"MIDI: {event['port']} is connected{self._plays_text(event['port'])}")
        elif kind == "vanished":
            self._connected.pop(event["port"], None)
            self._on_message(f"MIDI: {event['port']} is gone; its notes are ended")
        elif kind == "silent":
            log.info("MIDI: %s fell silent (active sensing)", event["port"])
        elif kind == "slept":
            seconds = event["seconds"]
            self._on_message(f"MIDI: inputs were not read for {seconds:.1f} s; notes are ended")
        elif kind == "missing":
            self._report_missing(event["pattern"], event["present"])
        elif kind == "unused":
            asked = {"--midi-in": self._options.patterns, "--part": self._router.patterns}
            why = " and ".join(f"{by} names {', '.join(of)}" for by, of in asked.items() if of)
            self._on_message(f"MIDI: {event['port']} is connected, but plays nothing: {why}")
        elif kind == "refused":
            self._on_message(f"MIDI: {event['port']} cannot be opened: {event['reason']}")
        elif kind == "none":
            self.problem = event["reason"]
            self._report_none(event["reason"])
        elif kind == "system":
            self.problem = ""
            log.info("MIDI: through %s", event["api"])

    def _plays_text(self, port: str) -> str:
        """The parts that a port plays, as text, where there are several."""
        if len(self._players) == 1:
            return ""
        parts = [str(part + 1) for part in self._router.parts_of(port)]
        if not parts:
            return ", and plays no part"
        return f" to part {parts[0]}" if len(parts) == 1 else f" to parts {', '.join(parts)}"

    def _report_none(self, reason: str) -> None:
        virtual = self._options.virtual
        names = " or ".join((*self._options.patterns, *self._router.patterns))
        found = f"no keyboard named {names} found" if names else "no keyboard found"
        found += f", and no port {virtual} made" if virtual else ""
        self._on_message(f"MIDI: {found}: {reason}; looking again now and then")

    def _report_missing(self, pattern: str, present: Sequence[str]) -> None:
        if pattern not in self._missing:  # once, however often the process starts
            self._missing.add(pattern)
            there = ", ".join(present) or "none"
            self._on_message(f"MIDI: no input matches {pattern!r} yet (there are: {there})")

    def _number(self, port: str, number: int) -> None:
        """Remember the number of a port; one that is gone may have had it before."""
        self._numbers = {name: old for name, old in self._numbers.items() if old != number}
        self._numbers[port] = number

    def _learn_from(self, port: str, data: Sequence[int]) -> None:
        """Learn from a message, which is played already."""
        with contextlib.suppress(ValueError, IndexError):  # damaged
            message = mido.Message.from_bytes(data)
            for part in self._router.parts_of(port, getattr(message, "channel", None)):
                self._players[part].learning.hear_message(message, self._numbers[port])
