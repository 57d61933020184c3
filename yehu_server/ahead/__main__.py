"""Build in a process that compiles for the processor wanted; see ``build.build``."""

from __future__ import annotations

import sys
from pathlib import Path

from yehu_server.ahead.build import build_here
from yehu_server.errors import YehuError

if __name__ == "__main__":
    try:
        what, folder, cpu, *rates = sys.argv[1:]
        for path in build_here(what, Path(folder), cpu, [float(rate) for rate in rates]):
            sys.stdout.write(f"{path}\n")
    except YehuError as error:
        sys.exit(str(error))
