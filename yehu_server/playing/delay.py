"""The delay from arrival of a message to its sound, constant so that messages keep their rhythm."""

import math
from collections import deque
from collections.abc import Callable

from yehu_server.core.engine.instrument import Instrument

# Time in which Python acts on a message, beside the device's buffer. With half of it five times as
# many events were late beside a busy thread (bench/results/reliability.md).
HANDLING_MS = 1.0
# Ordinary jitter of the device's callbacks.
LEEWAY_MS = 0.5
HELD_WINDOWS = 50  # of telemetry.AHEAD_WINDOW_S, before the delay becomes shorter
PERIOD_WINDOWS = 10  # as a busy system may split one request of the device in two


class Delay:
    """Measures how far ahead of playback the device requests blocks, and sets the delay by it.

    A sound server whose period is several blocks requests all of them in a row, then nothing
    until the next period: a message that arrives meanwhile can sound only after those blocks.
    The delay is in whole blocks, so that it changes only with the device's period.

    `block`: frames of one callback.
    `fixed_ms`: use this delay, whatever the device does.
    """

    def __init__(self, instrument: Instrument, block: int, fixed_ms: float | None = None) -> None:
        self._instrument = instrument
        self._block = block
        self._fixed_ms = fixed_ms
        self._window = 0
        self._last = (1, block)
        self._blocks = deque([1], HELD_WINDOWS)
        self._periods = deque([block], PERIOD_WINDOWS)

    @property
    def period(self) -> int:
        """Largest number of frames that the device requests at once."""
        return max(self._periods)

    @property
    def frames(self) -> int:
        """The delay, in frames."""
        if self._fixed_ms is not None:
            return self._instrument.frames(self._fixed_ms)
        return max(self._blocks) * self._block + self._instrument.frames(HANDLING_MS)

    def update(self) -> None:
        """Read the meters of the audio side; to be called twice in an ``AHEAD_WINDOW_S``.

        The lesser of two windows in a row counts: a single one may show a delay of the system.
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


class Arrivals:
    """Assigns frames to the messages of one source, in the order of their arrival.

    Small corrections of the clock must not swap messages that arrive close together.

    `frame_at`: returns the frame for a `clocks.monotonic_ns`, such as `Player.frame_of`.
    `rate` (Hz).
    """

    def __init__(self, frame_at: Callable[[int], int], rate: float) -> None:
        self._frame_at = frame_at
        self._rate = rate
        self._latest = 0

    def frame_of(self, arrived_ns: int) -> int:
        """The frame for a message that arrived then."""
        frame = self._frame_at(arrived_ns)
        if self._latest - frame > self._rate:  # no small correction of the clock
            self._latest = frame
        self._latest = max(self._latest, frame)
        return self._latest
