"""MIDI learn: detect which source the user moves, so that it can be bound."""

from __future__ import annotations

from dataclasses import dataclass, field

import mido

from yehu_server.midi.messages import DATA_ENTRY, NRPN_FINE, RPN_FINE
from yehu_server.midi.messages import NRPN_COARSE as NRPN
from yehu_server.midi.messages import RPN_COARSE as RPN
from yehu_server.playing import sources
from yehu_server.playing.sources import COARSE, FINE_ABOVE, RESERVED, STEPS

# How far a source has to move, 0 to 1: pedals and breath sensors are noisy at rest.
DISTANCE = 1.0 / 16.0
AT_REST = {sources.BEND: 0.5, sources.PRESSURE: 0.0, sources.POLY_PRESSURE: 0.0}


@dataclass(frozen=True)
class Found:
    """A source that was moved; of an OSC address also the range of its values."""

    source: str
    input_range: tuple[float, float] = (0.0, 1.0)


@dataclass
class _Channel:
    """The control changes received on one channel."""

    before: int | None = None  # the control change before
    nrpn: list[int | None] = field(default_factory=lambda: [None, None])


class Learner:
    """Compares each source with where it began, until one has moved far enough to be meant."""

    def __init__(self) -> None:
        self._began_at: dict[tuple[int, str], float] = {}
        self._channels: dict[int, _Channel] = {}
        self._pairs: set[tuple[int, int]] = set()  # channel, coarse half

    def hear(self, message: mido.Message, port: int = 0) -> Found | None:
        """Receive a MIDI message; return the source, once one has moved far enough."""
        if not hasattr(message, "channel"):
            return None
        channel = sources.CHANNELS * port + message.channel
        if message.type == "pitchwheel":
            return self._moved(channel, sources.BEND, (message.pitch + 8192) / 16383.0)
        if message.type == "aftertouch":
            return self._moved(channel, sources.PRESSURE, message.value / STEPS)
        if message.type == "polytouch":
            return self._moved(channel, sources.POLY_PRESSURE, message.value / STEPS)
        if message.type == "control_change":
            return self._control(channel, message.control, message.value)
        return None

    def hear_address(self, address: str, argument: float) -> Found | None:
        """Receive a number at an OSC address of the user's own; return as `hear` does."""
        input_range = (0.0, 1.0) if 0.0 <= argument <= 1.0 else (0.0, float(STEPS))
        found = self._moved(-1, address, argument / input_range[1])
        return Found(found.source, input_range) if found else None

    def _control(self, channel: int, control: int, value: int) -> Found | None:
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
            return Found(sources.pair(control))
        return found

    def _moved(self, channel: int, source: str, position: float) -> Found | None:
        began = self._began_at.setdefault((channel, source), AT_REST.get(source, position))
        return Found(source) if abs(position - began) >= DISTANCE else None
