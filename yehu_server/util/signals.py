"""Handle the signals that end a process."""

from __future__ import annotations

import signal
from collections.abc import Callable


def on_termination(handler: Callable[..., object]) -> None:
    """Call a function at SIGTERM, and at SIGHUP where that is not ignored.

    Under ``nohup`` it is ignored: the process goes on when its terminal is closed.
    """
    signal.signal(signal.SIGTERM, handler)
    hang_up = getattr(signal, "SIGHUP", None)  # not on Windows
    if hang_up is not None and signal.getsignal(hang_up) is not signal.SIG_IGN:
        signal.signal(hang_up, handler)
