"""What MIDI channel messages mean to the player."""

from __future__ import annotations

from collections import defaultdict
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
    bend_range: float = find("/playing/bend_range").default
    pressure: float | None = None  # 0..1, once it has been moved
    sustain: bool = False
    let_go: list[Key] = field(default_factory=list)  # keys up, pedal down
    rpn: tuple[int, int] = NULL


class MidiPlayer:
    """Feeds MIDI channel messages to a performer, through a mapping.

    Parameters
    ----------
    channels : set of int, optional
        Channels that play, counted from 0; all but the percussion channel by default.
    """

    def __init__(
        self, performer: Performer, mapping: Mapping, channels: set[int] | None = None
    ) -> None:
        self._performer = performer
        self._mapping = mapping
        self._plays = channels if channels is not None else set(range(16)) - {PERCUSSION}
        self._channels: defaultdict[int, Channel] = defaultdict(
            lambda: Channel(bend_range=performer.value("/playing/bend_range"))
        )
        self.notes_by_channel: defaultdict[int, int] = defaultdict(int)

    def receive(self, message: mido.Message, *, frame: int | None = None) -> None:
        """Act on one message; others than channel messages are ignored."""
        if not hasattr(message, "channel") or message.channel not in self._plays:
            return
        kind = message.type
        if kind == "note_on" and message.velocity > 0:
            self._note_on(message.channel, message.note, message.velocity / 127.0, frame)
        elif kind in ("note_on", "note_off"):
            self._note_off(Key(message.channel, message.note), frame)
        elif kind == "pitchwheel":
            self._channels[message.channel].bend = max(-1.0, message.pitch / 8191.0)
            self._bend(message.channel, frame)
        elif kind == "aftertouch":
            self._channels[message.channel].pressure = message.value / 127.0
            self._pressure(message.channel, frame)
        elif kind == "polytouch":
            if self._performer.sounding == Key(message.channel, message.note):
                self._move("poly-pressure", message.value / 127.0, frame)
        elif kind == "control_change":
            self._control(message.channel, message.control, message.value, frame)

    def _note_on(self, channel: int, note: int, velocity: float, frame: int | None) -> None:
        key = Key(channel, note)
        state = self._channels[channel]
        if key in state.let_go:
            state.let_go.remove(key)
            self._performer.note_off(key, frame=frame)
        self._move("velocity", velocity, frame)
        played = self._performer.notes_played
        self._performer.note_on(key, frame=frame)
        self.notes_by_channel[channel] += self._performer.notes_played - played
        self._bend(channel, frame)
        self._pressure(channel, frame)

    def _note_off(self, key: Key, frame: int | None) -> None:
        state = self._channels[key.channel]
        if state.sustain:
            state.let_go.append(key)
        else:
            self._performer.note_off(key, frame=frame)
            sounding = self._performer.sounding
            if sounding is not None:
                self._bend(sounding.channel, frame)
                self._pressure(sounding.channel, frame)

    def _control(self, channel: int, control: int, value: int, frame: int | None) -> None:
        state = self._channels[channel]
        if control == SUSTAIN:
            state.sustain = value >= 64
            if not state.sustain:
                let_go, state.let_go = state.let_go, []
                for key in let_go:
                    self._note_off(key, frame)
        elif control == ALL_SOUND_OFF:
            self._let_all_go()
            self._performer.all_sound_off(frame=frame)
        elif control >= ALL_NOTES_OFF:  # the mode messages 124-127 include it
            self._let_all_go()
            self._performer.all_notes_off(frame=frame)
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

    def _let_all_go(self) -> None:
        for state in self._channels.values():
            state.let_go.clear()

    def _reset_controllers(self, channel: int, frame: int | None) -> None:
        self._control(channel, SUSTAIN, 0, frame)
        state = self._channels[channel]
        state.bend, state.pressure, state.rpn = 0.0, None, NULL
        for bind in self._mapping.binds:
            if bind.source != "velocity" and bind.target != KEPT_ON_RESET:
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
        self._bend(channel, frame)

    def _bend(self, channel: int, frame: int | None) -> None:
        sounding = self._performer.sounding
        if sounding is not None and sounding.channel != channel:
            return
        state = self._channels[channel]
        for bind in self._mapping.of("bend"):
            if bind.span is None and bind.target == "/playing/bend":
                value = state.bend * state.bend_range
            else:
                value = bind.apply(0.5 * (state.bend + 1.0))
            self._performer.write(bind.target, value, frame=frame)

    def _pressure(self, channel: int, frame: int | None) -> None:
        sounding = self._performer.sounding
        state = self._channels[channel]
        if state.pressure is not None and (sounding is None or sounding.channel == channel):
            self._move("pressure", state.pressure, frame)

    def _move(self, source: str, unit: float, frame: int | None) -> None:
        for bind in self._mapping.of(source):
            self._performer.write(bind.target, bind.apply(unit), frame=frame)
