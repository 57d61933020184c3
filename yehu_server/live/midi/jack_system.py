"""MIDI by JACK, PipeWire's included.

When the server ends, this process does: nothing that JACK's library does after that is safe.
"""

import os
from collections.abc import Callable
from typing import Any

import jack

from yehu_server.errors import DeviceError
from yehu_server.live.midi.systems import CLIENT, Receive


class System:
    """See `systems.MidiSystem`. One client, with an input for each port that it listens to."""

    name = "JACK"

    def __init__(self, _api: str) -> None:
        jack.set_error_function(lambda _line: None)
        jack.set_info_function(lambda _line: None)
        try:
            self._client = jack.Client(CLIENT, no_start_server=True)
        except jack.JackError as error:
            raise DeviceError("no JACK server") from error
        self._left: set[str] = set()
        self._virtual: list[Any] = []  # ports that others find by name
        self._open: tuple[tuple[Any, Receive], ...] = ()  # replaced whole: the callback reads it
        self._client.set_shutdown_callback(lambda _status, _reason: os._exit(1))
        self._client.set_port_registration_callback(self._port_changed, only_available=False)
        self._client.set_process_callback(self._process)
        self._client.activate()
        self._client.get_ports(is_midi=True)  # known from now on, their ends have names

    def ports(self) -> list[str]:
        """See `systems.MidiSystem`; without those that others have connected to a port of ours."""
        connected = {port.name for own in self._virtual for port in own.connections}
        ports = self._client.get_ports(is_midi=True, is_output=True)
        return [port.name for port in ports if port.name not in connected]

    def left(self) -> set[str]:
        """See `systems.MidiSystem`."""
        left, self._left = self._left, set()
        return left

    def _port_changed(self, port: Any, is_there: bool) -> None:
        if port is not None and not is_there:
            self._left.add(port.name)

    def open(self, full_name: str | None, name: str, receive: Receive) -> Callable[[], None]:
        """See `systems.MidiSystem`."""
        try:
            own = self._client.midi_inports.register(name.replace(":", " "))
        except (jack.JackError, ValueError) as error:
            raise DeviceError(str(error)) from error
        entry = (own, receive)
        self._open = (*self._open, entry)

        def close() -> None:
            self._open = tuple(each for each in self._open if each is not entry)
            own.unregister()

        try:
            if full_name is None:
                self._virtual.append(own)
            else:
                self._client.connect(full_name, own)
        except jack.JackError as error:
            close()
            raise DeviceError(str(error)) from error
        return close

    def _process(self, _frames: int) -> None:
        for own, receive in self._open:
            for _offset, data in own.incoming_midi_events():
                if message := bytes(data):  # an exception would end the callbacks
                    receive(message)
