"""Keep background threads running through temporary failures, and measure time without sleep.

When files, memory or threads run short, anything may fail for a moment. A thread that ended then
would be missing for the rest of the session.
"""

import contextlib
import logging
import threading
import time
from collections.abc import Callable

from yehu_server.util.files import error_reason

log = logging.getLogger(__name__)

FIRST_RETRY_S, LONGEST_RETRY_S = 0.5, 5.0
LONGEST_GAP_S = 0.25
SHORTAGES = (OSError, MemoryError, RuntimeError)  # of files, of memory, of threads


class Backoff:
    """Exponential backoff: a longer wait after each failure in a row, and one report for all."""

    def __init__(self, first_s: float = FIRST_RETRY_S, most_s: float = LONGEST_RETRY_S) -> None:
        self._first_s = self._next_s = first_s
        self._most_s = most_s
        self._reported = ""

    def failed(self) -> float:
        """Record a failure; return the seconds to wait."""
        now_s, self._next_s = self._next_s, min(2.0 * self._next_s, self._most_s)
        return now_s

    def is_news(self, reason: str) -> bool:
        """Whether a reason differs from the last one."""
        is_news, self._reported = reason != self._reported, reason
        return is_news

    def worked(self) -> None:
        """Record a success, after which the wait is short again."""
        self._next_s, self._reported = self._first_s, ""


class AwakeTime:
    """A clock that stands still while the process is stopped or the machine sleeps.

    Peers that could not be heard meanwhile must not be taken for dead. It must be called at
    least every `LONGEST_GAP_S`: longer gaps count as sleep.
    """

    def __init__(self) -> None:
        self._last_call = time.monotonic()
        self._awake_s = 0.0

    def __call__(self) -> float:
        """Seconds awake since the clock was made."""
        now = time.monotonic()
        self._awake_s += min(now - self._last_call, LONGEST_GAP_S)
        self._last_call = now
        return self._awake_s


def run_forever(
    turn: Callable[[], None],
    ending: threading.Event,
    every_s: float,
    what: str,
    on_error: Callable[[str], None],
) -> None:
    """Call `turn` periodically until an event is set; after an error, try again later.

    `what`: name of the work, for error messages.
    `on_error`: called with an error message, once for equal reasons in a row.
    """
    backoff = Backoff()
    wait_s = every_s
    while not ending.wait(wait_s):
        try:
            turn()
        except Exception as error:  # the thread must go on
            wait_s = backoff.failed()
            with contextlib.suppress(*SHORTAGES):
                if backoff.is_news(error_reason(error)):
                    log.debug("%s", what, exc_info=True)
                    on_error(f"{what}: {error_reason(error)}; trying again")
        else:
            backoff.worked()
            wait_s = every_s
