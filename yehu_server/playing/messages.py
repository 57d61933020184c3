"""Translates MIDI channel messages into notes and controller moves."""

from __future__ import annotations

import logging
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable
from collections.abc import Mapping as Values

import mido

from yehu_server.params.preset import Preset
from yehu_server.params.spec import Place
from yehu_server.params.table import TABLE, find
from yehu_server.playing import sources
from yehu_server.playing.binds import Bind
from yehu_server.playing.controllers import Controllers
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.midi_channel import (
    DATA_ENTRY,
    DATA_ENTRY_FINE,
    DECREMENT,
    INCREMENT,
    NRPN,
    NRPN_FINE,
    RPN,
    RPN_FINE,
    MidiChannel,
    Selected,
)
from yehu_server.playing.scope import Scope
from yehu_server.playing.sources import CHANNELS
from yehu_server.playing.wishes import Key, Wishes
from yehu_server.playing.zones import Zones

log = logging.getLogger(__name__)

BANK, BANK_FINE = 0, 32
SUSTAIN = 64
ALL_SOUND_OFF, RESET_CONTROLLERS, ALL_NOTES_OFF = 120, 121, 123
SUSTAIN_SOURCE = sources.control(SUSTAIN)
BEND_RANGE, MPE_CONFIGURATION = (0, 0), (0, 6)
PERCUSSION = 9  # channel 10, counted from 0
# Messages that global binds receive even on channels whose notes are not played.
MOVES = ("control_change", "pitchwheel", "aftertouch")


class MidiPlayer:
    """Turns MIDI channel messages into wishes: notes directly, controllers through a mapping.

    Parameters
    ----------
    channels : set of int, optional
        Channels to receive, counted from 0; by default all. Notes of the percussion channel are
        played only if it is chosen, or a member of an MPE zone.
    start : iterable of (address, value)
        Start values of parameters, over those of the mapping.
    programs : callable, optional
        Returns the preset of a MIDI program, 1 to 128, or None where there is none. Without it
        program changes are ignored.
    """

    def __init__(
        self,
        wishes: Wishes,
        mapping: Mapping,
        channels: set[int] | None = None,
        *,
        start: Iterable[tuple[str, float]] = (),
        programs: Callable[[int], Preset | None] | None = None,
    ) -> None:
        self._wishes = wishes
        self._scope = Scope(self)
        self._controllers = Controllers(wishes, mapping, self, self._scope, start)
        self._chosen = channels
        self._programs = programs
        self._zones: defaultdict[int, Zones] = defaultdict(lambda: Zones(whole=self.mapping.mpe))
        self._channels: defaultdict[int, MidiChannel] = defaultdict(MidiChannel)
        self.notes_by_channel: Counter[int] = Counter()
        self.percussion_notes = 0  # which are not played
        self.unknown_programs: Counter[int] = Counter()
        self._controllers.begin(None)

    @property
    def mapping(self) -> Mapping:
        """The mapping in use; `remap` takes another."""
        return self._controllers.mapping

    def receive(self, message: mido.Message, *, frame: int | None = None, port: int = 0) -> None:
        """Act on a channel message or a system reset; ignore others.

        Each port, counted from 0, has 16 channels of its own.
        """
        if message.type == "reset":
            self.reset(frame=frame)
            return
        if not hasattr(message, "channel"):
            return
        channel, kind = CHANNELS * port + message.channel, message.type
        if not self.plays(channel) and not self._receives(kind):
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
            key = Key(channel, message.note)
            self._controllers.move_poly_pressure(key, message.value / 127.0, frame)
        elif kind == "control_change":
            self._control(channel, message.control, message.value, frame)
        elif kind == "program_change":
            self._change_program(channel, message.program + 1, frame)

    def move(self, address: str, argument: float, *, frame: int | None = None) -> None:
        """Move the targets of an OSC address of the mapping, for all channels."""
        self._controllers.move_address(address, argument, frame)

    def write(self, address: str, value: float, *, frame: int | None = None) -> float:
        """Set a parameter for all channels, until a controller moves it; see `Wishes.write`."""
        return self._controllers.write(address, value, frame)

    def remap(self, mapping: Mapping, *, frame: int | None = None) -> None:
        """Take another mapping while notes sound; see `Controllers.remap`."""
        was_mpe = self.mapping.mpe
        self._controllers.remap(mapping, frame)
        if mapping.mpe != was_mpe:
            self.reset(frame=frame)
        if mapping.of(SUSTAIN_SOURCE):  # the pedal no longer holds notes
            for state in self._channels.values():
                state.sustain = False
            for state in list(self._channels.values()):
                self._lift_pedal(state, frame)

    def load(self, values: Values[str, float], *, frame: int | None = None) -> None:
        """Set the parameters of a preset, except held ones."""
        for address, value in values.items():
            if not self._wishes.keeps(address):
                self.write(address, value, frame=frame)

    def positions(self) -> list[tuple[Bind, float | None]]:
        """See `Controllers.positions`."""
        return self._controllers.positions()

    def sound(self) -> dict[str, float]:
        """See `Controllers.sound`."""
        return self._controllers.sound()

    def let_go_of(self, port: int, *, frame: int | None = None) -> None:
        """End the notes of a port that is gone; see `Controllers.disconnect`."""
        for channel in range(CHANNELS * port, CHANNELS * (port + 1)):
            self._end(channel, frame)
            self._controllers.disconnect(channel, frame)
        self._zones.pop(port, None)

    def begin_again(self, *, frame: int | None = None) -> None:
        """Set every parameter to its start value."""
        for param in sorted(TABLE, key=lambda param: param.place is Place.ENGINE):
            self.write(param.address, param.default, frame=frame)
        self._controllers.begin(frame)

    def plays(self, channel: int) -> bool:
        """See `scope.ChannelRules`."""
        own = channel % CHANNELS
        if self._chosen is not None:
            return own in self._chosen
        return own != PERCUSSION or self.master(channel) is not None

    def _receives(self, kind: str) -> bool:
        """Whether global binds receive a message on channels whose notes are not played."""
        return self._chosen is None and kind in MOVES and self.mapping.has_global

    def master(self, channel: int) -> int | None:
        """See `scope.ChannelRules`."""
        port, own = divmod(channel, CHANNELS)
        master = self._zones[port].master(own)
        return None if master is None else CHANNELS * port + master

    def bend_range(self, channel: int) -> float:
        """See `scope.ChannelRules`."""
        if self._wishes.keeps("/playing/bend_range"):
            return self._wishes.value("/playing/bend_range")
        port, own = divmod(channel, CHANNELS)
        default = self._zones[port].bend_range(own)
        received = self._channels[channel].bend_range
        if received is not None:
            return received
        return self._wishes.value("/playing/bend_range") if default is None else default

    def _zone(self, channel: int) -> list[int]:
        """A channel and, if it is the master of a zone, its members."""
        port, own = divmod(channel, CHANNELS)
        return [channel, *(CHANNELS * port + member for member in self._zones[port].members(own))]

    def reset(self, *, frame: int | None = None) -> None:
        """End all notes, and forget pedals, zones and moves."""
        self.end_all(frame=frame)
        self._channels.clear()
        self._zones.clear()
        self._controllers.forget_all(frame)

    def _end(self, channel: int, frame: int | None) -> None:
        """End the notes of a channel and those its pedal holds, and forget its state."""
        self._end_notes(self._wishes.held(channel), frame)
        self._lift_pedal(self._channels[channel], frame)
        self._channels.pop(channel)

    def note_on(self, key: Key, velocity: float, frame: int | None) -> None:
        """Begin a note; `velocity` is 0 to 1."""
        state = self._channels[key.channel]
        pedals = [each for each in self._channels.values() if key in each.sustained]
        if self._wishes.holds(key) and not pedals and frame is not None:
            state.retriggered[key.note] = frame
        for pedal in pedals:
            pedal.sustained.pop(key, None)
        is_first = self._scope.add(key.channel)
        before = self._controllers.begin_note(key, velocity)
        values = self._controllers.values_of(key) if self._wishes.has(key) else {}
        if self._wishes.note_on(key, values, frame=frame):
            self.notes_by_channel[key.channel] += 1
            return
        self._controllers.cancel_note(key, before)
        if is_first:
            self._scope.remove(key.channel)

    def note_off(self, key: Key, frame: int | None) -> None:
        """End a note, unless a pedal keeps it."""
        state = self._channels[key.channel]
        if frame is not None and state.retriggered.pop(key.note, None) == frame:
            return  # the note-off of the note before, which some files write after the new note-on
        self._release([key], frame)

    def _release(self, keys: Iterable[Key], frame: int | None) -> None:
        """End the notes of released keys, except those that a pedal holds."""
        ended = []
        for key in keys:
            pedal = self._pedal(key.channel)
            if pedal is None:
                ended.append(key)
            else:
                pedal.sustained[key] = None
        self._end_notes(ended, frame)

    def end_all(self, *, frame: int | None = None) -> None:
        """End all notes, whatever pedals hold."""
        self._end_notes(self._wishes.held(), frame)

    def _end_notes(self, keys: Iterable[Key], frame: int | None) -> None:
        """End notes at once; the one that sounds again does so with its own values."""
        keys = list(keys)
        heir = self._wishes.heir(keys)
        values = {} if heir is None else self._controllers.values_of(heir)
        self._wishes.notes_off(keys, values, frame=frame)

    def _pedal(self, channel: int) -> MidiChannel | None:
        """A channel whose pedal holds the notes of this one; None where none does."""
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
            elsewhere = [key for key in state.sustained if key.channel not in zone]
            state.sustained.clear()
            here = [key for each in zone for key in self._wishes.held(each)]
            self._end_notes([*elsewhere, *here], frame)
            self._wishes.stop_sound(frame=frame)
        elif control >= ALL_NOTES_OFF:  # the mode messages 124-127 include it
            keys = [key for each in self._zone(channel) for key in self._wishes.held(each)]
            if state.sustain:
                state.sustained.update(dict.fromkeys(keys))
            else:
                self._end_notes(keys, frame)
        elif control == RESET_CONTROLLERS:
            self._reset_controllers(channel, frame)
        elif control in (RPN, RPN_FINE, NRPN, NRPN_FINE):
            state.select(control, value)
        elif control in (DATA_ENTRY, DATA_ENTRY_FINE, INCREMENT, DECREMENT):
            self._data_entry(channel, control, value, frame)
        else:
            self._move_control(channel, control, value, frame)

    def _move_control(self, channel: int, control: int, value: int, frame: int | None) -> None:
        """Move the sources of a control change: the 7-bit one, then the 14-bit pair."""
        self._controllers.move(sources.control(control), channel, value / 127.0, frame)
        if control in sources.COARSE:
            self._controllers.move_coarse(sources.pair(control), channel, value, frame)
        elif (coarse := control - sources.FINE_ABOVE) in sources.COARSE:
            self._controllers.move_fine(sources.pair(coarse), channel, value, frame)

    def _lift_pedal(self, state: MidiChannel, frame: int | None) -> None:
        state.sustain = False
        sustained, state.sustained = state.sustained, {}
        self._release(sustained, frame)

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
        bend_range = limits.accept(semitones + cents / 100.0)
        self._channels[channel].bend_range = bend_range
        master = self.master(channel)
        if master is not None:  # one member sets the range of all
            for member in self._zone(master)[1:]:
                self._channels[member].bend_range = bend_range
        self._controllers.follow(sources.BEND, channel, frame)

    def _configure_zone(self, channel: int, members: int, frame: int | None) -> None:
        """Create or end an MPE zone; the notes of its channels end and their state is forgotten."""
        port, own = divmod(channel, CHANNELS)
        affected = self._zone(channel)
        if not self._zones[port].configure(own, members):
            return
        for each in sorted({*affected, *self._zone(channel)}):
            self._end(each, frame)
            self._controllers.forget(each)
        self._channels[channel].selected = Selected(True, *MPE_CONFIGURATION)
