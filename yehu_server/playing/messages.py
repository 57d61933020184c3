"""What MIDI channel messages mean to the player."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field

import mido

from yehu_server.params.table import find
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.performer import Key, Performer

DATA_ENTRY, DATA_ENTRY_FINE, SUSTAIN = 6, 38, 64
INCREMENT, DECREMENT = 96, 97
NRPN_FINE, NRPN, RPN_FINE, RPN = 98, 99, 100, 101
ALL_SOUND_OFF, RESET_CONTROLLERS, ALL_NOTES_OFF = 120, 121, 123
NULL = (127, 127)
BEND_RANGE = (0, 0)
PERCUSSION = 9  # channel 10, counted from 0

# Put back by "reset all controllers"; volume stays, as the recommended practice RP-015 asks.
KEPT_ON_RESET = "/playing/volume"


@dataclass
class Channel:
    """What one MIDI channel remembers."""

    bend: float = 0.0  # -1..1
    bend_range: float = find("/playing/bend_range").default  # semitones
    pressure: float = 0.0  # 0..1
    touch: dict[int, float] = field(default_factory=dict)  # poly pressure of notes, 0..1
    velocity: dict[int, float] = field(default_factory=dict)  # of notes, 0..1
    sustain: bool = False
    let_go: set[Key] = field(default_factory=set)  # keys up, pedal down
    rpn: tuple[int, int] = NULL


class MidiPlayer:
    """Feeds MIDI channel messages to a performer, through a mapping.

    Bend, pressure and velocity belong to a channel's notes and are heard while one of them
    sounds; control changes are heard whatever sounds.

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
        self._channels: defaultdict[int, Channel] = defaultdict(
            lambda: Channel(bend_range=performer.value("/playing/bend_range"))
        )
        self._moved: set[str] = set()  # which of bend and pressures have ever been moved
        self.notes_by_channel: Counter[int] = Counter()

    def receive(self, message: mido.Message, *, frame: int | None = None) -> None:
        """Act on one message; others than channel messages are ignored."""
        if not hasattr(message, "channel") or message.channel not in self._plays:
            return
        channel, kind = message.channel, message.type
        state = self._channels[channel]
        if kind == "note_on" and message.velocity > 0:
            self._note_on(Key(channel, message.note), message.velocity / 127.0, frame)
        elif kind in ("note_on", "note_off"):
            self._note_off(Key(channel, message.note), frame)
        elif kind == "pitchwheel":
            state.bend = max(-1.0, message.pitch / 8191.0)
            self._follow("bend", channel, frame)
        elif kind == "aftertouch":
            state.pressure = message.value / 127.0
            self._follow("pressure", channel, frame)
        elif kind == "polytouch":
            state.touch[message.note] = message.value / 127.0
            self._follow("poly-pressure", channel, frame)
        elif kind == "control_change":
            self._control(channel, message.control, message.value, frame)

    def _note_on(self, key: Key, velocity: float, frame: int | None) -> None:
        state = self._channels[key.channel]
        state.let_go.discard(key)
        state.velocity[key.note] = velocity
        state.touch.pop(key.note, None)
        played = self._performer.notes_played
        self._performer.note_on(key, frame=frame)
        if self._performer.notes_played > played:
            self.notes_by_channel[key.channel] += 1

    def _note_off(self, key: Key, frame: int | None) -> None:
        state = self._channels[key.channel]
        if state.sustain:
            state.let_go.add(key)
        else:
            self._performer.note_off(key, frame=frame)

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
            state.let_go.clear()
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
            self._move(f"cc {control}", value / 127.0, frame)

    def _reset_controllers(self, channel: int, frame: int | None) -> None:
        self._control(channel, SUSTAIN, 0, frame)
        state = self._channels[channel]
        state.bend, state.pressure, state.rpn = 0.0, 0.0, NULL
        state.touch.clear()
        self._follow("bend", channel, frame)
        for bind in self._mapping.binds:
            if bind.source.startswith("cc ") and bind.target != KEPT_ON_RESET:
                self._performer.write(bind.target, find(bind.target).default, frame=frame)

    def _data_entry(self, channel: int, control: int, value: int, frame: int | None) -> None:
        state = self._channels[channel]
        if state.rpn != BEND_RANGE:
            return
        semitones, cents = divmod(round(state.bend_range * 100.0), 100)
        if control == DATA_ENTRY:
            semitones = value
        elif control == DATA_ENTRY_FINE:
            cents = min(value, 99)
        else:
            semitones += 1 if control == INCREMENT else -1
        limits = find("/playing/bend_range")
        state.bend_range = limits.accept(semitones + cents / 100.0)
        self._follow("bend", channel, frame)

    def _follow(self, source: str, channel: int, frame: int | None) -> None:
        """Let the sounding note follow what its channel just did."""
        self._moved.add(source)
        sounding = self._performer.sounding
        if sounding is not None and sounding.channel == channel:
            for address, value in self._expression(sounding, struck=False).items():
                self._performer.write(address, value, frame=frame)

    def _expression(self, key: Key, *, struck: bool = True) -> dict[str, float]:
        """What a key's channel asks of its note; velocity only as it is `struck`.

        Sources that no channel ever moved are left out: their targets keep what was set
        otherwise. Of two pressures on one target the firmer counts.
        """
        state = self._channels[key.channel]
        touch = state.touch.get(key.note, 0.0)
        places = {"bend": 0.5 * (state.bend + 1.0), "pressure": state.pressure}
        places |= {"poly-pressure": touch, "velocity": state.velocity.get(key.note, 1.0)}
        asked: dict[str, tuple[float, float]] = {}
        for bind in self._mapping.binds:
            moved = bind.source in self._moved or (bind.source == "velocity" and struck)
            if not moved:
                continue
            place = places[bind.source]
            value = bind.apply(place)
            if bind.source == "bend" and bind.span is None and bind.target == "/playing/bend":
                value = state.bend * state.bend_range
            if bind.target not in asked or place >= asked[bind.target][0]:
                asked[bind.target] = (place, value)
        return {address: value for address, (_, value) in asked.items()}

    def _move(self, source: str, unit: float, frame: int | None) -> None:
        for bind in self._mapping.of(source):
            self._performer.write(bind.target, bind.apply(unit), frame=frame)
