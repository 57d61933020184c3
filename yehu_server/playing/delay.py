"""How long what arrives waits until it is heard, so that it keeps its rhythm."""

from __future__ import annotations

import math
from collections import deque

from yehu_server.engine.instrument import Instrument

# What Python takes to act on a message, on top of what the device plays ahead of its time.
HANDLING_MS = 1.0
# The device's callbacks begin this much early or late as a matter of course.
LEEWAY_MS = 0.5
HELD_WINDOWS = 50  # of telemetry.AHEAD_WINDOW_S, before the delay becomes shorter
TOLD_WINDOWS = 10  # since a system that is held up may tear a request in two


class Delay:
    """Follows how far ahead of its time the device lets us play.

    Sound servers with a period of several blocks ask for all of them in a row, and then for
    nothing until the next period: what arrives meanwhile can be heard only after those blocks.
    Whole blocks are waited for, so that the delay stays the same as long as the device does.

    Parameters
    ----------
    block : int
        Frames of one callback.
    fixed_ms : float, optional
        Wait for this long, whatever the device does.
    """

    def __init__(self, instrument: Instrument, block: int, fixed_ms: float | None = None) -> None:
        self._instrument = instrument
        self._block = block
        self._fixed_ms = fixed_ms
        self._window = 0
        self._last = (1, block)
        self._blocks = deque([1], HELD_WINDOWS)
        self._periods = deque([block], TOLD_WINDOWS)

    @property
    def period(self) -> int:
        """Frames that the device asks for at once, at most."""
        return max(self._periods)

    @property
    def frames(self) -> int:
        """The delay."""
        if self._fixed_ms is not None:
            return self._instrument.frames(self._fixed_ms)
        return max(self._blocks) * self._block + self._instrument.frames(HANDLING_MS)

    def look(self) -> None:
        """Take in what the audio side tells; to be called twice in an ``AHEAD_WINDOW_S``.

        What only one window shows is an accident: the system held us up, and we caught up.
        """
        meters = self._instrument.meters()
        if meters["ahead_window"] == self._window:
            return
        self._window = int(meters["ahead_window"])
        ahead = float(meters["ahead"]) - self._instrument.frames(LEEWAY_MS)
        now = max(1, math.ceil(ahead / self._block)), int(meters["longest"])
        self._blocks.append(min(now[0], self._last[0]))
        self._periods.append(max(self._block, min(now[1], self._last[1])))
        self._last = now
