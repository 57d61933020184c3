"""Writes the machine code that releases bring, so that their first start compiles nothing.

    .venv/bin/python scripts/machine_code.py [LEVEL ...]

For each level of processors of this kind of system (`compile/levels.py`), numba as installed here,
and the sources as they are. Run it before a wheel is built. Takes a minute for the first level, and
less for each other.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from yehu_server.compile import levels, machine_code
from yehu_server.util.checksummed import read_checksummed, write_checksummed

COMPILE = """
from yehu_server.compile import machine_code
from yehu_server.compile.cache_folder import cache_folder
from compile_all import MORE, warm_up
warm_up()
for what in (machine_code.PLAYING, *MORE):
    print(machine_code.file_in(cache_folder(), what))
"""


def write(level: str, folder: Path, cache: Path) -> list[Path]:
    """Compile all for a level of processors, and write its files; return where.

    `cache` (Path): a folder for compiled code, empty or used for other levels only.
    """
    # numba's order of things follows Python's hashes.
    settings = {
        "PYTHONHASHSEED": "0",
        levels.VARIABLE: level,
        "NUMBA_CACHE_DIR": str(cache),
    }
    printed = subprocess.run(  # noqa: S603 - our own
        [sys.executable, "-c", COMPILE],
        env={**os.environ, **settings},
        cwd=Path(__file__).parent,
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    ).stdout
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for made in map(Path, printed.splitlines()):
        payload = read_checksummed(made)
        if payload is None:
            raise SystemExit(f"{level}: nothing was compiled")
        paths.append(folder / made.name)
        write_checksummed(paths[-1], payload)
    return paths


def main() -> None:
    """Write the files of all levels, or of those that are named."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    known = list(levels.levels())
    parser.add_argument("levels", metavar="LEVEL", nargs="*", choices=[*known, []])
    parser.add_argument("-o", metavar="FOLDER", type=Path, default=machine_code.SHIPPED)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as cache:
        for level in arguments.levels or known:
            for path in write(level, arguments.o, Path(cache)):
                print(f"{path}: {path.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
