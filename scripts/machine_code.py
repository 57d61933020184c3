"""Writes the machine code that releases bring, so that their first start compiles nothing.

    .venv/bin/python scripts/machine_code.py [LEVEL ...]

For systems of this kind, numba as installed here, and the sources as they are. Run it before a
wheel is built. Takes two minutes for the first level of processors, less than one for each other.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from yehu_server.compile import machine_code
from yehu_server.util.sealed import read_sealed, write_sealed

COMPILE = """
from yehu_server.compile import machine_code
from yehu_server.compile.cache_folder import cache_folder
from yehu_server.lab.warming import warm_up
warm_up()
print(machine_code.processor()[0])
for what in (machine_code.PLAYING, machine_code.LAB):
    print(machine_code.file_in(cache_folder(), what))
"""
# numba's order of things follows Python's hashes; and no feature of this processor is wanted.
SETTINGS = {"PYTHONHASHSEED": "0", "NUMBA_CPU_FEATURES": ""}


def write(level: str, folder: Path, cache: Path) -> list[Path]:
    """Compile all for a level of processors, and write its files; return where.

    `cache` (Path): a folder for compiled code, empty or used for other levels only.
    """
    settings = {**SETTINGS, "NUMBA_CPU_NAME": level, "NUMBA_CACHE_DIR": str(cache)}
    told = subprocess.run(  # noqa: S603 - our own
        [sys.executable, "-c", COMPILE],
        env={**os.environ, **settings},
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    ).stdout
    system, *made = told.splitlines()
    payloads = [read_sealed(Path(path)) for path in made]
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for what, payload in zip((machine_code.PLAYING, machine_code.LAB), payloads, strict=True):
        if payload is None:
            raise SystemExit(f"{level}: nothing was compiled")
        paths.append(folder / f"{system}-{level}{what}.code")
        write_sealed(paths[-1], payload)
    return paths


def main() -> None:
    """Write the files of all levels, or of those that are named."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    levels = list(machine_code.levels())
    parser.add_argument("levels", metavar="LEVEL", nargs="*", choices=[*levels, []])
    parser.add_argument("-o", metavar="FOLDER", type=Path, default=machine_code.SHIPPED)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as cache:
        for level in arguments.levels or levels:
            for path in write(level, arguments.o, Path(cache)):
                print(f"{path}: {path.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
