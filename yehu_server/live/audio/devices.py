"""List audio outputs, and choose one by name."""

from __future__ import annotations

import contextlib
import ctypes
import ctypes.util
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from yehu_server.errors import DeviceError

CLIENT_NAME = b"yehu-server"  # in JACK
NO_PORTAUDIO = "PortAudio is not installed (Debian: sudo apt-get install libportaudio2)"


@dataclass(frozen=True)
class AudioDevice:
    """An audio output, as PortAudio lists it."""

    index: int  # PortAudio's; it may change at each start
    name: str
    host_api: str
    channels: int
    rate: float  # Hz; the default one
    latency_ms: float
    is_default: bool

    @property
    def full_name(self) -> str:
        """Name and host API, by which `choose` finds it whatever other devices there are."""
        return f"{self.name}, {self.host_api}"


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Suppress what sound systems print to the terminal when devices are listed."""
    sys.stderr.flush()
    saved_stderr, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(saved_stderr, 2)
        os.close(saved_stderr)
        os.close(nowhere)


def load_portaudio() -> Any:
    """Import sounddevice, which starts PortAudio.

    Raises
    ------
    DeviceError
        Where there is no PortAudio.
    """
    name = ctypes.util.find_library("portaudio")
    if name is not None:
        with contextlib.suppress(OSError, AttributeError):  # without JACK
            ctypes.CDLL(name).PaJack_SetClientName(CLIENT_NAME)
    try:
        import sounddevice
    except OSError as error:
        raise DeviceError(NO_PORTAUDIO) from error
    return sounddevice


def outputs(sounddevice: Any) -> list[AudioDevice]:
    """List all outputs, the default one marked."""
    apis = sounddevice.query_hostapis()
    default = default_index(sounddevice)
    return [
        AudioDevice(
            index=device["index"],
            name=device["name"],
            host_api=apis[device["hostapi"]]["name"],
            channels=device["max_output_channels"],
            rate=device["default_samplerate"],
            latency_ms=1e3 * device["default_low_output_latency"],
            is_default=device["index"] == default,
        )
        for device in sounddevice.query_devices()
        if device["max_output_channels"] > 0
    ]


def default_index(sounddevice: Any) -> int:
    """Index of PortAudio's default output, or of the first host API that has one; -1 for none."""
    index = int(sounddevice.default.device[1])
    apis = sounddevice.query_hostapis()
    candidates = [index, *(api["default_output_device"] for api in apis)]
    return next((candidate for candidate in candidates if candidate >= 0), -1)


NO_OUTPUT = "there is no audio output"
ADVICE = "connect one and start its sound server, or listen in the page: serve --open"


def choose(devices: Sequence[AudioDevice], wanted: str | None) -> AudioDevice:
    """Choose an output by its full name, its name, or words in these.

    Parameters
    ----------
    wanted : str, optional
        Such as ``"hifi"`` or ``"system, JACK"``; by default the default output.

    Raises
    ------
    DeviceError
        Where none or several match.
    """
    if wanted is None:
        fitting = [device for device in devices if device.is_default]
        if not fitting:
            raise DeviceError(NO_OUTPUT)
        return fitting[0]
    by_full_name = [device for device in devices if device.full_name == wanted]
    by_name = [device for device in devices if device.name == wanted]
    for fitting in (by_full_name, by_name):
        if len(fitting) == 1:
            return fitting[0]
    words = wanted.lower().replace(",", " ").split()
    fitting = [d for d in devices if all(word in d.full_name.lower() for word in words)]
    if len(fitting) == 1:
        return fitting[0]
    names = "; ".join(device.full_name for device in fitting or devices) or f"none; {ADVICE}"
    if fitting:
        raise DeviceError(f"several audio outputs match {wanted!r}: {names}")
    raise DeviceError(f"no audio output matches {wanted!r} (there are: {names})")
