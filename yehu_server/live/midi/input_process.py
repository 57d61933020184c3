"""The process that holds the MIDI inputs: ``python -m yehu_server.live.midi.input_process``.

It opens the wanted inputs as they appear, stamps each message on arrival, and puts it where the
audio callback takes it (``feed``). RtMidi over JACK crashes when the JACK server dies: then
this process ends, and a new one takes its place.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Iterable, Sequence
from typing import Any

from yehu_server.core.midi.packing import MAX_BYTES
from yehu_server.errors import ParameterError
from yehu_server.live.midi.feed import PORTS, MidiFeed, SharedRing
from yehu_server.live.midi.jack_watch import JackWatch
from yehu_server.live.midi.routes import Route, Router, StableNames, is_wanted
from yehu_server.system import clocks
from yehu_server.system.memory import open_shared
from yehu_server.util.processes import SWITCH_INTERVAL_S, Message, Parent

POLL_EVERY_S = 0.5
SYSTEM_EVERY_S = 2.0  # between searches for a MIDI system, where there is none
AGAIN_S = 5.0  # until a port is tried again that could not be opened: another program may have it
SENSE_EVERY_S = 0.05
SENSE_WITHIN_S = 0.33  # active sensing promises a message every 300 ms
SLEPT_S = 0.25  # a longer pause between two checks: this process was stopped
CLIENT = "yehu-server MIDI"
ACTIVE_SENSING, CLOCKS = 0xFE, {0xF8, 0xF9}

APIS = {"alsa": "LINUX_ALSA", "jack": "UNIX_JACK", "core": "MACOSX_CORE", "windows": "WINDOWS_MM"}


class Input:
    """An open MIDI input.

    `is_forwarded`: whether each message is sent to the parent, too.
    """

    def __init__(
        self, midi: Any, name: str, full_name: str | None, feed: MidiFeed, parent: Parent
    ) -> None:
        self.midi = midi
        self.name = name
        self.full_name = full_name
        self.is_forwarded = False
        self._feed = feed
        self._parent = parent
        self.heard_s = 0.0  # of the last message, or of a stop of this process
        self._senses = False
        midi.ignore_types(sysex=True, timing=True, active_sense=False)
        midi.set_callback(self._receive)

    def _receive(self, event: tuple[Sequence[int], float], _data: Any = None) -> None:
        at = clocks.monotonic_ns()
        data = event[0]
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

    def close(self) -> None:
        """Close the port."""
        self.midi.cancel_callback()
        self.midi.close_port()


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
        self._finder: Any = None  # the client that lists port names
        self._problem = ""
        self._refused: dict[str, float] = {}  # when ports could not be opened, s
        self._sought: set[str] = set(self._patterns)  # those that no port has matched yet
        self._watch: JackWatch | None = None
        self._awake_s = time.monotonic()

    @property
    def has_system(self) -> bool:
        """Whether there is a MIDI system."""
        return self._finder is not None

    def poll(self) -> None:
        """Open ports that appeared, close those that disappeared."""
        if self._finder is None and not self._start():
            return
        names = self._finder.get_ports()
        stable = dict(zip(self._names.of(names), names, strict=True))
        gone = set(self._open) - set(stable) - {self._virtual}
        if self._watch is not None:  # ports that went and are back under the same name
            left = self._watch.left()
            gone |= {name for name, port in self._open.items() if port.full_name in left}
        for name in gone:
            self._open.pop(name).close()
            self._feed.end_port_notes(name, clocks.monotonic_ns(), is_gone=True)
            self._parent.send("vanished", port=name)
        self._refused = {name: at for name, at in self._refused.items() if name in stable}
        early = time.monotonic() - AGAIN_S
        for name, full_name in stable.items():
            is_due = self._refused.get(name, early) <= early
            is_named = bool(self._patterns) and is_wanted(name, self._patterns)
            wanted = is_named or (self._others and is_wanted(name, ()))
            if name not in self._open and is_due and wanted:
                self._add(name, full_name)
        self._report_missing(stable)
        self._measure_pause()  # opening a port takes long, while others are heard

    def _report_missing(self, names: Iterable[str]) -> None:
        """Report patterns that no port matches, at the first poll."""
        present = list(names)
        for pattern in self._sought:
            if not any(is_wanted(name, [pattern]) for name in present):
                self._parent.send("missing", pattern=pattern, present=present)
        self._sought.clear()

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

    def _start(self) -> bool:
        finder, problem = open_client(self._api)
        if finder is None:
            if problem != self._problem:
                self._problem = problem
                self._parent.send("none", reason=problem)
            return False
        self._finder = finder
        self._api = finder.get_current_api()
        if self._api == _number("jack"):
            self._watch = JackWatch(f"{CLIENT} watch")
        self._parent.send("system", api=api_name(self._api))
        if self._virtual is not None:
            self._add(self._virtual, None)
        return True

    def _add(self, name: str, full_name: str | None) -> None:
        """Open a port, or (without a full name) a virtual one."""
        import rtmidi

        number = self._feed.open(name)
        if number is None:
            self._refuse(name, f"{PORTS} are open, which is the most")
            return
        try:
            port = Input(self._client(), name, full_name, self._feed, self._parent)
            if full_name is None:
                port.midi.open_virtual_port(name)
            else:
                port.midi.open_port(port.midi.get_ports().index(full_name), name=name[:32])
        except (rtmidi.RtMidiError, SystemError, ValueError, NotImplementedError) as error:
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

    def _client(self) -> Any:
        import rtmidi

        return rtmidi.MidiIn(self._api, name=CLIENT)


def check_api(api: str | None) -> None:
    """Refuse (ParameterError) a MIDI system that is not here: RtMidi would take another one."""
    import rtmidi

    compiled = rtmidi.get_compiled_api()
    if api is not None and _number(api) not in compiled:
        there = ", ".join(name for name in APIS if _number(name) in compiled) or "none"
        raise ParameterError(f"--midi-api {api}: is not of this system; there are: {there}")


def open_client(api: str | int | None) -> tuple[Any, str]:
    """Open a client of the named MIDI system, or of the first there is; or None, and why."""
    import rtmidi

    if isinstance(api, str):
        wanted = [_number(api)]
    else:
        wanted = [api] if api is not None else list(rtmidi.get_compiled_api())
    problem = "RtMidi knows no MIDI system here"
    for number in wanted:
        try:
            return rtmidi.MidiIn(number, name=CLIENT), ""
        except (rtmidi.RtMidiError, SystemError) as error:
            problem = str(error)
    return None, problem


def list_inputs() -> tuple[str, list[str], str]:
    """List the MIDI inputs: the system, their stable names, and why there is no system."""
    client, problem = open_client(None)
    if client is None:
        return "", [], problem
    return api_name(client.get_current_api()), StableNames().of(client.get_ports()), ""


def _number(api: str) -> int:
    import rtmidi

    return int(getattr(rtmidi, f"API_{APIS[api]}"))


def api_name(number: int) -> str:
    """A MIDI system's display name."""
    import rtmidi

    return str(rtmidi.get_api_display_name(number))


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
    # RtMidi's threads wait for others here, and JACK does not wait for them.
    sys.setswitchinterval(SWITCH_INTERVAL_S)
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
