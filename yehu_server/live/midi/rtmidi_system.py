"""MIDI by RtMidi, of ALSA, CoreMIDI and Windows."""

from collections.abc import Callable
from typing import Any

import rtmidi

from yehu_server.errors import DeviceError
from yehu_server.live.midi.systems import CLIENT, Receive, no_system

NUMBERS = {
    "alsa": rtmidi.API_LINUX_ALSA,
    "core": rtmidi.API_MACOSX_CORE,
    "windows": rtmidi.API_WINDOWS_MM,
}
ERRORS = (rtmidi.RtMidiError, SystemError, ValueError, NotImplementedError)


class System:
    """See `systems.MidiSystem`. One client lists ports: a new one each time exhausts ALSA."""

    def __init__(self, api: str) -> None:
        self._number = NUMBERS[api]
        self.name = str(rtmidi.get_api_display_name(self._number))
        if self._number not in rtmidi.get_compiled_api():
            raise DeviceError(f"RtMidi was compiled without {self.name}")
        try:
            self._finder = self._client()
        except DeviceError as error:
            raise no_system(api, error) from error

    def _client(self) -> Any:
        try:
            return rtmidi.MidiIn(self._number, name=CLIENT)
        except ERRORS as error:
            raise DeviceError(str(error)) from error

    def ports(self) -> list[str]:
        """See `systems.MidiSystem`."""
        return list(self._finder.get_ports())

    def left(self) -> set[str]:
        """None: these systems name a port anew when it comes back."""
        return set()

    def open(self, full_name: str | None, name: str, receive: Receive) -> Callable[[], None]:
        """See `systems.MidiSystem`."""
        midi = self._client()
        midi.ignore_types(sysex=True, timing=True, active_sense=False)
        midi.set_callback(lambda event, _data: receive(event[0]))
        try:
            if full_name is None:
                midi.open_virtual_port(name)
            else:
                midi.open_port(midi.get_ports().index(full_name), name=name[:32])
        except ERRORS as error:
            raise DeviceError(str(error)) from error

        def close() -> None:
            midi.cancel_callback()
            midi.close_port()

        return close
