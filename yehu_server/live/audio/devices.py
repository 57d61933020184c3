"""List audio outputs and inputs, and choose one by name."""

import contextlib
import ctypes
import ctypes.util
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from yehu_server.errors import DeviceError, did_you_mean
from yehu_server.util.hints import command_name

OUTPUT, INPUT = "output", "input"  # kinds
CLIENTS = {OUTPUT: b"yehu-server", INPUT: b"yehu-server voice"}  # their names in JACK, kept for it
OURS = CLIENTS[OUTPUT].decode()  # what they begin with
JACK, PULSEAUDIO = "JACK Audio Connection Kit", "PulseAudio"  # host APIs of sound servers
JACKS_CARD = "system"  # of a JACK server; PipeWire in its place has other names
ALSA_NAMES = {"pulseaudio": "pulse"}  # of plug-ins that are not named as their server is
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
    """List all outputs, or inputs, in the order in which they are preferred.

    A sound server's own host API comes before ALSA, whose plug-ins lead to the same server by a
    detour; but the first input of PipeWire in JACK's place is what it plays itself. Of each host
    API the default device comes first. JACK's clients are devices to PortAudio; those of this
    program are left out, or it would follow itself.
    """
    apis = sounddevice.query_hostapis()

    def order(device: Any) -> tuple[bool, bool, int, bool]:
        api = apis[device["hostapi"]]
        is_jack = api["name"] == JACK and (kind == OUTPUT or device["name"] == JACKS_CARD)
        is_default = device["index"] == api[f"default_{kind}_device"]
        return not is_jack, api["name"] != PULSEAUDIO, device["hostapi"], not is_default

    return [
        AudioDevice(
            index=device["index"],
            name=device["name"],
            host_api=apis[device["hostapi"]]["name"],
            channels=device[f"max_{kind}_channels"],
            rate=device["default_samplerate"],
            latency_ms=1e3 * device[f"default_low_{kind}_latency"],
        )
        for device in sorted(sounddevice.query_devices(), key=order)
        if device[f"max_{kind}_channels"] > 0 and not device["name"].startswith(OURS)
    ]


NULL = "null"  # the name of silence
NOTHING = "there is no audio {}"
NO_OUTPUT = NOTHING.format(OUTPUT)
ADVICE = (
    f"connect one and start its sound server, or listen in the page: {command_name()} serve --open"
)


def choose(devices: Sequence[AudioDevice], wanted: str | None, kind: str = OUTPUT) -> AudioDevice:
    """Choose a device by its full name, its host API alone, its name, or words in these.

    Raises DeviceError where none or several match.

    `devices`: as `devices` lists them; the first is the default, also of its host API.
    `wanted`: such as ``"hifi"``, ``"JACK"`` or ``"system, JACK"``; None for the default.
    """
    if wanted is None:
        if not devices:
            raise DeviceError(NOTHING.format(kind))
        return devices[0]
    name = wanted.lower()
    words = name.replace(",", " ").split()
    of_apis = {device.host_api: device for device in reversed(devices)}.values()
    for fitting in (
        [device for device in devices if device.full_name == wanted],
        [device for device in of_apis if device.host_api.lower().startswith(name)],
        [device for device in devices if device.name.lower() in (name, ALSA_NAMES.get(name))],
        [d for d in devices if all(word in d.full_name.lower() for word in words)],
    ):
        if len(fitting) == 1:
            return fitting[0]
    advice = f"none; {ADVICE}" if kind == OUTPUT else "none"
    names = "; ".join(device.full_name for device in fitting or devices) or advice
    if fitting:
        raise DeviceError(f"several audio {kind}s match {wanted!r}: {names}")
    near = did_you_mean(wanted, [NULL, *(device.name for device in devices)])
    raise DeviceError(f"no audio {kind} matches {wanted!r} (there are: {names}){near}")
