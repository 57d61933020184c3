"""What keeps a thread at work through the system's troubles, and through its own sleep.

For want of files, memory or threads anything may fail, for a moment. A thread that ended over
that would be missed for the rest of the session.
"""

from __future__ import annotations

import contextlib
import logging
import os
import threading
import time
from collections.abc import Callable

log = logging.getLogger(__name__)

AGAIN_AFTER_S, AGAIN_AFTER_AT_MOST_S = 0.5, 5.0
LONGEST_TURN_S = 0.25
SHORTAGES = (OSError, MemoryError, RuntimeError)  # of files, of memory, of threads


def why(error: BaseException) -> str:
    """What went wrong, in a few words."""
    if isinstance(error, OSError) and error.errno is not None:
        return os.strerror(error.errno)
    return str(error) or type(error).__name__


class Backoff:
    """Waits longer with each failure in a row, and tells of the first only."""

    def __init__(
        self, first_s: float = AGAIN_AFTER_S, most_s: float = AGAIN_AFTER_AT_MOST_S
    ) -> None:
        self._first_s = self._next_s = first_s
        self._most_s = most_s
        self._told = ""

    def failed(self) -> float:
        """Seconds to wait after a failure."""
        now_s, self._next_s = self._next_s, min(2.0 * self._next_s, self._most_s)
        return now_s

    def is_news(self, reason: str) -> bool:
        """Whether a reason is another one than the last time."""
        is_news, self._told = reason != self._told, reason
        return is_news

    def worked(self) -> None:
        """Begin anew: all is well."""
        self._next_s, self._told = self._first_s, ""


class AwakeTime:
    """Counts the time in which we run.

    A process that is stopped, or whose machine sleeps, hears nothing of others meanwhile; they
    must not be taken for dead. To be asked at least every `LONGEST_TURN_S`: what is longer
    between two questions, we slept.
    """

    def __init__(self) -> None:
        self._asked = time.monotonic()
        self._awake_s = 0.0

    def __call__(self) -> float:
        """Seconds since the first call, or so."""
        now = time.monotonic()
        self._awake_s += min(now - self._asked, LONGEST_TURN_S)
        self._asked = now
        return self._awake_s


def keep_on(
    turn: Callable[[], None],
    ending: threading.Event,
    every_s: float,
    what: str,
    told: Callable[[str], None],
) -> None:
    """Call `turn` every so often until an event; whatever fails is tried again.

    Parameters
    ----------
    what : str
        What is at work, for a line that says why it is not.
    told : callable
        Gets that line, once for each reason in a row.
    """
    backoff = Backoff()
    wait_s = every_s
    while not ending.wait(wait_s):
        try:
            turn()
        except Exception as error:  # whatever it is, the thread is needed
            wait_s = backoff.failed()
            with contextlib.suppress(*SHORTAGES):
                if backoff.is_news(why(error)):
                    log.debug("%s", what, exc_info=True)
                    told(f"{what}: {why(error)}; trying again")
        else:
            backoff.worked()
            wait_s = every_s
