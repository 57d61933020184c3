"""Play live: by an audio device, or by a silent clock while there is none.

Exactly one of them computes samples at any time. When the device is lost, the clock continues at
the same frame within some hundredths of a second, and a new process searches for the device
until it is back.
"""

import contextlib
import logging
import queue
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.rig import memory_bytes
from yehu_server.errors import DeviceError
from yehu_server.live.audio.devices import NULL, OUTPUT
from yehu_server.system.clocks import NS, monotonic_ns
from yehu_server.system.memory import SharedMemory
from yehu_server.util.files import error_reason
from yehu_server.util.processes import Child, Message
from yehu_server.util.retry import SHORTAGES, AwakeTime, Backoff, run_forever

log = logging.getLogger(__name__)

NULL_RATE = 48000.0
ANSWER_WITHIN_S, COMPILING_S = 10.0, 300.0
HUNG_AFTER_S = 2.0
LISTEN_S = 0.2  # to wait at a time for events of the device's process; within LONGEST_GAP_S
AGAIN_AFTER_S, AGAIN_AFTER_AT_MOST_S = 1.0, 30.0
LONGEST_LAG_S = 0.5  # beyond it, the silent clock does not catch up


def shared_memory(parts: int = 1) -> SharedMemory:
    """Memory for instruments and their stage; raises DeviceError where there is not so much."""
    size = memory_bytes(parts)
    try:
        return SharedMemory(size)
    except OSError as error:  # such as a limit on files, which holds for memory too
        raise DeviceError(
            f"no memory of {size / 1e6:.0f} MB for instruments: {error_reason(error)}"
        ) from error


class SilentClock:
    """Computes the samples in real time, without a device."""

    def __init__(self, ensemble: Ensemble, blocksize: int) -> None:
        self._ensemble = ensemble
        self._block = np.zeros((blocksize, ensemble.channels), np.float32)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._run, name="silent clock", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Stop; when this returns, nothing is computed any more."""
        self._ending.set()
        self._thread.join()

    def _run(self) -> None:
        period_ns = NS * len(self._block) / self._ensemble.rate
        due_ns = float(monotonic_ns())  # as time.monotonic has steps of 16 ms on Windows
        while not self._ending.is_set():
            with contextlib.suppress(MemoryError):
                self._ensemble.process(self._block)
            due_ns += period_ns
            early_s = (due_ns - monotonic_ns()) / NS
            if early_s > 0.0:
                time.sleep(early_s)
            elif early_s < -LONGEST_LAG_S:
                due_ns = monotonic_ns()


@dataclass
class OutputOptions:
    """The device and how to open it; see ``yehu-server serve --help``."""

    device: str | None = None  # None: the system's default
    rate: float | None = None  # None: the device's own
    blocksize: int = 128
    latency: str | float = "low"  # or seconds
    channels: int = 2
    parts: int = 1  # number of instruments that play together


@dataclass
class OutputState:
    """The device that plays now, or why none does."""

    device: str | None = None  # None: the silent clock
    latency_ms: float = 0.0
    losses: int = 0
    problem: str = ""  # why there is no device


class Output:
    """Plays an ensemble on a device, which it searches for from its construction on.

    Call `find`, make the ensemble with that rate in ``memory``, then call `begin`, and at last
    `end`. `changed` is called, from another thread, with a line when the device plays, disappears,
    or is back.
    """

    def __init__(self, options: OutputOptions, changed: Callable[[str], None]) -> None:
        self._options = options
        self._changed = changed
        self.memory = shared_memory(options.parts)
        self.state = OutputState()
        self._events: queue.Queue[Message] = queue.Queue()
        self._child: Child | None = None
        self._found: Message | None = None
        self._clock: SilentClock | None = None
        self._ensemble: Ensemble | None = None
        self._ending = threading.Event()
        turns = (self._turn, self._ending, 0.0, "audio", changed)
        self._thread = threading.Thread(target=run_forever, args=turns, name="audio", daemon=True)
        self._awake = AwakeTime()
        self._last_callback = (0, 0.0)  # its number, and its awake time
        self._refusals = Backoff(AGAIN_AFTER_S, AGAIN_AFTER_AT_MOST_S)  # the device refuses
        self._shortages = Backoff()  # files or memory for a process are short
        self._search_at = 0.0  # monotonic s
        if options.device != NULL:
            self._search()

    def find(self) -> float:
        """Wait for the device; return the rate (Hz). Raises DeviceError: a named one is missing."""
        rate = self._options.rate or NULL_RATE
        if self._options.device == NULL:
            self.state.problem = "asked for silence"
        if self._child is None:
            return rate
        event = self._await({"found", "missing", "failed", "gone"}, "the sound system")
        if event["event"] == "found":
            self._found = event
            return self._options.rate or float(event["rate"])
        self.state.problem = event.get("reason", "the sound system crashed")
        if self._options.device is not None:
            self._drop_child()
            raise DeviceError(self.state.problem)
        return rate

    def begin(self, ensemble: Ensemble) -> None:
        """Start to play an ensemble in ``memory``; raises DeviceError if a named device fails."""
        self._ensemble = ensemble
        self._start_clock()
        if self._found is not None:
            reason = self._hand_over(self._found)
            if reason and self._options.device is not None:
                self.end()
                raise DeviceError(reason)
            if reason:
                self._give_up(reason, self._refusals)
        if self._options.device != NULL:
            self._thread.start()

    def end(self) -> None:
        """Stop playing."""
        self._ending.set()
        self._events.put({"event": ""})  # to wake the thread
        if self._thread.is_alive():
            self._thread.join()
        self._drop_child(gently=True)
        self._stop_clock()
        self.memory.close()

    # -- the device's process ----------------------------------------------------------------

    def _search(self) -> None:
        """Start a new process that searches for the device."""
        self._events = queue.Queue()
        try:
            self._child = Child(
                "yehu_server.live.audio.stream", self._events.put, share=self.memory.inherited
            )
        except SHORTAGES as error:
            self._give_up(
                f"the audio process cannot be started: {error_reason(error)}", self._shortages
            )
            return
        self._child.send("search", kind=OUTPUT, device=self._options.device)

    def _hand_over(self, found: Message) -> str:
        """Hand the ensemble over from the clock to a device; return why that failed."""
        ensemble = self._ensemble
        if self._child is None or ensemble is None:
            return self._reason({})
        channels = min(self._options.channels, found["channels"])
        self._child.send(
            "open",
            kind=OUTPUT,
            memory=self.memory.handle,
            rate=ensemble.rate,
            blocksize=self._options.blocksize,
            latency=self._options.latency,
            channels=channels,
        )
        ready = self._await({"ready", "failed", "gone"}, "the audio device")
        if ready["event"] != "ready":
            return self._reason(ready)
        self._stop_clock()
        ensemble.channels = channels
        self._child.send("start")
        started = self._await({"started", "failed", "gone"}, "the audio device")
        if started["event"] != "started":
            self._drop_child()
            ensemble.recover()
            self._start_clock()
            return self._reason(started)
        self._refusals.worked()
        self._shortages.worked()
        self._last_callback = (-1, 0.0)
        self.state = OutputState(found["name"], ready["latency_ms"], self.state.losses)
        self._changed(f"playing on {found['name']} at {ensemble.rate:g} Hz")
        return ""

    @staticmethod
    def _reason(event: Message) -> str:
        return str(event.get("reason", "the audio process ended"))

    def _give_up(self, reason: str, backoff: Backoff) -> None:
        """Stop searching for the device for a while, longer each time."""
        self._drop_child()
        self._search_at = time.monotonic() + backoff.failed()
        if reason != self.state.problem:
            self.state.problem = reason
            self._changed(f"no sound: {reason}")

    def _await(self, kinds: set[str], what: str) -> Message:
        """The next event of some kinds; without one in time, as if the process had ended."""
        deadline = self._awake() + ANSWER_WITHIN_S
        while not self._ending.is_set():
            try:
                event = self._events.get(timeout=LISTEN_S)
            except queue.Empty:
                if self._awake() < deadline:
                    continue
                return {"event": "gone", "reason": f"{what} does not answer"}
            if event["event"] in kinds:
                return event
            if event["event"] == "compiling":
                deadline = self._awake() + COMPILING_S
                self._changed("compiling for the audio process, since nothing can be cached")
        return {"event": "gone"}

    def _drop_child(self, *, gently: bool = False) -> None:
        child, self._child = self._child, None
        self._events = queue.Queue()  # its last events are ignored
        if child is not None:
            child.stop() if gently else child.kill()

    def _turn(self) -> None:
        """Handle an event of the device's process, or its silence."""
        if self.state.device is None and self._clock is None:  # the last call has failed
            self._return_to_clock()
        try:
            event = self._events.get(timeout=LISTEN_S)
        except queue.Empty:
            event = {"event": ""}
        if event["event"] == "found":
            reason = self._hand_over(event)
            if reason:
                self._give_up(reason, self._refusals)
        elif event["event"] in ("lost", "gone", "failed") or self._has_stopped():
            self._handle_loss(self._reason(event))
        is_time = self._child is None and time.monotonic() >= self._search_at
        if is_time and not self._ending.is_set():
            self._search()

    def _has_stopped(self) -> bool:
        """Whether the callbacks have stopped, in time in which this process was awake."""
        meters = {"callbacks": 0} if self._ensemble is None else self._ensemble.meters()
        count, now = int(meters["callbacks"]), self._awake()
        if count != self._last_callback[0] or self.state.device is None:
            self._last_callback = count, now
        return now - self._last_callback[1] > HUNG_AFTER_S

    def _handle_loss(self, reason: str) -> None:
        """Continue on the silent clock, once the device's process is gone."""
        device = self.state.device
        if device is None:
            self._give_up(reason, self._refusals)
            return
        problem = f"{device} is gone"
        self.state = OutputState(losses=self.state.losses + 1, problem=problem)
        self._return_to_clock()
        self._changed(f"{problem}; on the silent clock until it is back")

    def _return_to_clock(self) -> None:
        self._drop_child()
        if self._ensemble is not None:
            self._ensemble.recover()
        self._start_clock()

    # -- the silent clock ----------------------------------------------------------------------

    def _start_clock(self) -> None:
        if self._clock is None and self._ensemble is not None:
            self._clock = SilentClock(self._ensemble, self._options.blocksize)

    def _stop_clock(self) -> None:
        clock, self._clock = self._clock, None
        if clock is not None:
            clock.stop()
