"""List audio outputs and inputs, and choose one by name."""

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

OUTPUT, INPUT = "output", "input"  # kinds
CLIENTS = {OUTPUT: b"yehu-server", INPUT: b"yehu-server voice"}  # their names in JACK
NO_PORTAUDIO = "PortAudio is not installed (Debian: sudo apt-get install libportaudio2)"


@dataclass(frozen=True)
class AudioDevice:
    """An audio output, or an input, as PortAudio lists it."""

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


def load_portaudio(kind: str = OUTPUT) -> Any:
    """Import sounddevice, which starts PortAudio; raises DeviceError where there is none."""
    name = ctypes.util.find_library("portaudio")
    if name is not None:
        with contextlib.suppress(OSError, AttributeError):  # without JACK
            ctypes.CDLL(name).PaJack_SetClientName(CLIENTS[kind])
    try:
        import sounddevice
    except OSError as error:
        raise DeviceError(NO_PORTAUDIO) from error
    return sounddevice


def devices(sounddevice: Any, kind: str = OUTPUT) -> list[AudioDevice]:
    """List all outputs, or inputs, the default one marked."""
    apis = sounddevice.query_hostapis()
    default = default_index(sounddevice, kind)
    return [
        AudioDevice(
            index=device["index"],
            name=device["name"],
            host_api=apis[device["hostapi"]]["name"],
            channels=device[f"max_{kind}_channels"],
            rate=device["default_samplerate"],
            latency_ms=1e3 * device[f"default_low_{kind}_latency"],
            is_default=device["index"] == default,
        )
        for device in sounddevice.query_devices()
        if device[f"max_{kind}_channels"] > 0
    ]


def default_index(sounddevice: Any, kind: str = OUTPUT) -> int:
    """Index of PortAudio's default device, or of the first host API that has one; -1 for none."""
    index = int(sounddevice.default.device[kind == OUTPUT])
    apis = sounddevice.query_hostapis()
    candidates = [index, *(api[f"default_{kind}_device"] for api in apis)]
    return next((candidate for candidate in candidates if candidate >= 0), -1)


NOTHING = "there is no audio {}"
NO_OUTPUT = NOTHING.format(OUTPUT)
ADVICE = "connect one and start its sound server, or listen in the page: serve --open"


def choose(devices: Sequence[AudioDevice], wanted: str | None, kind: str = OUTPUT) -> AudioDevice:
    """Choose a device by its full name, its name, or words in these.

    Raises DeviceError where none or several match.

    `wanted`: such as ``"hifi"`` or ``"system, JACK"``; by default the default one.
    """
    if wanted is None:
        fitting = [device for device in devices if device.is_default]
        if not fitting:
            raise DeviceError(NOTHING.format(kind))
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
    advice = f"none; {ADVICE}" if kind == OUTPUT else "none"
    names = "; ".join(device.full_name for device in fitting or devices) or advice
    if fitting:
        raise DeviceError(f"several audio {kind}s match {wanted!r}: {names}")
    raise DeviceError(f"no audio {kind} matches {wanted!r} (there are: {names})")
