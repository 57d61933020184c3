"""Report what goes wrong while playing, in a limited number of lines."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from functools import partial

from yehu_server.control.allowance import Allowance

LINES_PER_S, LINES_AT_ONCE = 0.1, 1.0  # of each trouble


class Troubles:
    """Reports counts that grow: at once, and then at most every ten seconds.

    Parameters
    ----------
    said : callable
        Called with each line.
    """

    def __init__(self, said: Callable[[str], None]) -> None:
        self._said = said
        self._told: dict[str, int] = {}
        self._allowances: dict[str, Allowance] = defaultdict(
            partial(Allowance, LINES_PER_S, LINES_AT_ONCE)
        )

    def look(self, counts: Mapping[str, int]) -> None:
        """Report counts that have grown since they were last reported.

        Parameters
        ----------
        counts : mapping
            Each by a phrase for what is counted.
        """
        now = time.monotonic()
        for what, count in counts.items():
            if count > self._told.get(what, 0) and self._allowances[what].takes(now):
                self._told[what] = count
                self._said(f"{what} ({count} so far)")
