"""The MIDI systems of this machine, each by a library of its own that may be missing.

JACK's is JACK-Client, on every Python: RtMidi reads a message again where JACK has lost one, and
crashes when the server dies. RtMidi has the others where it has wheels (python-rtmidi 1.5.8: up to
Python 3.12); beyond that alsa-midi has ALSA's.
"""

import importlib
import importlib.util
import sys
from collections.abc import Callable, Sequence
from typing import Protocol

from yehu_server.errors import DeviceError, ParameterError
from yehu_server.system import NAME

CLIENT = "yehu-server MIDI"
# In the order in which they are tried.
OF_PLATFORM = {"linux": ("alsa", "jack"), "macos": ("core",), "windows": ("windows",)}

Receive = Callable[[Sequence[int]], None]  # called with the bytes of a message, in another thread


class MidiSystem(Protocol):
    """A client of a MIDI system."""

    name: str  # as it is displayed

    def ports(self) -> list[str]:
        """List the full names of the ports that send."""

    def left(self) -> set[str]:
        """Full names of ports that disappeared since the last call, even if they are back."""

    def open(self, full_name: str | None, name: str, receive: Receive) -> Callable[[], None]:
        """Listen to a port, or without a full name to a new one that others find by its name.

        Return what closes it; raises DeviceError where it cannot be opened.
        """


def systems() -> tuple[str, ...]:
    """The MIDI systems of this platform, as ``--midi-api`` names them."""
    return OF_PLATFORM[NAME]


def check_api(api: str | None) -> None:
    """Refuse (ParameterError) a MIDI system that this platform does not have."""
    if api is not None and api not in systems():
        there = ", ".join(systems()) or "none"
        raise ParameterError(f"--midi-api {api}: not available here; there are: {there}")


def no_system(api: str, error: Exception) -> DeviceError:
    """The error of a system that takes no client, with what may help."""
    advice = " (modprobe snd-seq loads ALSA's sequencer)" if api == "alsa" else ""
    return DeviceError(f"{str(error).strip(' .')}{advice}")


def library(api: str) -> tuple[str, str]:
    """A MIDI system's module, and the library it needs; DeviceError says how to get one."""
    if api == "jack":
        choices = {"jack_system": ("jack", "JACK-Client")}
    else:
        choices = {"rtmidi_system": ("rtmidi", "python-rtmidi")}
        if api == "alsa":
            choices["alsa_system"] = ("alsa_midi", "alsa-midi")
    for module, (name, _) in choices.items():
        if importlib.util.find_spec(name) is not None:
            return module, name
    package = [package for _, package in choices.values()][-1]
    advice = f"{package} is not installed: pip install {package}"
    if package == "python-rtmidi" and sys.version_info >= (3, 13):
        advice += ", which needs a C++ compiler; Python 3.12 and 3.11 need none"
    raise DeviceError(advice)


def open_system(api: str | None) -> MidiSystem:
    """Open a client of the named MIDI system, or of the first there is.

    Raises DeviceError where none can be opened.
    """
    problems = []
    for name in systems() if api is None else (api,):
        try:
            module = importlib.import_module(f"{__package__}.{library(name)[0]}")
            opened: MidiSystem = module.System(name)
        except (DeviceError, ImportError, OSError) as error:  # OSError: a library of the system's
            problems.append(str(error).strip(" ."))
        else:
            return opened
    raise DeviceError("; ".join(problems) or "no MIDI system of this platform is known")
