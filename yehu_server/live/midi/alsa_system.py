"""MIDI by ALSA's sequencer, of which alsa-midi has wheels where RtMidi has none."""

import threading
from collections.abc import Callable

from alsa_midi import (
    ALSAError,
    EventType,
    MidiBytesEvent,
    PortCaps,
    PortInfo,
    PortType,
    SequencerClient,
    StateError,
)

from yehu_server.errors import DeviceError
from yehu_server.live.midi.systems import CLIENT, Receive, no_system

# As RtMidi chooses ports.
PLAYED = PortType.MIDI_GENERIC | PortType.SYNTHESIZER | PortType.APPLICATION
LONG_OF_CHANNEL = 3  # bytes; 14-bit controllers and parameter numbers come as several messages


class System:
    """See `systems.MidiSystem`. One client lists ports, another one listens, in its own thread."""

    name = "ALSA"

    def __init__(self, api: str) -> None:
        try:
            self._finder, self._listener = SequencerClient(CLIENT), SequencerClient(CLIENT)
        except ALSAError as error:
            raise no_system(api, error) from error
        self._receivers: dict[int, Receive] = {}  # by the number of our port
        threading.Thread(target=self._listen, name="ALSA", daemon=True).start()

    def ports(self) -> list[str]:
        """See `systems.MidiSystem`."""
        return list(self._found())

    def _found(self) -> dict[str, PortInfo]:
        """Ports that send, by full names such as RtMidi gives them."""
        found = self._finder.list_ports(input=True, type=PortType(0), sort=False)
        return {
            f"{port.client_name}:{port.name} {port.client_id}:{port.port_id}": port
            for port in found
            if port.type & PLAYED
        }

    def left(self) -> set[str]:
        """None: ALSA numbers a client anew when it comes back."""
        return set()

    def open(self, full_name: str | None, name: str, receive: Receive) -> Callable[[], None]:
        """See `systems.MidiSystem`."""
        caps = PortCaps.WRITE | PortCaps.SUBS_WRITE
        try:
            source = None if full_name is None else self._found()[full_name]
            if source is not None:
                caps |= PortCaps.NO_EXPORT  # nobody else connects to it
            port = self._listener.create_port(name, caps, PLAYED)
            self._receivers[port.port_id] = receive
            if source is not None:
                port.connect_from(source)
        except (ALSAError, KeyError) as error:
            raise DeviceError(str(error)) from error

        def close() -> None:
            self._receivers.pop(port.port_id, None)
            port.close()

        return close

    def _listen(self) -> None:
        """Pass each message on, as bytes."""
        while True:
            try:
                event = self._listener.event_input(prefer_bytes=True)
            except ALSAError:  # the kernel's buffer ran over (ENOSPC): what came is lost
                continue
            except StateError:
                return
            if not isinstance(event, MidiBytesEvent) or event.type == EventType.SYSEX:
                continue
            receive = self._receivers.get(event.dest.port_id if event.dest else -1)
            data = list(event.midi_bytes)
            if receive is not None and data:
                for at in range(0, len(data), LONG_OF_CHANNEL):
                    receive(data[at : at + LONG_OF_CHANNEL])
