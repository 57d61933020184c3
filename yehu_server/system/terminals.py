"""What somebody types in a terminal: words that it completes, and those that need quotes."""

import shlex
import subprocess
import sys
from collections.abc import Callable


def quoted(word: str) -> str:
    """A word as one types it, in quotes where it needs them."""
    return subprocess.list2cmdline([word]) if sys.platform == "win32" else shlex.quote(word)


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
