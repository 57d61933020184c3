"""Machine code that the wheel brings, so that a first start compiles nothing and needs no numba.

Each level of this machine's kind is compiled in a process of its own, a minute for the first. The
code for ARM is made here too: LLVM makes it of what numba optimised for the lowest level. That for
Windows is made by the Python of ``scripts/test --windows``, where that is set up.
"""

import json
import os
import subprocess
import sys
import zlib
from pathlib import Path

from compile_all import MORE, warm_up

from yehu_server.ahead.build import compiled
from yehu_server.ahead.module import Target
from yehu_server.compile import levels, machine_code
from yehu_server.compile.cache_folder import cache_folder, source_hash
from yehu_server.core.engine.warming import all_functions, functions_beside
from yehu_server.util.checksummed import read_checksummed, write_checksummed

ARM = Target("aarch64-unknown-linux-gnu", "generic")
ARM_LEVEL = "aarch64"
MAKES_ARM = ("x86_64-unknown-linux-gnu",)  # its clocks are those that ARM's code calls


# Of this system, and Windows' one under wine, which takes paths of Linux but no PYTHONPATH.
SCRIPTS = Path(__file__).parents[1]
WINDOWS = SCRIPTS.parent / ".venv-windows"
BEGIN = (
    "import sys; sys.path.insert(0, sys.argv[1]);"
    "from releases.machine_code import write_level; write_level(sys.argv[2])"
)


def write_all(folder: Path) -> list[Path]:
    """Write the files of all levels into a folder; return them."""
    folder.mkdir(parents=True, exist_ok=True)
    pythons: list[tuple[list[str], dict[str, str]]] = [([sys.executable], {})]
    if (WINDOWS / "stamp").is_file():
        of_wine = {"WINEPREFIX": str(WINDOWS / "prefix"), "WINEDEBUG": "-all"}
        pythons.append((["wine", str(WINDOWS / "python" / "python.exe")], of_wine))
    for python, more in pythons:
        for level in levels.levels():
            subprocess.run(  # noqa: S603 - this module
                [*python, "-c", BEGIN, str(SCRIPTS), str(folder.absolute())],
                env={**os.environ, **more, levels.VARIABLE: level},
                check=True,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
            )
    return sorted(folder.glob("*.code"))


def write_level(into: str) -> None:
    """Write the files of the level that this process compiles for; of Linux's lowest, ARM's too."""
    folder = Path(into)
    warm_up()
    for what in (machine_code.PLAYING, *MORE):
        made = machine_code.file_in(cache_folder(), what)
        payload = read_checksummed(made)
        if payload is None:
            raise SystemExit(f"{levels.level()}: nothing was compiled")
        head, _, body = payload.partition(b"\n")
        functions = json.loads(head)["functions"]
        system = (levels.triple(), levels.level())
        _write(folder / made.name, system, what, functions, body)
        if levels.level() == levels.lowest() and levels.triple() in MAKES_ARM:
            natives = functions_beside(MORE[what]) if what in MORE else all_functions()
            code = compiled(natives, ARM)
            # All are in the object of the first.
            sizes = [len(code), *[0] * (len(natives) - 1)]
            functions = [
                [function.name, function.name, size]
                for function, size in zip(natives, sizes, strict=True)
            ]
            name = made.name.replace(f"{system[0]}-{system[1]}", f"{ARM.triple}-{ARM_LEVEL}")
            body = zlib.compress(code, 9)
            _write(folder / name, (ARM.triple, ARM_LEVEL), what, functions, body)


def _write(
    path: Path, system: tuple[str, str], what: str, functions: list[list[object]], body: bytes
) -> None:
    about = [*system, source_hash(what, is_shipped=True)]
    head = {"format": machine_code.FORMAT, "made for": about, "functions": functions}
    write_checksummed(path, json.dumps(head).encode() + b"\n" + body)
