"""How a terminal completes words as somebody types."""

import sys
from collections.abc import Callable


def complete_by(complete: Callable[[str, int], str | None]) -> None:
    """Complete words at Tab, where the system's Python can: ``readline.set_completer``."""
    if sys.platform == "win32":
        return
    try:
        import readline
    except ImportError:  # Python was built without it
        return
    readline.set_completer(complete)
    readline.set_completer_delims(" ")
    readline.parse_and_bind("tab: complete")
