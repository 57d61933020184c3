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
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.performer import Key, Performer
from yehu_server.playing.zones import Zones

log = logging.getLogger(__name__)

BANK, BANK_FINE = 0, 32
DATA_ENTRY, DATA_ENTRY_FINE, SUSTAIN = 6, 38, 64
INCREMENT, DECREMENT = 96, 97
NRPN_FINE, NRPN, RPN_FINE, RPN = 98, 99, 100, 101
ALL_SOUND_OFF, RESET_CONTROLLERS, ALL_NOTES_OFF = 120, 121, 123
NULL = (127, 127)
BEND_RANGE, MPE_CONFIGURATION = (0, 0), (0, 6)
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
    bank: tuple[int, int] = (0, 0)


class MidiPlayer:
    """Feeds MIDI channel messages to a performer, through a mapping.

    What is moved on a channel belongs to its notes: it is heard while one of them sounds, and
    after it until another channel's note begins.

    Parameters
    ----------
    channels : set of int, optional
        Channels that play, counted from 0; all by default but the percussion channel, unless
        it is a member of an MPE zone.
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
        performer.expression = self._expression
        self._mapping = mapping
        self._plays = channels
        self._start = dict((*mapping.start, *start))
        self._programs = programs
        self._zones: defaultdict[int, Zones] = defaultdict(lambda: Zones(whole=mapping.mpe))
        self._channels: defaultdict[int, Channel] = defaultdict(Channel)
        self._heard: Key | None = None  # whose note sounds, or sounded last
        self._set: dict[str, Moved] = {}  # targets as they were before, or as `write` left them
        self._moves = 0
        self.notes_by_channel: Counter[int] = Counter()
        self.unknown_programs: Counter[int] = Counter()
        self._set_out()

    def receive(self, message: mido.Message, *, frame: int | None = None, port: int = 0) -> None:
        """Act on a channel message, or on a system reset; others are ignored.

        Channels of different ports are different channels.
        """
        if message.type == "reset":
            self._start_anew(frame)
            return
        if not hasattr(message, "channel") or not self._listens_to(message.channel, port):
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
        elif kind == "program_change":
            self._change_program(channel, message.program + 1, frame)

    def write(self, address: str, value: float, *, frame: int | None = None) -> float:
        """Set a parameter for all channels, until a controller moves it; see `Performer.write`."""
        accepted = self._performer.write(address, value, frame=frame)
        if find(address).place is Place.PLAYER:
            self._set[address] = self._stamped(accepted)
        return accepted

    def load(self, values: Values[str, float], *, frame: int | None = None) -> None:
        """Set the parameters of a preset, but for those that are held."""
        for address, value in values.items():
            if not self._performer.keeps(address):
                self.write(address, value, frame=frame)

    def sound(self) -> dict[str, float]:
        """The player's parameters, without what velocity does for one note."""
        values = {
            param.address: self._performer.value(param.address)
            for param in TABLE
            if param.place is Place.PLAYER
        }
        for bind in self._mapping.of("velocity"):
            if bind.target in self._set:
                _, values[bind.target] = self._set[bind.target]
        return values

    def let_go_of(self, port: int, *, frame: int | None = None) -> None:
        """End the notes of a port that is gone, and forget what was moved on it."""
        for channel in range(CHANNELS * port, CHANNELS * (port + 1)):
            if channel in self._channels:
                self._performer.all_notes_off(frame=frame, channel=channel)
                del self._channels[channel]
        self._zones.pop(port, None)

    def begin_again(self, *, frame: int | None = None) -> None:
        """Put every parameter to where the performance began."""
        for param in sorted(TABLE, key=lambda param: param.place is Place.ENGINE):
            self.write(param.address, param.default, frame=frame)
        self._set_out(frame)

    def _set_out(self, frame: int | None = None) -> None:
        for address, value in self._start.items():
            self.write(address, value, frame=frame)

    def _listens_to(self, channel: int, port: int) -> bool:
        if self._plays is not None:
            return channel in self._plays
        return channel != PERCUSSION or self._zones[port].master(channel) is not None

    def _master(self, channel: int) -> int | None:
        """The master of a virtual channel in an MPE zone."""
        port, own = divmod(channel, CHANNELS)
        master = self._zones[port].master(own)
        return None if master is None else CHANNELS * port + master

    def _zone(self, channel: int) -> list[int]:
        """A channel and, where it is the master of a zone, its members."""
        port, own = divmod(channel, CHANNELS)
        return [channel, *(CHANNELS * port + member for member in self._zones[port].members(own))]

    def _start_anew(self, frame: int | None) -> None:
        self._performer.all_notes_off(frame=frame)
        self._channels.clear()
        self._zones.clear()
        for address, (_, value) in self._set.items():
            self._performer.write(address, value, frame=frame)

    def note_on(self, key: Key, velocity: float, frame: int | None) -> None:
        """Begin a note, struck with a velocity of 0 to 1."""
        state = self._channels[key.channel]
        if self._performer.holds(key) and key not in state.let_go and frame is not None:
            state.struck_again[key.note] = frame
        self._forget_let_go(key)
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
        master = self._master(key.channel)
        if state.sustain:
            state.let_go.add(key)
        elif master is not None and self._channels[master].sustain:
            self._channels[master].let_go.add(key)
        else:
            self._performer.notes_off([key], frame=frame)

    def _control(self, channel: int, control: int, value: int, frame: int | None) -> None:
        state = self._channels[channel]
        if control in (BANK, BANK_FINE):
            state.bank = (value, state.bank[1]) if control == BANK else (state.bank[0], value)
        if control == SUSTAIN and not self._mapping.of("cc 64"):
            state.sustain = value >= 64
            if not state.sustain:
                self._performer.notes_off(state.let_go, frame=frame)
                state.let_go.clear()
        elif control == ALL_SOUND_OFF:
            state.let_go.clear()
            for each in self._zone(channel):
                self._performer.all_sound_off(frame=frame, channel=each)
        elif control >= ALL_NOTES_OFF:  # the mode messages 124-127 include it
            for each in self._zone(channel):
                if state.sustain:
                    state.let_go.update(self._performer.held(each))
                else:
                    self._performer.all_notes_off(frame=frame, channel=each)
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
        if state.rpn == MPE_CONFIGURATION and control == DATA_ENTRY:
            self._configure_zone(channel, value, frame)
        if state.rpn != BEND_RANGE:
            return
        semitones, cents = divmod(round(self._bend_range(channel) * 100.0), 100)
        if control == DATA_ENTRY:
            semitones = value
        elif control == DATA_ENTRY_FINE:
            cents = min(value, 99)
        else:
            semitones += 1 if control == INCREMENT else -1
        limits = find("/playing/bend_range")
        state.bend_range = limits.accept(semitones + cents / 100.0)
        master = self._master(channel)
        if master is not None:  # what one member is told holds for all of them
            for member in self._zone(master)[1:]:
                self._channels[member].bend_range = state.bend_range
        self._follow("bend", channel, frame)

    def _configure_zone(self, channel: int, members: int, frame: int | None) -> None:
        """Make or end an MPE zone; its notes end, and its channels begin anew."""
        port, own = divmod(channel, CHANNELS)
        affected = self._zone(channel)
        if not self._zones[port].configure(own, members):
            return
        for each in {*affected, *self._zone(channel)}:
            self._performer.all_notes_off(frame=frame, channel=each)
            self._channels.pop(each, None)
        self._channels[channel].rpn = MPE_CONFIGURATION

    def _bend_range(self, channel: int) -> float:
        if self._performer.keeps("/playing/bend_range"):
            return self._performer.value("/playing/bend_range")
        port, own = divmod(channel, CHANNELS)
        usual = self._zones[port].bend_range(own)
        told = self._channels[channel].bend_range
        if told is not None:
            return told
        return self._performer.value("/playing/bend_range") if usual is None else usual

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
        if heard is None or channel in (heard.channel, self._master(heard.channel)):
            asked = self._asked(heard.channel if heard else channel, heard.note if heard else -1)
            for bind in self._mapping.of(source):
                self._performer.write(bind.target, asked[bind.target], frame=frame)

    def _expression(self, key: Key) -> dict[str, float]:
        """What a note that begins, or comes back, is to have of its channel."""
        self._heard = key
        return self._asked(key.channel, key.note)

    def _asked(self, channel: int, note: float) -> dict[str, float]:
        """Values of all targets that were ever moved, for a note of this channel.

        Of several sources of one target the one moved last counts, a direct write among them;
        where this channel moved none, the target is as it was before any channel did. A note
        in an MPE zone has its master's bend besides its own, and its master's other moves
        where it has none of its own.
        """
        asked = dict(self._set)
        master = self._master(channel)
        for bind in self._mapping.binds:
            moved = self._moved(bind.source, channel, note)
            if moved is None and master is not None:
                moved = self._moved(bind.source, master, note)
            if moved is None or moved[0] < asked.get(bind.target, (0, 0.0))[0]:
                continue
            when, place = moved
            value = bind.apply(place)
            if bind.source == "velocity":
                value *= self._share(bind.target)
            elif bind.is_by_range:
                value = self._bend(channel) + (0.0 if master is None else self._bend(master))
            asked[bind.target] = (when, value)
        return {address: value for address, (_, value) in asked.items()}

    def _share(self, target: str) -> float:
        """How far a target was put from where it began, as a factor.

        Velocity comes with every note: it is spread around what was put, or no preset would
        outlast the next note.
        """
        usual = dict(self._mapping.start).get(target, find(target).default)
        return self._set[target][1] / usual if usual > 0.0 else 1.0

    def _moved(self, source: str, channel: int, note: float) -> Moved | None:
        state = self._channels[channel]
        if source == "poly-pressure":
            return state.touch.get(note)
        if source == "velocity":
            return state.velocity.get(note)
        return state.moved.get(source)

    def _bend(self, channel: int) -> float:
        """Bend of a channel (semitones)."""
        _, place = self._channels[channel].moved.get("bend", (0, 0.5))
        return (2.0 * place - 1.0) * self._bend_range(channel)

    def _forget_let_go(self, key: Key) -> None:
        master = self._master(key.channel)
        for channel in (key.channel, *(() if master is None else (master,))):
            self._channels[channel].let_go.discard(key)


def _restore(moved: dict[float, Moved], note: float, before: Moved | None) -> None:
    if before is None:
        moved.pop(note, None)
    else:
        moved[note] = before
