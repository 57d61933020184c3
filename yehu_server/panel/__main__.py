"""Writes the generated modules of the page into a folder: ``python -m yehu_server.panel web``."""

from __future__ import annotations

import sys
from pathlib import Path

from yehu_server.panel.facts import write


def main() -> None:
    """Write them into the folder that the one argument names."""
    if len(sys.argv) != 2:
        raise SystemExit("usage: python -m yehu_server.panel FOLDER")
    write(Path(sys.argv[1]))


if __name__ == "__main__":
    main()
