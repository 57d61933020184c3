"""What a server does beside playing, some times a second, in a thread of its own.

The delay follows the device's period, the capture is written, mappings are read again, and what
goes wrong is reported.
"""

import contextlib
import math
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.errors import MappingError
from yehu_server.playing.delay import Delay
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.player import Player
from yehu_server.scores.capture_writer import LiveCapture
from yehu_server.util.retry import run_forever

# Modification time, size and inode of each file; None where there is no file.
Marks = dict[Path, tuple[int, int, int] | None]


class MappingWatch:
    """Polls the files of a mapping.

    A change counts once the files were the same at two polls in a row, so that none is read half
    written. `read` reads the mapping again; raises MappingError where it is wrong.
    """

    def __init__(self, mapping: Mapping, read: Callable[[], Mapping]) -> None:
        self._mapping = mapping
        self._read = read
        self._known = self._seen = _marks(mapping.files)
        self._refused: str | None = None

    def poll(self) -> Mapping | None:
        """Poll the files; return the mapping if it has changed.

        A wrong mapping is read again at each poll, as the cause may lie in a file not known yet.
        Raises MappingError where it is wrong; once for each reason.
        """
        before, self._seen = self._seen, _marks(self._mapping.files)
        if self._seen != before or (self._seen == self._known and self._refused is None):
            return None
        self._known = self._seen
        try:
            changed = self._read()
        except MappingError as error:
            if str(error) == self._refused:
                return None
            self._refused = str(error)
            raise
        was, self._mapping, self._refused = self._mapping, changed, None
        self._known = self._seen = _marks(changed.files)
        return None if changed == was else changed


def _marks(files: tuple[Path, ...]) -> Marks:
    found: Marks = dict.fromkeys(files)
    for file in files:
        with contextlib.suppress(OSError):
            status = file.stat()
            found[file] = status.st_mtime_ns, status.st_size, status.st_ino
    return found


REPORT_EVERY_S, UNDER_RUNS_EVERY_S = 10.0, 60.0
POLL_EVERY_S = 0.5  # of files of mappings and presets, and of counters
TURN_EVERY_S = 0.05


class CounterReport:
    """Reports counts that grow, by a line for `on_message`: each at once and then in periods."""

    def __init__(self, on_message: Callable[[str], None]) -> None:
        self._on_message = on_message
        self._reported: dict[str, tuple[int, float]] = {}  # the last count, and when

    def report(self, what: str, count: int, every_s: float = REPORT_EVERY_S) -> None:
        """Report a count if it has grown, at most once in `every_s`; `what` is counted."""
        before, at = self._reported.get(what, (0, -math.inf))
        now = time.monotonic()
        if count > before and now >= at + every_s:
            self._reported[what] = count, now
            self._on_message(f"{what} ({count} so far)")


class Housekeeper:
    """Keeps a server's delay, capture, mappings and programs up to date, from `start` to `stop`.

    `watches`: of players whose mapping's files are watched.
    `on_remap`: called when a player has got a new mapping.
    `osc_drops`: returns the number of OSC packets that the system dropped.
    `on_message`: called with a line for the player.

    `capture`: what the session is written into; set before `start`.
    """

    def __init__(
        self,
        ensemble: Ensemble,
        players: Sequence[Player],
        delay: Delay,
        watches: Sequence[tuple[Player, MappingWatch]],
        on_remap: Callable[[], None],
        osc_drops: Callable[[], int],
        on_message: Callable[[str], None],
    ) -> None:
        self.capture: LiveCapture | None = None
        self._ensemble = ensemble
        self._players = players
        self._delay = delay
        self._watches = watches
        self._on_remap, self._on_message = on_remap, on_message
        self._osc_drops = osc_drops
        self._counters = CounterReport(on_message)
        self._named_mpe = False
        self._began = time.monotonic()
        self._ending = threading.Event()
        self._next_poll = 0.0  # monotonic s
        turns = (self._turn, self._ending, TURN_EVERY_S, "beside playing", on_message)
        self._thread = threading.Thread(None, run_forever, "housekeeper", turns, daemon=True)

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
        meters = self._ensemble.first.meters()
        under_runs, missed = int(meters["underruns"]), int(meters["missed"])
        if under_runs or missed:
            counts = f"under-runs: {under_runs}, missed deadlines: {missed}"
            self._on_message(f"{counts}, in {time.monotonic() - self._began:.0f} s")
        if self.capture is not None:
            self.capture.close()

    @property
    def is_whole(self) -> bool:
        """Whether nothing is missing in the capture."""
        return self.capture is None or self.capture.is_whole

    def _turn(self) -> None:
        self._delay.update()
        for player in self._players:
            player.instrument.delay = self._delay.frames  # as the device's period requires
            player.finish_remap()
        if self.capture is not None:
            self.capture.keep_up()
        if time.monotonic() > self._next_poll:
            self._next_poll = time.monotonic() + POLL_EVERY_S
            self._report_counts()
            for player, watch in self._watches:
                self._follow(player, watch)
            for player in self._players:
                player.know_programs()

    def _report_counts(self) -> None:
        ensemble, report = self._ensemble, self._counters.report
        dropped = sum(instrument.dropped_events for instrument in ensemble.instruments)
        under_runs = int(ensemble.first.meters()["underruns"])
        report("the model lost its state and was put back to rest", ensemble.lost_states)
        report("events were dropped, as the ring was full or their time too far ahead", dropped)
        report("OSC packets were dropped by the system", self._osc_drops())
        report(
            "under-runs: the sound had gaps; a larger --blocksize, or --latency high, leaves more "
            "time",
            under_runs,
            UNDER_RUNS_EVERY_S,
        )
        if any(player.seems_mpe for player in self._players) and not self._named_mpe:
            self._named_mpe = True
            self._on_message("MIDI: notes come on several channels; for an MPE controller: --mpe")

    def _follow(self, player: Player, watch: MappingWatch) -> None:
        """Give a player its mapping anew where the files have changed and are right."""
        try:
            mapping = watch.poll()
        except MappingError as error:
            for line in error.lines:
                self._on_message(line)
            self._on_message("the mapping stays as it was")
            return
        if mapping is not None:
            player.remap(mapping, frame=player.frame_of())
            self._on_remap()
            self._on_message(f"the mapping {mapping.name} has changed; it is used from now on")
