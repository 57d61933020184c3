"""Write the generated modules of the page: ``python -m yehu_server.live.page web``."""

from __future__ import annotations

import sys
from pathlib import Path

from yehu_server.live.page.facts import write


def main() -> None:
    """Write them into the folder that the one argument names."""
    if len(sys.argv) != 2:
        raise SystemExit("usage: python -m yehu_server.live.page FOLDER")
    write(Path(sys.argv[1]))


if __name__ == "__main__":
    main()
