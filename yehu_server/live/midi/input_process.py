"""The process that holds the MIDI inputs: ``python -m yehu_server.live.midi.input_process``.

It opens the wanted inputs as they appear (``systems``), stamps each message on arrival, and puts it
where the audio callback takes it (``feed``). When a JACK server dies, this process ends, and a new
one takes its place.
"""

import os
import threading
import time
from collections.abc import Callable, Iterable, Sequence

from yehu_server.core.midi.packing import MAX_BYTES
from yehu_server.errors import DeviceError
from yehu_server.live.midi.feed import PORTS, MidiFeed, SharedRing
from yehu_server.live.midi.ports import StableNames, is_opened, matches
from yehu_server.live.midi.routes import Route, Router
from yehu_server.live.midi.systems import MidiSystem, open_system
from yehu_server.system import clocks
from yehu_server.system.memory import open_shared
from yehu_server.system.processes import be_prompt
from yehu_server.util.processes import Message, Parent

POLL_EVERY_S = 0.5
SYSTEM_EVERY_S = 2.0  # between searches for a MIDI system, where there is none
AGAIN_S = 5.0  # until a port is tried again that could not be opened: another program may have it
SENSE_EVERY_S = 0.05
SENSE_WITHIN_S = 0.33  # active sensing promises a message every 300 ms
SLEPT_S = 0.25  # a longer pause between two checks: this process was stopped
ACTIVE_SENSING, CLOCKS = 0xFE, {0xF8, 0xF9}


class Input:
    """An open MIDI input; if `is_forwarded`, each message is sent to the parent, too."""

    def __init__(self, name: str, full_name: str | None, feed: MidiFeed, parent: Parent) -> None:
        self.name = name
        self.full_name = full_name
        self.is_forwarded = False
        self.close: Callable[[], None] = lambda: None
        self._feed = feed
        self._parent = parent
        self.heard_s = 0.0  # of the last message, or of a stop of this process
        self._senses = False

    def receive(self, data: Sequence[int]) -> None:
        """Play a message of the port."""
        at = clocks.monotonic_ns()
        self.heard_s = 1e-9 * at
        if data[0] == ACTIVE_SENSING:
            self._senses = True
        elif data[0] not in CLOCKS and len(data) <= MAX_BYTES:  # no system exclusive
            self._feed.receive(self.name, data, at)
            if self.is_forwarded:
                self._parent.send("midi", port=self.name, bytes=list(data))

    def sense(self) -> None:
        """End the notes of the port where active sensing has stopped."""
        if self._senses and time.monotonic() - self.heard_s > SENSE_WITHIN_S:
            self._senses = False
            self._feed.end_port_notes(self.name, clocks.monotonic_ns(), is_gone=False)
            self._parent.send("silent", port=self.name)


class Inputs:
    """The wanted MIDI inputs, opened and closed as they appear and disappear."""

    def __init__(self, parent: Parent, feed: MidiFeed, order: Message) -> None:
        self._parent = parent
        self._feed = feed
        self._forwards = False
        self._patterns: Sequence[str] = order["patterns"]
        # Whether all others but through ports are opened, too.
        self._others = bool(order.get("others", not self._patterns))
        self._virtual: str | None = order["virtual"]
        self._api = order["api"]
        self._open: dict[str, Input] = {}
        self._names = StableNames()
        self._system: MidiSystem | None = None
        self._problem = ""
        self._refused: dict[str, float] = {}  # when ports could not be opened, s
        self._sought: set[str] = set(self._patterns)  # those that no port has matched yet
        self._unused: set[str] | None = None  # ports that no name matches; None before a poll
        self._awake_s = time.monotonic()

    @property
    def has_system(self) -> bool:
        """Whether there is a MIDI system."""
        return self._system is not None

    def poll(self) -> None:
        """Open ports that appeared, close those that disappeared."""
        if self._system is None:
            self._system = self._start()
        if self._system is None:
            return
        names = self._system.ports()
        stable = dict(zip(self._names.of(names), names, strict=True))
        gone = set(self._open) - set(stable) - {self._virtual}
        left = self._system.left()  # some may be back under the same name
        gone |= {name for name, port in self._open.items() if port.full_name in left}
        for name in gone:
            self._open.pop(name).close()
            self._feed.end_port_notes(name, clocks.monotonic_ns(), is_gone=True)
            self._parent.send("vanished", port=name)
        self._refused = {name: at for name, at in self._refused.items() if name in stable}
        early = time.monotonic() - AGAIN_S
        for name, full_name in stable.items():
            is_due = self._refused.get(name, early) <= early
            is_wanted = is_opened(name, self._patterns, others=self._others)
            if name not in self._open and is_due and is_wanted:
                self._add(self._system, name, full_name)
        self._report_missing(stable)
        self._report_unused(stable)
        self._measure_pause()  # opening a port takes long, while others are heard

    def _report_missing(self, names: Iterable[str]) -> None:
        """Report patterns that no port matches, at the first poll."""
        present = list(names)
        for pattern in self._sought:
            if not any(matches(name, pattern) for name in present):
                self._parent.send("missing", pattern=pattern, present=present)
        self._sought.clear()

    def _report_unused(self, names: Iterable[str]) -> None:
        """Report ports that were connected since the first poll, and that no pattern matches."""
        unused = {name for name in names if is_opened(name, (), others=True)} - {*self._open}
        unused -= {*self._refused}
        for name in () if self._unused is None else sorted(unused - self._unused):
            self._parent.send("unused", port=name)
        self._unused = unused

    def sense(self) -> None:
        """See `Input.sense`. After a stop of this process, whose messages are lost, notes end."""
        pause_s = self._measure_pause()
        if pause_s > SLEPT_S and self._open:
            for name in list(self._open):
                self._feed.end_port_notes(name, clocks.monotonic_ns(), is_gone=False)
            self._parent.send("slept", seconds=pause_s)
        for port in list(self._open.values()):
            port.sense()

    def _measure_pause(self) -> float:
        """The time since the last call; after a long one, waiting for ports begins anew."""
        before, self._awake_s = self._awake_s, time.monotonic()
        if self._awake_s - before > SLEPT_S:
            for port in list(self._open.values()):
                port.heard_s = self._awake_s
        return self._awake_s - before

    def forward(self, on: bool) -> None:
        """Send the parent each message from now on, or none; any thread may call."""
        self._forwards = on
        for port in list(self._open.values()):
            port.is_forwarded = on

    def _start(self) -> MidiSystem | None:
        try:
            system = open_system(self._api)
        except DeviceError as error:
            if str(error) != self._problem:
                self._problem = str(error)
                self._parent.send("none", reason=self._problem)
            return None
        self._parent.send("system", api=system.name)
        if self._virtual is not None:
            self._add(system, self._virtual, None)
        return system

    def _add(self, system: MidiSystem, name: str, full_name: str | None) -> None:
        """Open a port, or (without a full name) a virtual one."""
        number = self._feed.open(name)
        if number is None:
            self._refuse(name, f"{PORTS} are open, which is the most")
            return
        port = Input(name, full_name, self._feed, self._parent)
        try:
            port.close = system.open(full_name, name, port.receive)
        except DeviceError as error:
            self._feed.end_port_notes(name, clocks.monotonic_ns(), is_gone=True)
            self._refuse(name, str(error))
            return
        self._refused.pop(name, None)
        self._open[name] = port
        port.is_forwarded = self._forwards
        self._parent.send("appeared", port=name, number=number)

    def _refuse(self, name: str, reason: str) -> None:
        """Leave a port for now; it is reported the first time."""
        if name not in self._refused:
            self._parent.send("refused", port=name, reason=reason)
        self._refused[name] = time.monotonic()


def list_inputs() -> tuple[str, list[str], str]:
    """List the MIDI inputs: the system, their stable names, and why there is no system."""
    try:
        system = open_system(None)
    except DeviceError as error:
        return "", [], str(error)
    return system.name, StableNames().of(system.ports()), ""


def _feed(order: Message) -> MidiFeed:
    """Make the feed that an order describes."""
    memory = open_shared(order["memory"])
    rings = [SharedRing(memory, place) for place in order["rings"]]
    routes = [Route(*route) for route in order["routes"]]
    router = Router(routes, len(rings), order["known"])
    kinds = {name: order[name] for name in ("message", "disconnect")}
    return MidiFeed(rings, router, numbers=order["numbers"], **kinds)


def main() -> None:
    """Serve the parent process until it closes the pipe."""
    # Messages come in threads that wait for others here, and JACK does not wait for them.
    be_prompt()
    parent = Parent()
    orders = parent.orders()
    order = next(orders)
    inputs = Inputs(parent, _feed(order), order)
    ended = threading.Event()

    def listen() -> None:
        for later in orders:
            inputs.forward(later["on"])
        ended.set()

    threading.Thread(target=listen, daemon=True).start()
    polled = -SYSTEM_EVERY_S
    while not ended.wait(SENSE_EVERY_S):
        inputs.sense()
        pause = POLL_EVERY_S if inputs.has_system else SYSTEM_EVERY_S
        if time.monotonic() - polled > pause:
            inputs.poll()
            polled = time.monotonic()
    os._exit(0)


if __name__ == "__main__":
    main()
