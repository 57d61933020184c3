"""What MIDI channel messages mean to the player."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field

import mido

from yehu_server.params.spec import Place
from yehu_server.params.table import find
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.performer import Key, Performer

DATA_ENTRY, DATA_ENTRY_FINE, SUSTAIN = 6, 38, 64
INCREMENT, DECREMENT = 96, 97
NRPN_FINE, NRPN, RPN_FINE, RPN = 98, 99, 100, 101
ALL_SOUND_OFF, RESET_CONTROLLERS, ALL_NOTES_OFF = 120, 121, 123
NULL = (127, 127)
BEND_RANGE = (0, 0)
CHANNELS = 16  # of a port
PERCUSSION = 9  # channel 10, counted from 0

# Put back by "reset all controllers"; volume stays, as the recommended practice RP-015 asks.
KEPT_ON_RESET = {"/playing/volume"}


# When something was moved, as a running number, and to where: 0 to 1.
Moved = tuple[int, float]


@dataclass
class Channel:
    """What one MIDI channel remembers."""

    moved: dict[str, Moved] = field(default_factory=dict)  # by source
    touch: dict[float, Moved] = field(default_factory=dict)  # poly pressure, by note
    velocity: dict[float, Moved] = field(default_factory=dict)  # by note
    struck_again: dict[float, int] = field(default_factory=dict)  # held notes, at which frame
    bend_range: float | None = None  # semitones, once RPN 0 has set it
    sustain: bool = False
    let_go: set[Key] = field(default_factory=set)  # keys up, pedal down
    rpn: tuple[int, int] = NULL


class MidiPlayer:
    """Feeds MIDI channel messages to a performer, through a mapping.

    What is moved on a channel belongs to its notes: it is heard while one of them sounds, and
    after it until another channel's note begins.

    Parameters
    ----------
    channels : set of int, optional
        Channels that play, counted from 0; all but the percussion channel by default.
    """

    def __init__(
        self, performer: Performer, mapping: Mapping, channels: set[int] | None = None
    ) -> None:
        self._performer = performer
        performer.expression = self._expression
        self._mapping = mapping
        self._plays = channels if channels is not None else set(range(16)) - {PERCUSSION}
        self._channels: defaultdict[int, Channel] = defaultdict(Channel)
        self._heard: Key | None = None  # whose note sounds, or sounded last
        self._set: dict[str, Moved] = {}  # targets as they were before, or as `write` left them
        self._moves = 0
        self.notes_by_channel: Counter[int] = Counter()

    def receive(self, message: mido.Message, *, frame: int | None = None, port: int = 0) -> None:
        """Act on a channel message, or on a system reset; others are ignored.

        Channels of different ports are different channels.
        """
        if message.type == "reset":
            self._start_anew(frame)
            return
        if not hasattr(message, "channel") or message.channel not in self._plays:
            return
        channel, kind = CHANNELS * port + message.channel, message.type
        if kind == "note_on" and message.velocity > 0:
            self.note_on(Key(channel, message.note), message.velocity / 127.0, frame)
        elif kind in ("note_on", "note_off"):
            self.note_off(Key(channel, message.note), frame)
        elif kind == "pitchwheel":
            bend = max(-1.0, message.pitch / 8191.0)
            self._move("bend", channel, 0.5 * (bend + 1.0), frame)
        elif kind == "aftertouch":
            self._move("pressure", channel, message.value / 127.0, frame)
        elif kind == "polytouch":
            self._channels[channel].touch[message.note] = self._stamped(message.value / 127.0)
            self._follow("poly-pressure", channel, frame)
        elif kind == "control_change":
            self._control(channel, message.control, message.value, frame)

    def write(self, address: str, value: float, *, frame: int | None = None) -> float:
        """Set a parameter for all channels, until a controller moves it; see `Performer.write`."""
        accepted = self._performer.write(address, value, frame=frame)
        if find(address).place is Place.PLAYER:
            self._set[address] = self._stamped(accepted)
        return accepted

    def let_go_of(self, port: int, *, frame: int | None = None) -> None:
        """End the notes of a port that is gone, and forget what was moved on it."""
        for channel in range(CHANNELS * port, CHANNELS * (port + 1)):
            if channel in self._channels:
                self._performer.all_notes_off(frame=frame, channel=channel)
                del self._channels[channel]

    def _start_anew(self, frame: int | None) -> None:
        self._performer.all_notes_off(frame=frame)
        self._channels.clear()
        for address, (_, value) in self._set.items():
            self._performer.write(address, value, frame=frame)

    def note_on(self, key: Key, velocity: float, frame: int | None) -> None:
        """Begin a note, struck with a velocity of 0 to 1."""
        state = self._channels[key.channel]
        if self._performer.holds(key) and key not in state.let_go and frame is not None:
            state.struck_again[key.note] = frame
        state.let_go.discard(key)
        before, touched = state.velocity.get(key.note), state.touch.pop(key.note, None)
        state.velocity[key.note] = self._stamped(velocity)
        self._remember("velocity")
        if self._performer.note_on(key, frame=frame):
            self.notes_by_channel[key.channel] += 1
        else:  # not a note of this instrument: what was heard goes on
            _restore(state.velocity, key.note, before)
            _restore(state.touch, key.note, touched)

    def note_off(self, key: Key, frame: int | None) -> None:
        """End a note, unless the channel's pedal keeps it."""
        state = self._channels[key.channel]
        if frame is not None and state.struck_again.pop(key.note, None) == frame:
            return  # the end of the stroke before, which some files write after the new one
        if state.sustain:
            state.let_go.add(key)
        else:
            self._performer.notes_off([key], frame=frame)

    def _control(self, channel: int, control: int, value: int, frame: int | None) -> None:
        state = self._channels[channel]
        if control == SUSTAIN:
            state.sustain = value >= 64
            if not state.sustain:
                self._performer.notes_off(state.let_go, frame=frame)
                state.let_go.clear()
        elif control == ALL_SOUND_OFF:
            state.let_go.clear()
            self._performer.all_sound_off(frame=frame, channel=channel)
        elif control >= ALL_NOTES_OFF:  # the mode messages 124-127 include it
            if state.sustain:
                state.let_go.update(self._performer.held(channel))
            else:
                self._performer.all_notes_off(frame=frame, channel=channel)
        elif control == RESET_CONTROLLERS:
            self._reset_controllers(channel, frame)
        elif control in (RPN, RPN_FINE):
            state.rpn = (value, state.rpn[1]) if control == RPN else (state.rpn[0], value)
        elif control in (NRPN, NRPN_FINE):
            state.rpn = NULL
        elif control in (DATA_ENTRY, DATA_ENTRY_FINE, INCREMENT, DECREMENT):
            self._data_entry(channel, control, value, frame)
        else:
            self._move(f"cc {control}", channel, value / 127.0, frame)

    def _reset_controllers(self, channel: int, frame: int | None) -> None:
        self._control(channel, SUSTAIN, 0, frame)
        state = self._channels[channel]
        state.rpn = NULL
        state.touch.clear()
        for bind in self._mapping.binds:
            if bind.target not in KEPT_ON_RESET:
                state.moved.pop(bind.source, None)
        for source in dict.fromkeys(bind.source for bind in self._mapping.binds):
            if source != "velocity":
                self._follow(source, channel, frame)

    def _data_entry(self, channel: int, control: int, value: int, frame: int | None) -> None:
        state = self._channels[channel]
        if state.rpn != BEND_RANGE:
            return
        semitones, cents = divmod(round(self._bend_range(state) * 100.0), 100)
        if control == DATA_ENTRY:
            semitones = value
        elif control == DATA_ENTRY_FINE:
            cents = min(value, 99)
        else:
            semitones += 1 if control == INCREMENT else -1
        limits = find("/playing/bend_range")
        state.bend_range = limits.accept(semitones + cents / 100.0)
        self._follow("bend", channel, frame)

    def _bend_range(self, state: Channel) -> float:
        asked = self._performer.value("/playing/bend_range")
        if state.bend_range is None or self._performer.keeps("/playing/bend_range"):
            return asked
        return state.bend_range

    def _move(self, source: str, channel: int, place: float, frame: int | None) -> None:
        self._channels[channel].moved[source] = self._stamped(place)
        self._follow(source, channel, frame)

    def _stamped(self, place: float) -> Moved:
        self._moves += 1
        return self._moves, place

    def _remember(self, source: str) -> None:
        for bind in self._mapping.of(source):
            self._set.setdefault(bind.target, (0, self._performer.value(bind.target)))

    def _follow(self, source: str, channel: int, frame: int | None) -> None:
        """Let the sounding note follow what its channel just did."""
        self._remember(source)
        heard = self._performer.sounding or self._heard
        if heard is None or heard.channel == channel:
            asked = self._asked(channel, heard.note if heard is not None else -1)
            for bind in self._mapping.of(source):
                self._performer.write(bind.target, asked[bind.target], frame=frame)

    def _expression(self, key: Key) -> dict[str, float]:
        """What a note that begins, or comes back, is to have of its channel."""
        self._heard = key
        return self._asked(key.channel, key.note)

    def _asked(self, channel: int, note: float) -> dict[str, float]:
        """Values of all targets that were ever moved, for a note of this channel.

        Of several sources of one target the one moved last counts, a direct write among them;
        where this channel moved none, the target is as it was before any channel did.
        """
        state = self._channels[channel]
        asked = dict(self._set)
        for bind in self._mapping.binds:
            if bind.source == "poly-pressure":
                moved = state.touch.get(note)
            elif bind.source == "velocity":
                moved = state.velocity.get(note)
            else:
                moved = state.moved.get(bind.source)
            if moved is None or moved[0] < asked.get(bind.target, (0, 0.0))[0]:
                continue
            when, place = moved
            value = bind.apply(place)
            if bind.source == "bend" and bind.span is None and bind.target == "/playing/bend":
                value = (2.0 * place - 1.0) * self._bend_range(state)
            asked[bind.target] = (when, value)
        return {address: value for address, (_, value) in asked.items()}


def _restore(moved: dict[float, Moved], note: float, before: Moved | None) -> None:
    if before is None:
        moved.pop(note, None)
    else:
        moved[note] = before
