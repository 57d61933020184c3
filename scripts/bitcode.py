"""Writes the bitcode that releases ship, so that their first start is shorter.

    .venv/bin/python scripts/bitcode.py

For machines of this kind, numba and llvmlite as installed here, and the sources as they are. Run
it before a wheel is built. Of the same all, the file has the same bytes. Takes half a minute.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path

# numba's order of things follows Python's hashes; and what is shipped is for all processors.
SETTINGS = {"PYTHONHASHSEED": "0", "NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}


def main() -> None:
    """Compile everything anew and write the file."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("-o", metavar="FILE", type=Path, help="where to, if not into the package")
    arguments = parser.parse_args()
    if any(os.environ.get(name) != value for name, value in SETTINGS.items()):
        os.execve(sys.executable, [sys.executable, *sys.argv], {**os.environ, **SETTINGS})  # noqa: S606
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as empty:
        os.environ["NUMBA_CACHE_DIR"] = empty
        from yehu_server.compile.bitcode.shipped import shipped_file, write_shipped
        from yehu_server.compile.jit import source_hash
        from yehu_server.core.engine.warming import capture

        shipped = capture()
    path = arguments.o or shipped_file()
    write_shipped(path, shipped, source_hash())
    kilobytes = path.stat().st_size // 1000
    taken = time.monotonic() - begun
    print(f"{path}: {len(shipped.libraries)} libraries, {kilobytes} kB, in {taken:.0f} s")


if __name__ == "__main__":
    main()
