"""What commands there are: those of this package, and those that others of the project add.

A package adds its own by an entry point of GROUP, which names its table of them. It is read from
the distribution's file beside the packages, or from a checkout's pyproject.toml: importlib.metadata
finds more, but to load it takes a fifth of what ``--help`` does.
"""

import re
import tomllib
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from yehu_server.util import PACKAGE

# What each command is for; each is a module of this package.
COMMANDS = {
    "serve": "play live, by MIDI and OSC",
    "build": "compile the instrument as a plug-in, for web pages or for C programs",
    "devices": "list audio outputs, audio inputs and MIDI inputs",
    "follow": "play the tune that a voice or an instrument has in a sound file",
    "learn": "bind a knob, pedal or OSC address to a parameter of a running server",
    "mappings": "list, show, check and convert mappings: what controllers move",
    "page": "show the instrument in a web page, which sounds without a server",
    "presets": "list, show and check presets",
    "render": "render scores to a sound file, or a folder of them to a folder",
    "replay": "render a captured session to a sound file",
    "score": "show how a score is read, or write it as MusicXML or jianpu",
    "simulate": "run a gesture in physical units, and keep all signals as arrays",
    "surfaces": "write control surfaces for TouchOSC, Max, Pure Data, Open Stage Control",
}
FIRST = "serve"  # in the help; the others follow by their names
GROUP = "yehu_server.commands"
_POINT = re.compile(r"^\S+ *= *([\w.]+):(\w+) *$", re.MULTILINE)


def all_commands() -> dict[str, tuple[str, str]]:
    """Each command's module and what it is for, in the order of the help."""
    found = {name: (f"{__package__}.{name}", text) for name, text in COMMANDS.items()}
    for package, table in _entry_points():
        texts = getattr(import_module(package), table)
        found |= {name: (f"{package}.{name}", text) for name, text in texts.items()}
    return dict(sorted(found.items(), key=lambda each: (each[0] != FIRST, each[0])))


def module_of(name: str) -> str | None:
    """The module of a command, or None where there is none; others are not searched first."""
    if name in COMMANDS:
        return f"{__package__}.{name}"
    return all_commands().get(name, (None,))[0]


def _entry_points() -> Iterator[tuple[str, str]]:
    """The modules and names that entry points of GROUP have."""
    folder = PACKAGE.parent
    for file in folder.glob("yehu_server-*.dist-info/entry_points.txt"):
        _, _, points = file.read_text(encoding="utf-8").partition(f"[{GROUP}]\n")
        yield from _POINT.findall(points.partition("\n[")[0])
        return
    checkout = folder / "pyproject.toml"
    if checkout.exists():  # else the package was copied without the others
        project: dict[str, Any] = tomllib.loads(checkout.read_text(encoding="utf-8"))["project"]
        for point in project["entry-points"][GROUP].values():
            package, _, table = point.partition(":")
            yield package, table
