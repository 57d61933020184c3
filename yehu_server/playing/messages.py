"""What MIDI channel messages mean to the player."""

from __future__ import annotations

import logging
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable
from collections.abc import Mapping as Values
from dataclasses import dataclass, field

import mido

from yehu_server.params.preset import Preset
from yehu_server.params.spec import Place
from yehu_server.params.table import TABLE, find
from yehu_server.playing import sources
from yehu_server.playing.binds import Bind
from yehu_server.playing.controllers import Controllers
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.performer import Key, Performer
from yehu_server.playing.scope import Scope
from yehu_server.playing.sources import CHANNELS
from yehu_server.playing.zones import Zones

log = logging.getLogger(__name__)

BANK, BANK_FINE = 0, 32
DATA_ENTRY, DATA_ENTRY_FINE, SUSTAIN = 6, 38, 64
INCREMENT, DECREMENT = 96, 97
NRPN_FINE, NRPN, RPN_FINE, RPN = 98, 99, 100, 101
ALL_SOUND_OFF, RESET_CONTROLLERS, ALL_NOTES_OFF = 120, 121, 123
SUSTAIN_SOURCE = sources.control(SUSTAIN)
BEND_RANGE, MPE_CONFIGURATION = (0, 0), (0, 6)
PERCUSSION = 9  # channel 10, counted from 0
# What is heard on channels whose notes are not played, as far as it is global.
MOVES = ("control_change", "pitchwheel", "aftertouch")


@dataclass
class Selected:
    """The parameter, registered or not, that data entry is for."""

    is_registered: bool = True
    coarse: int | None = None  # None until told
    fine: int | None = None

    @property
    def number(self) -> tuple[int, int] | None:
        """Both halves, once both are told."""
        if self.coarse is None or self.fine is None:
            return None
        return self.coarse, self.fine


@dataclass
class Channel:
    """What one MIDI channel remembers."""

    struck_again: dict[float, int] = field(default_factory=dict)  # held notes, at which frame
    bend_range: float | None = None  # semitones, once RPN 0 has set it
    sustain: bool = False
    let_go: set[Key] = field(default_factory=set)  # keys up, pedal down
    selected: Selected = field(default_factory=Selected)
    bank: tuple[int, int] = (0, 0)

    def has_selected(self, registered: tuple[int, int]) -> bool:
        """Whether data entry is for a registered parameter."""
        return self.selected.is_registered and self.selected.number == registered


class MidiPlayer:
    """Feeds MIDI channel messages to a performer: notes at once, the rest through a mapping.

    Parameters
    ----------
    channels : set of int, optional
        Channels that are heard, counted from 0. By default all are, but the percussion channel
        plays no notes unless it is a member of an MPE zone.
    start : iterable of (address, value)
        Where parameters begin, besides what the mapping says.
    programs : callable, optional
        The preset of a MIDI program, 1 to 128, or None where none has it. Without it program
        changes are ignored.
    """

    def __init__(
        self,
        performer: Performer,
        mapping: Mapping,
        channels: set[int] | None = None,
        *,
        start: Iterable[tuple[str, float]] = (),
        programs: Callable[[int], Preset | None] | None = None,
    ) -> None:
        self._performer = performer
        self._scope = Scope(self)
        self._controllers = Controllers(performer, mapping, self, self._scope, start)
        self._chosen = channels
        self._programs = programs
        self._zones: defaultdict[int, Zones] = defaultdict(lambda: Zones(whole=self.mapping.mpe))
        self._channels: defaultdict[int, Channel] = defaultdict(Channel)
        self.notes_by_channel: Counter[int] = Counter()
        self.percussion_notes = 0  # which are not played
        self.unknown_programs: Counter[int] = Counter()
        self._controllers.begin(None)

    @property
    def mapping(self) -> Mapping:
        """What controllers move; `remap` takes another."""
        return self._controllers.mapping

    def receive(self, message: mido.Message, *, frame: int | None = None, port: int = 0) -> None:
        """Act on a channel message, or on a system reset; others are ignored.

        Channels of different ports are different channels.
        """
        if message.type == "reset":
            self._start_anew(frame)
            return
        if not hasattr(message, "channel"):
            return
        channel, kind = CHANNELS * port + message.channel, message.type
        if not self.plays(channel) and not self._hears(kind):
            is_note = kind == "note_on" and message.velocity > 0
            self.percussion_notes += is_note and self._chosen is None
            return
        if kind == "note_on" and message.velocity > 0:
            self.note_on(Key(channel, message.note), message.velocity / 127.0, frame)
        elif kind in ("note_on", "note_off"):
            self.note_off(Key(channel, message.note), frame)
        elif kind == "pitchwheel":
            bend = max(-1.0, message.pitch / 8191.0)
            self._controllers.move(sources.BEND, channel, 0.5 * (bend + 1.0), frame)
        elif kind == "aftertouch":
            self._controllers.move(sources.PRESSURE, channel, message.value / 127.0, frame)
        elif kind == "polytouch":
            self._controllers.touch(Key(channel, message.note), message.value / 127.0, frame)
        elif kind == "control_change":
            self._control(channel, message.control, message.value, frame)
        elif kind == "program_change":
            self._change_program(channel, message.program + 1, frame)

    def move(self, address: str, argument: float, *, frame: int | None = None) -> None:
        """Move what an OSC address of the mapping is bound to, for all channels."""
        self._controllers.move_address(address, argument, frame)

    def write(self, address: str, value: float, *, frame: int | None = None) -> float:
        """Set a parameter for all channels, until a controller moves it; see `Performer.write`."""
        return self._controllers.write(address, value, frame)

    def remap(self, mapping: Mapping, *, frame: int | None = None) -> None:
        """Take another mapping while notes sound; see `Controllers.remap`."""
        was_mpe = self.mapping.mpe
        self._controllers.remap(mapping, frame)
        if mapping.mpe != was_mpe:
            self._start_anew(frame)
        if mapping.of(SUSTAIN_SOURCE):  # it is no pedal any more, and shall hold nothing
            for state in self._channels.values():
                state.sustain = False
            for state in list(self._channels.values()):
                self._lift_pedal(state, frame)

    def load(self, values: Values[str, float], *, frame: int | None = None) -> None:
        """Set the parameters of a preset, but for those that are held."""
        for address, value in values.items():
            if not self._performer.keeps(address):
                self.write(address, value, frame=frame)

    def places(self) -> list[tuple[Bind, float | None]]:
        """See `Controllers.places`."""
        return self._controllers.places()

    def sound(self) -> dict[str, float]:
        """See `Controllers.sound`."""
        return self._controllers.sound()

    def let_go_of(self, port: int, *, frame: int | None = None) -> None:
        """End the notes of a port that is gone; see also `Controllers.leave`."""
        for channel in range(CHANNELS * port, CHANNELS * (port + 1)):
            self._end(channel, frame)
            self._controllers.leave(channel, frame)
        self._zones.pop(port, None)

    def begin_again(self, *, frame: int | None = None) -> None:
        """Put every parameter to where the performance began."""
        for param in sorted(TABLE, key=lambda param: param.place is Place.ENGINE):
            self.write(param.address, param.default, frame=frame)
        self._controllers.begin(frame)

    def plays(self, channel: int) -> bool:
        """See `scope.Channels`."""
        own = channel % CHANNELS
        if self._chosen is not None:
            return own in self._chosen
        return own != PERCUSSION or self.master(channel) is not None

    def _hears(self, kind: str) -> bool:
        """Whether a message may move something on a channel whose notes are not played."""
        return self._chosen is None and kind in MOVES and self.mapping.has_global

    def master(self, channel: int) -> int | None:
        """See `scope.Channels`."""
        port, own = divmod(channel, CHANNELS)
        master = self._zones[port].master(own)
        return None if master is None else CHANNELS * port + master

    def bend_range(self, channel: int) -> float:
        """See `scope.Channels`."""
        if self._performer.keeps("/playing/bend_range"):
            return self._performer.value("/playing/bend_range")
        port, own = divmod(channel, CHANNELS)
        usual = self._zones[port].bend_range(own)
        told = self._channels[channel].bend_range
        if told is not None:
            return told
        return self._performer.value("/playing/bend_range") if usual is None else usual

    def _zone(self, channel: int) -> list[int]:
        """A channel and, where it is the master of a zone, its members."""
        port, own = divmod(channel, CHANNELS)
        return [channel, *(CHANNELS * port + member for member in self._zones[port].members(own))]

    def _start_anew(self, frame: int | None) -> None:
        self._performer.all_notes_off(frame=frame)
        self._channels.clear()
        self._zones.clear()
        self._controllers.start_anew(frame)

    def _end(self, channel: int, frame: int | None) -> None:
        """End the notes of a channel and those its pedal holds, and forget what it was told."""
        self._performer.all_notes_off(frame=frame, channel=channel)
        self._lift_pedal(self._channels[channel], frame)
        self._channels.pop(channel)

    def note_on(self, key: Key, velocity: float, frame: int | None) -> None:
        """Begin a note, struck with a velocity of 0 to 1."""
        state = self._channels[key.channel]
        pedals = [each for each in self._channels.values() if key in each.let_go]
        if self._performer.holds(key) and not pedals and frame is not None:
            state.struck_again[key.note] = frame
        for pedal in pedals:
            pedal.let_go.discard(key)
        is_first = self._scope.add(key.channel)
        struck = self._controllers.strike(key, velocity)
        if self._performer.note_on(key, frame=frame):
            self.notes_by_channel[key.channel] += 1
            return
        self._controllers.unstrike(key, struck)
        if is_first:
            self._scope.remove(key.channel)

    def note_off(self, key: Key, frame: int | None) -> None:
        """End a note, unless a pedal keeps it."""
        state = self._channels[key.channel]
        if frame is not None and state.struck_again.pop(key.note, None) == frame:
            return  # the end of the stroke before, which some files write after the new one
        self._let_up([key], frame)

    def _let_up(self, keys: Iterable[Key], frame: int | None) -> None:
        """End notes that no hand holds any more, but for those that a pedal does."""
        ended = []
        for key in keys:
            pedal = self._pedal(key.channel)
            if pedal is None:
                ended.append(key)
            else:
                pedal.let_go.add(key)
        self._performer.notes_off(ended, frame=frame)

    def _pedal(self, channel: int) -> Channel | None:
        """A channel whose pedal is down and holds the notes of this one."""
        own = (channel, self.master(channel))
        for each, state in self._channels.items():
            if state.sustain and (each in own or self._scope.is_for_all(each)):
                return state
        return None

    def _control(self, channel: int, control: int, value: int, frame: int | None) -> None:
        state = self._channels[channel]
        if control >= ALL_SOUND_OFF and not self.plays(channel):
            return
        if control in (BANK, BANK_FINE):
            state.bank = (value, state.bank[1]) if control == BANK else (state.bank[0], value)
        if control == SUSTAIN and not self.mapping.of(SUSTAIN_SOURCE):
            state.sustain = value >= 64
            if not state.sustain:
                self._lift_pedal(state, frame)
        elif control == ALL_SOUND_OFF:
            zone = self._zone(channel)
            elsewhere = [key for key in state.let_go if key.channel not in zone]
            self._performer.notes_off(elsewhere, frame=frame)
            state.let_go.clear()
            for each in zone:
                self._performer.all_sound_off(frame=frame, channel=each)
        elif control >= ALL_NOTES_OFF:  # the mode messages 124-127 include it
            for each in self._zone(channel):
                if state.sustain:
                    state.let_go.update(self._performer.held(each))
                else:
                    self._performer.all_notes_off(frame=frame, channel=each)
        elif control == RESET_CONTROLLERS:
            self._reset_controllers(channel, frame)
        elif control in (RPN, RPN_FINE, NRPN, NRPN_FINE):
            _select(state, control, value)
        elif control in (DATA_ENTRY, DATA_ENTRY_FINE, INCREMENT, DECREMENT):
            self._data_entry(channel, control, value, frame)
        else:
            self._move_control(channel, control, value, frame)

    def _move_control(self, channel: int, control: int, value: int, frame: int | None) -> None:
        """Move what hears this control alone, and then what hears it as half of a pair."""
        self._controllers.move(sources.control(control), channel, value / 127.0, frame)
        if control in sources.COARSE:
            self._controllers.move_coarse(sources.pair(control), channel, value, frame)
        elif (coarse := control - sources.FINE_ABOVE) in sources.COARSE:
            self._controllers.move_fine(sources.pair(coarse), channel, value, frame)

    def _lift_pedal(self, state: Channel, frame: int | None) -> None:
        state.sustain = False
        let_go, state.let_go = state.let_go, set()
        self._let_up(let_go, frame)

    def _change_program(self, channel: int, program: int, frame: int | None) -> None:
        if self._programs is None or self._channels[channel].bank != (0, 0):
            return
        preset = self._programs(program)
        if preset is not None:
            self.load(preset.values, frame=frame)
            return
        self.unknown_programs[program] += 1
        if self.unknown_programs[program] == 1:
            log.info("no preset has program %d", program)

    def _reset_controllers(self, channel: int, frame: int | None) -> None:
        self._control(channel, SUSTAIN, 0, frame)
        self._channels[channel].selected = Selected()
        self._controllers.reset(channel, frame)

    def _data_entry(self, channel: int, control: int, value: int, frame: int | None) -> None:
        state = self._channels[channel]
        if not state.selected.is_registered:
            self._enter_nrpn(channel, control, value, frame)
        elif state.has_selected(MPE_CONFIGURATION) and control == DATA_ENTRY:
            self._configure_zone(channel, value, frame)
        elif state.has_selected(BEND_RANGE):
            self._enter_bend_range(channel, control, value, frame)

    def _enter_nrpn(self, channel: int, control: int, value: int, frame: int | None) -> None:
        number = self._channels[channel].selected.number
        if number is None:
            return
        source = sources.nrpn(number[0] << 7 | number[1])
        if control == DATA_ENTRY:
            self._controllers.move_coarse(source, channel, value, frame)
        elif control == DATA_ENTRY_FINE:
            self._controllers.move_fine(source, channel, value, frame)
        else:
            self._controllers.step(source, channel, 1 if control == INCREMENT else -1, frame)

    def _enter_bend_range(self, channel: int, control: int, value: int, frame: int | None) -> None:
        semitones, cents = divmod(round(self.bend_range(channel) * 100.0), 100)
        if control == DATA_ENTRY:
            semitones = value
        elif control == DATA_ENTRY_FINE:
            cents = min(value, 99)
        else:
            semitones += 1 if control == INCREMENT else -1
        limits = find("/playing/bend_range")
        told = self._channels[channel].bend_range = limits.accept(semitones + cents / 100.0)
        master = self.master(channel)
        if master is not None:  # what one member is told holds for all of them
            for member in self._zone(master)[1:]:
                self._channels[member].bend_range = told
        self._controllers.follow(sources.BEND, channel, frame)

    def _configure_zone(self, channel: int, members: int, frame: int | None) -> None:
        """Make or end an MPE zone; its notes end, and its channels begin anew."""
        port, own = divmod(channel, CHANNELS)
        affected = self._zone(channel)
        if not self._zones[port].configure(own, members):
            return
        for each in {*affected, *self._zone(channel)}:
            self._end(each, frame)
            self._controllers.forget(each)
        self._channels[channel].selected = Selected(True, *MPE_CONFIGURATION)


def _select(state: Channel, control: int, value: int) -> None:
    """Select a parameter by one of its halves; those of RPN and NRPN do not mix."""
    is_registered = control in (RPN, RPN_FINE)
    if state.selected.is_registered != is_registered:
        state.selected = Selected(is_registered)
    if control in (RPN, NRPN):
        state.selected.coarse = value
    else:
        state.selected.fine = value
