"""Where commands print: the one way of lines to the terminal."""

from __future__ import annotations

import sys

from yehu_server.lines import one_line


def tell(text: str, *, flush: bool = False) -> None:
    """Print a result, line by line."""
    for line in text.split("\n"):
        print(one_line(line), flush=flush)


def warn(text: str) -> None:
    """Print one line of warning or error."""
    print(f"yehu-server: {one_line(text)}", file=sys.stderr)
