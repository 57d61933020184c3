"""What a server does beside playing, some times a second, in a thread of its own.

The delay follows the device's period, the capture is written, mappings are read again, and what
goes wrong is told.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence

from yehu_server.control.mapping_follower import MappingFollower
from yehu_server.control.troubles import Troubles
from yehu_server.engine.ensemble import Ensemble
from yehu_server.lasting import keep_on
from yehu_server.playing.delay import Delay
from yehu_server.playing.live import LivePlayer
from yehu_server.score.live_capture import LiveCapture

KEEP_EVERY_S = 0.05
PROGRAMS_EVERY_S = 1.0  # between looks whether files of presets changed


class Keeper:
    """Keeps a server's delay, capture, mappings and programs up to date, from `start` to `stop`.

    Parameters
    ----------
    osc_drops : callable
        Returns the number of OSC packets that the system dropped.
    said : callable
        Called with a line for the player.

    Attributes
    ----------
    capture : LiveCapture, optional
        What the session is written into; set before `start`.
    """

    def __init__(
        self,
        ensemble: Ensemble,
        players: Sequence[LivePlayer],
        delay: Delay,
        followers: Sequence[MappingFollower],
        osc_drops: Callable[[], int],
        said: Callable[[str], None],
    ) -> None:
        self.capture: LiveCapture | None = None
        self._ensemble = ensemble
        self._players = players
        self._delay = delay
        self._followers = followers
        self._osc_drops = osc_drops
        self._troubles = Troubles(said)
        self._ending = threading.Event()
        self._next_programs = 0.0  # monotonic s
        keep = (self._keep_up, self._ending, KEEP_EVERY_S, "beside playing", said)
        self._thread = threading.Thread(target=keep_on, args=keep, name="keeper", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    @property
    def is_ended(self) -> bool:
        """Whether `stop` was called."""
        return self._ending.is_set()

    def stop(self) -> None:
        """End the thread, and close the capture."""
        self._ending.set()
        self._thread.join()
        if self.capture is not None:
            self.capture.close()

    @property
    def kept_all(self) -> bool:
        """Whether nothing is missing in the capture."""
        return self.capture is None or self.capture.is_whole

    def _keep_up(self) -> None:
        self._delay.look()
        for player in self._players:
            player.delay = self._delay.frames  # as the device's period requires
        if self.capture is not None:
            self.capture.keep_up()
        self._troubles.look(
            {
                "the model lost its state and was put back to rest": self._ensemble.lost_states,
                "events were dropped, as the ring was full": sum(
                    instrument.dropped_events for instrument in self._ensemble.instruments
                ),
                "OSC packets were dropped by the system": self._osc_drops(),
            }
        )
        for follower in self._followers:
            follower.look()
        if time.monotonic() > self._next_programs:
            self._next_programs = time.monotonic() + PROGRAMS_EVERY_S
            for player in self._players:
                player.know_programs()
