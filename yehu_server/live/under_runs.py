"""Tells of gaps in the sound: at most a line a minute while they happen, and a sum at the end."""

from __future__ import annotations

import time
from collections.abc import Callable

EVERY_S = 60.0
HINT = "a larger --blocksize, or --latency high, leaves more time"


class UnderRunReport:
    """Reports under-runs of the device and missed deadlines.

    Parameters
    ----------
    on_message : callable
        Called with each line.
    """

    def __init__(self, on_message: Callable[[str], None]) -> None:
        self._on_message = on_message
        self._began = time.monotonic()
        self._told_at: float | None = None  # of the last line
        self._told = 0

    def look(self, under_runs: int) -> None:
        """Report under-runs, if there are more: the first at once, then those of each minute."""
        now = time.monotonic()
        is_due = self._told_at is None or now >= self._told_at + EVERY_S
        if under_runs <= self._told or not is_due:
            return
        new = _counted(under_runs - self._told, "under-run")
        since = "" if self._told_at is None else f" in the last {now - self._told_at:.0f} s"
        self._on_message(f"{new}{since}: the sound had gaps ({under_runs} so far); {HINT}")
        self._told_at, self._told = now, under_runs

    def sum_up(self, under_runs: int, missed: int) -> None:
        """Report all at the end, if there were any."""
        if under_runs or missed:
            counts = (
                f"{_counted(under_runs, 'under-run')} and {_counted(missed, 'missed deadline')}"
            )
            self._on_message(f"{counts} in {time.monotonic() - self._began:.0f} s")


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"
