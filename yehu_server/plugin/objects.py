"""The instrument's code for several systems, made in a process that compiles for one level.

`python -m yehu_server.plugin.objects FOLDER TARGET` writes an object file for each
target into a folder, and the header of its functions.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from yehu_server.ahead import interface
from yehu_server.ahead.build import RATES, compile_for, compiled
from yehu_server.ahead.build_hash import build_hash
from yehu_server.ahead.header import header
from yehu_server.ahead.memory_images import image
from yehu_server.compile import levels
from yehu_server.errors import YehuError
from yehu_server.plugin.targets import WIDE, System, systems_of
from yehu_server.util import __version__

ENGINE_HEADER = "yehu.h"


def object_file(folder: Path, system: System, *, wide: bool) -> Path:
    """Where the object of a system's version lies."""
    return folder / f"{system.triple}{'-wide' if wide else ''}.o"


def make_objects(folder: Path, name: str) -> None:
    """Make the objects of all systems of a `--target`, and their header; raises YehuError."""
    for level in dict.fromkeys((levels.lowest(), WIDE)):
        if level == WIDE and not any(system.has_wide for system in systems_of(name)):
            continue
        compile_for(level, "yehu_server.plugin.objects", str(folder), name)


def make_here(folder: Path, systems: Sequence[System]) -> None:
    """Make objects of one version in this process, which compiles for its level."""
    images = [image(rate) for rate in RATES]
    functions = interface.functions(RATES, images, build_hash())
    wide = levels.level() == WIDE
    for system in systems:
        if wide and not system.has_wide:
            continue
        code = compiled(functions, system.target(wide=wide))
        object_file(folder, system, wide=wide).write_bytes(code)
    text = header(functions, version=__version__, sources=build_hash(), rates=RATES)
    (folder / ENGINE_HEADER).write_text(text)


if __name__ == "__main__":
    try:
        _folder, _name = sys.argv[1:]
        make_here(Path(_folder), systems_of(_name))
    except YehuError as error:
        sys.exit(str(error))
