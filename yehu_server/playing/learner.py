"""Learn a controller: detect which source the user moves, among MIDI messages and OSC addresses."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import mido

from yehu_server.core.midi.registered_parameters import DATA_ENTRY, NRPN_FINE, RPN_FINE
from yehu_server.core.midi.registered_parameters import NRPN_COARSE as NRPN
from yehu_server.core.midi.registered_parameters import RPN_COARSE as RPN
from yehu_server.playing import sources
from yehu_server.playing.sources import COARSE, FINE_ABOVE, RESERVED, STEPS

# How far a source has to move, 0 to 1: pedals and breath sensors are noisy at rest.
DISTANCE = 1.0 / 16.0
FULL = (1.0, float(STEPS), 255.0, 1023.0, 16383.0)  # where ranges of OSC addresses end
STILL_S = 2.0  # after which what was just learned may be learned again
PRESSURES = {"aftertouch": sources.PRESSURE, "polytouch": sources.POLY_PRESSURE}
AT_REST = {sources.BEND: 0.5, sources.PRESSURE: 0.0, sources.POLY_PRESSURE: 0.0}


@dataclass(frozen=True)
class LearnedSource:
    """A source that was moved; of an OSC address also the range of its values."""

    source: str
    input_range: tuple[float, float] = (0.0, 1.0)
    part: int = 0  # of an address: as of `Bind`

    def __str__(self) -> str:
        """The source, with the range of its values where that is not 0 to 1."""
        lo, hi = self.input_range
        return self.source if (lo, hi) == (0.0, 1.0) else f"{self.source} ({lo:g} to {hi:g})"


@dataclass
class _Channel:
    """The control changes received on one channel."""

    before: int | None = None  # the control change before
    nrpn: list[int | None] = field(default_factory=lambda: [None, None])


class Learner:
    """Compares each source with where it began, until one has moved far enough to be meant.

    `before`: the source that was learned before, and when it moved last (monotonic s). It is
    ignored until it has been still: one sweep of a fader is meant for one parameter.
    """

    def __init__(self, before: tuple[str, float] = ("", 0.0)) -> None:
        self._before, self._moved_s = before
        self._began_at: dict[tuple[int, str], float] = {}
        self._ends: dict[str, tuple[float, float]] = {}  # lowest and highest value, by address
        self._channels: dict[int, _Channel] = {}
        self._pairs: set[tuple[int, int]] = set()  # channel, coarse half

    def hear(self, message: mido.Message, port: int = 0) -> LearnedSource | None:
        """Receive a MIDI message; return the source, once one has moved far enough."""
        if not hasattr(message, "channel"):
            return None
        channel = sources.CHANNELS * port + message.channel
        if message.type == "pitchwheel":
            return self._moved(channel, sources.BEND, (message.pitch + 8192) / 16383.0)
        if message.type in PRESSURES:
            return self._moved(channel, PRESSURES[message.type], message.value / STEPS)
        if message.type == "control_change":
            return self._control(channel, message.control, message.value)
        return None

    def learn_from_address(self, address: str, argument: float) -> LearnedSource | None:
        """Receive a number at an OSC address of the user's own; return as `hear` does.

        Its range ends at the next of FULL beyond its values, and begins as far below 0 where one is
        below 0. A step from 0 to 1 may be the first of 127, so it counts with the value after it: a
        button's 0, or the next of a fader.
        """
        if self._still_moves(address):
            return None
        lowest, highest = self._ends.get(address, (argument, argument))
        lowest, highest = ends = min(lowest, argument), max(highest, argument)
        self._ends[address] = ends
        farthest = max(abs(lowest), abs(highest))
        full = next((end for end in FULL if farthest <= end), farthest)
        least = -full if lowest < 0.0 else 0.0
        if highest - lowest < DISTANCE * (full - least) or (*ends, argument) == (0.0, 1.0, 1.0):
            return None
        return LearnedSource(address, (least, full))

    def _control(self, channel: int, control: int, value: int) -> LearnedSource | None:
        state = self._channels.setdefault(channel, _Channel())
        before, state.before = state.before, control
        if control in (NRPN, NRPN_FINE):
            state.nrpn[control == NRPN_FINE] = value
        elif control in (RPN, RPN_FINE):
            state.nrpn = [None, None]
        elif control == DATA_ENTRY and None not in state.nrpn:
            coarse, fine = (half or 0 for half in state.nrpn)
            number = coarse << 7 | fine
            if number < sources.NO_NRPN:
                return self._moved(channel, sources.nrpn(number), value / STEPS)
        if control in RESERVED:
            return None
        if control - FINE_ABOVE in COARSE:
            if before == control - FINE_ABOVE:
                self._pairs.add((channel, before))
            if (channel, control - FINE_ABOVE) in self._pairs:
                return None  # the fine half of a pair
        found = self._moved(channel, sources.control(control), value / STEPS)
        if found is not None and (channel, control) in self._pairs:
            return LearnedSource(sources.pair(control))
        return found

    def _moved(self, channel: int, source: str, position: float) -> LearnedSource | None:
        if self._still_moves(source):
            return None
        began = self._began_at.setdefault((channel, source), AT_REST.get(source, position))
        return LearnedSource(source) if abs(position - began) >= DISTANCE else None

    def _still_moves(self, source: str) -> bool:
        """Whether a source is the one learned before, and has not been still since."""
        if source != self._before:
            return False
        now = time.monotonic()
        is_still, self._moved_s = now - self._moved_s >= STILL_S, now
        if is_still:
            self._before = ""
        return not is_still


class Learning:
    """Waits for the source that the user moves next; any thread may call."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._learner = Learner()
        self._found: Callable[[LearnedSource], None] | None = None
        self._replaced: Callable[[], None] | None = None
        self._last = ("", 0.0)  # the source learned last, and when
        self.on_change: Callable[[], None] = lambda: None  # called where `waits` changes

    @property
    def waits(self) -> bool:
        """Whether it waits for a source to move."""
        return self._found is not None

    def expects(self, address: str) -> bool:
        """Whether it waits for a source to move, or has just learned this one."""
        source, learned_s = self._last
        return self.waits or (source == address and time.monotonic() - learned_s < STILL_S)

    def listen(
        self,
        found: Callable[[LearnedSource], None] | None,
        replaced: Callable[[], None] | None = None,
    ) -> None:
        """Call `found`, which must not block, once with the source moved next; None: stop.

        `replaced`: called instead where another one listens before that.
        """
        with self._lock:
            before = self._replaced if self.waits and found is not None else None
            self._learner, self._found, self._replaced = Learner(self._last), found, replaced
        if before is not None:
            before()
        self.on_change()

    def hear_address(self, address: str, argument: float) -> None:
        """Receive a number at an OSC address of the user's own."""
        with self._lock:
            source = self._learner.learn_from_address(address, argument)
        self._report(source)

    def hear_message(self, message: mido.Message, port: int) -> None:
        """Receive a MIDI message of a port, counted from 0; it plays elsewhere."""
        with self._lock:
            source = self._learner.hear(message, port)
        self._report(source)

    def _report(self, source: LearnedSource | None) -> None:
        with self._lock:
            found = self._found if source is not None else None
            self._found = None if found is not None else self._found
            if source is not None and found is not None:
                self._last = (sources.controller(source.source), time.monotonic())
        if source is not None and found is not None:
            found(source)
            self.on_change()
