"""Print results and warnings of commands, a safe line at a time."""

from __future__ import annotations

import sys

from yehu_server.lines import one_line


def tell(text: str, *, flush: bool = False) -> None:
    """Print a result."""
    for line in text.split("\n"):
        print(one_line(line), flush=flush)


def warn(text: str) -> None:
    """Print a warning or an error on one line."""
    print(f"yehu-server: {one_line(text)}", file=sys.stderr)
