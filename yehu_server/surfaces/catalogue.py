"""List the surfaces, write them into a folder, and check whether files there are up to date."""

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from yehu_server.errors import OutputError
from yehu_server.live.network import OSC_ADDRESS, Address
from yehu_server.surfaces import max as max_patch
from yehu_server.surfaces import open_stage_control, parameter_reference, puredata, touchosc
from yehu_server.surfaces.common_layout import ALL, for_part
from yehu_server.util.files import write_bytes


@dataclass(frozen=True)
class Surface:
    """A file for one program.

    `make`: returns its bytes, for a server at an address.
    `content`: returns the part of a file by which two are compared.
    """

    name: str
    about: str
    make: Callable[[Address], bytes]
    content: Callable[[bytes], bytes] = bytes


SURFACES = (
    Surface("yehu.tosc", "TouchOSC", touchosc.make, touchosc.content),
    Surface("yehu.maxpat", "Max", max_patch.make),
    Surface("yehu.pd", "Pure Data", puredata.make),
    Surface("open-stage-control.json", "Open Stage Control", open_stage_control.make),
    Surface("parameters.html", "a browser", parameter_reference.make),
)


def chosen(names: Sequence[str]) -> list[Surface]:
    """Return surfaces by their file names, or all; raises OutputError for unknown names."""
    known = {surface.name: surface for surface in SURFACES}
    for name in names:
        if name not in known:
            raise OutputError(f"no surface {name!r}; there are {', '.join(known)}")
    return [surface for surface in SURFACES if not names or surface.name in names]


def file_of(surface: Surface, folder: Path, part: int = ALL) -> Path:
    """The file of a surface for a part, from 1: ``yehu-part-2.pd``."""
    path = folder / surface.name
    return path if part == ALL else path.with_stem(f"{path.stem}-part-{part}")


def bytes_of(surface: Surface, server: Address, part: int) -> bytes:
    """The bytes of a surface's file, for a server and a part."""
    with for_part(part):
        return surface.make(server)


def write(surface: Surface, folder: Path, server: Address = OSC_ADDRESS, part: int = ALL) -> Path:
    """Write a surface's file, replacing an older one; return its path. Raises OutputError."""
    return write_bytes(file_of(surface, folder, part), bytes_of(surface, server, part))


def is_up_to_date(
    surface: Surface, folder: Path, server: Address = OSC_ADDRESS, part: int = ALL
) -> bool:
    """Whether a folder holds the file as it would be written now."""
    try:
        there = surface.content(file_of(surface, folder, part).read_bytes())
    except (OSError, zlib.error):
        return False
    return there == surface.content(bytes_of(surface, server, part))
