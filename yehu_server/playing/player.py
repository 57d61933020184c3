"""Posts notes, parameters, MIDI messages and moves of controllers to a part.

What they come to is decided in compiled code (``midi``, ``player``), at their frames.
"""

import threading
from collections.abc import Collection, Iterable, Sequence
from collections.abc import Mapping as Values
from contextvars import ContextVar
from functools import lru_cache
from typing import Any, Self

import mido
from mido.messages import BaseMessage

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG_BYTES
from yehu_server.core.midi import events
from yehu_server.core.midi.packing import packed
from yehu_server.core.midi.record import SECTION
from yehu_server.core.midi.tables import TABLE_SLOTS, plain_tables
from yehu_server.core.player import commands
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.params.preset_file import Preset
from yehu_server.params.table import SLOT, TABLE, find
from yehu_server.playing.learner import Learning
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.part_state import UNMAPPED, Key, PartState, within_midi
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, STANDARD_A4, RangePolicy, Tuning

KEYS_KEPT = 256  # whose pitches are kept
OWN_VALUES = -1.0  # in place of a velocity: the note has been given its values
# Whose queue the events wait in that this thread posts (``Instrument.post``).
SENDER: ContextVar[int] = ContextVar("sender", default=0)


class Player(PartState):
    """Plays a part, on an instrument or on those of a section; any thread may call.

    The audio side never waits for it: events are posted to a ring, each with the frame at which it
    is to sound (`frame_of`, or that of a time tag; without one, now), and acted on in the order of
    frames. Of an instrument in memory of its own, one thread plays and computes.

    `instruments`: Instrument, or sequence of Instrument.
    `policy`: what happens to notes out of range.
    `a4` (Hz).
    `part`: which of the parts on the stage it plays, counted from 0. What all parts share is the
    first one's.
    """

    def __init__(
        self,
        instruments: Instrument | Sequence[Instrument],
        policy: RangePolicy = RangePolicy.TRANSPOSE,
        tuning: Tuning = EQUAL,
        a4: float = STANDARD_A4,
        *,
        part: int = 0,
        presets: Presets | None = None,
    ) -> None:
        several = [instruments] if isinstance(instruments, Instrument) else list(instruments)
        super().__init__(several, part)
        places = [instrument.address for instrument in several]
        if places != [places[0] + number * RIG_BYTES for number in range(len(places))]:
            raise ValueError("the instruments of a section lie one after another on a stage")
        self.policy, self._tuning, self._a4 = policy, tuning, a4
        self.pitches = lru_cache(KEYS_KEPT)(self._pitches)
        self.presets = Presets() if presets is None else presets
        self.controls = Controls()
        self.learning = Learning()
        self._lock = threading.RLock()  # held for moments only
        self._latest = 0  # the latest frame of any event
        self._channels: Collection[int] | None = None
        self._start: tuple[tuple[str, float], ...] = ()
        self._programs: Values[int, Preset] | None = None
        self._slot = 0  # of the tables that were posted last
        self._has_stale_tables = False
        self.instrument.begin_part(self.tables(UNMAPPED), len(several))
        for other in several[1:]:
            other.begin_part(plain_tables(), 0)

    def mapped(
        self,
        mapping: Mapping,
        channels: Collection[int] | None = None,
        *,
        start: Iterable[tuple[str, float]] = (),
        programs: Values[int, Preset] | None = None,
    ) -> Self:
        """Play by a mapping from the beginning on; return itself.

        `channels` (from 0): those received; by default all, percussion only if it is chosen or a
        member of an MPE zone. `start`: addresses and values, over the mapping's. `programs`:
        presets of MIDI programs, from 1; by default program changes are ignored.
        """
        self.mapping, self._channels = mapping, channels
        self._start, self._programs = tuple(start), programs
        self._slot = 0
        self.instrument.set_tables(self._tables())
        self.post(events.START)
        return self

    def tables(self, mapping: Mapping, **more: Any) -> Any:
        """Tables of a mapping with this part's tuning and range; `more` as of `make_tables`."""
        more |= {"tuning": self._tuning, "a4": self._a4, "policy": self.policy}
        return make_tables(mapping, self.controls, notes=self.notes, **more)

    def _tables(self) -> Any:
        return self.tables(
            self.mapping, start=self._start, received=self._channels, programs=self._programs
        )

    # -- events and frames -------------------------------------------------------------------

    def post(
        self,
        kind: int,
        frame: int | None = None,
        index: int = 0,
        value: float = 0.0,
        other: float = 0.0,
    ) -> None:
        """Post an event (``midi.events``); without a frame, for now."""
        with self._lock:
            self.instrument.post(
                kind,
                frame=self._at(frame),
                index=index,
                value=value,
                other=other,
                sender=SENDER.get(),
            )

    def _at(self, frame: int | None) -> int | None:
        """Return the frame, and record it as the latest one."""
        if frame is not None:
            if self._latest > frame + self.instrument.rate:  # the system's clock was set back
                self._latest = frame
            self._latest = max(self._latest, frame)
        return frame

    def _after_all(self, frame: int | None) -> int | None:
        """A frame after which nothing is posted yet."""
        return None if self._at(frame) is None else self._latest

    # -- parameters --------------------------------------------------------------------------

    def write(
        self,
        address: str,
        value: float,
        *,
        frame: int | None = None,
        hold: bool = False,
        glide_ms: float = 0.0,
        kind: int = commands.WRITE,
    ) -> float:
        """Set any parameter of the table; return the value it then has.

        The moves of bow and fingers that follow take at least `glide_ms`; `kind` is a plain write,
        or counts as a move of a controller. Raises ParameterError where the address is unknown or
        the value is not finite.
        """
        param = find(address)
        accepted = param.clamped(value)
        index = INDEX[address]
        if index == SECTION:
            accepted = min(float(round(accepted)), float(self.players))
        with self._lock:
            if not (hold or param.player_controlled) and self.keeps(address):
                accepted = self.value(address)
            self._note(address, accepted, frame, is_held=hold)
            if address == "/bow/force":  # raw newtons are heard only without assist
                self._note("/bow/assist", 0.0, frame, is_held=hold)
            self.post(commands.HOLD if hold else kind, frame, index, accepted, glide_ms)
        return accepted

    def set(
        self, address: str, value: float, *, frame: int | None = None, glide_ms: float = 0.0
    ) -> float:
        """Set a parameter for all channels, until a controller moves it; see `write`."""
        return self.write(address, value, frame=frame, glide_ms=glide_ms, kind=events.SET)

    def hold(self, address: str, value: float) -> float:
        """Set a parameter from the first frame on, and hold it as long as the program runs."""
        return self.write(address, value, frame=0, hold=True)

    def start_with(self, address: str, value: float) -> float:
        """Hold a parameter at a value, from the first sample on; see `write`."""
        accepted = self.write(address, value, hold=True)
        self.jump(address, accepted)
        return accepted

    def jump(self, address: str, value: float) -> None:
        """Have the engine begin with a value that a parameter was given, and not move there."""
        if address in SLOT:
            self.post(commands.RAMP, None, SLOT[address], find(address).clamped(value))

    def load(self, values: Values[str, float], *, frame: int | None = None) -> None:
        """Set the parameters of a preset, except held ones, all at one frame."""
        with self._lock:
            for address, value in values.items():
                if not self.keeps(address):
                    self.write(address, value, frame=frame, kind=events.LOAD)

    def release(self, *, frame: int | None = None) -> None:
        """Return every parameter that was taken over to the player."""
        with self._lock:
            self.pending.clear()
            self.post(commands.RELEASE, frame)

    # -- notes -------------------------------------------------------------------------------

    def has(self, key: Key) -> bool:
        """Whether the instrument has a note for a key."""
        return self.pitches(key.note)[1] is not None

    def _pitches(self, key: float) -> tuple[float | None, float | None]:
        """The pitch (fractional MIDI note) of a key, and that within range which it sounds at."""
        tuned = self._tuning.pitch(key, self._a4)
        return tuned, None if tuned is None else self.policy.fit(tuned, self.notes)

    def note_on(
        self,
        key: Key,
        values: Values[str, float] | None = None,
        *,
        frame: int | None = None,
        tuned: float | None = None,
    ) -> bool:
        """Begin a note, legato where another sounds, else with a new stroke of the bow.

        Keys struck at one frame make one stroke. Returns whether the instrument has the note.

        `values`: values of parameters, by address, for this note.
        `tuned`: its pitch (fractional MIDI note) within range; by default as the tuning has it.
        """
        has_note = tuned is not None or self.has(key)
        with self._lock:
            for address, value in (values or {}).items() if has_note else ():
                self.post(commands.EXPRESS, frame, INDEX[address], find(address).clamped(value))
            if tuned is None:
                self.post(events.NOTE_ON, frame, key.channel, key.note, OWN_VALUES)
            else:
                self.post(commands.BEGIN, frame, key.channel, key.note, tuned)
        return has_note

    def notes_off(self, keys: Iterable[Key], *, frame: int | None = None) -> None:
        """End several notes at once; of those still held the last one sounds again, legato."""
        ending = list(dict.fromkeys(keys))
        with self._lock:
            for key in ending:
                more = float(key is not ending[-1])
                self.post(commands.END, frame, key.channel, key.note, more)

    def note_off(self, key: Key, *, frame: int | None = None) -> None:
        """End a note; see `notes_off`."""
        self.notes_off([key], frame=frame)

    def end_all(self, *, frame: int | None = None) -> None:
        """End all notes, also those that were asked for ahead, whatever pedals hold."""
        self.post(events.RELEASE_ALL, frame)

    def stop_sound(self, *, frame: int | None = None, is_panic: bool = False) -> None:
        """Lift bow and fingers and stop the sound, unless a note sounds; in a panic, all."""
        self.post(commands.STOP, frame, value=float(is_panic))

    def end_notes(self, *, frame: int) -> None:
        """End all notes, as if all keys and pedals were released; lift a bow drawn by hand."""
        with self._lock:
            after = self._after_all(frame)
            self.post(events.RELEASE_ALL, after, value=1.0)
            self.lift(frame=after)

    def panic(self, *, frame: int) -> None:
        """End all notes and all sound at once."""
        with self._lock:
            self.end_notes(frame=frame)
            self.stop_sound(frame=self._after_all(frame), is_panic=True)

    def reset(self, *, frame: int) -> None:
        """As `panic`, and set every parameter to its start value."""
        defaults = {param.address: param.default for param in TABLE}
        with self._lock:
            after = self._after_all(frame)
            self.expect(defaults | dict(self.mapping.start) | dict(self._start), after)
            self.post(events.START, after, value=1.0)
            self.panic(frame=frame)

    def end_keys(self, keys: Iterable[Key], *, frame: int) -> None:
        """End the notes of keys whose owner is gone."""
        with self._lock:
            self.notes_off(keys, frame=self._after_all(frame))

    def end_channel_notes(self, first: int, channels: int, *, frame: int) -> None:
        """End what is held on channels whose owner is gone, and lift a bow drawn by hand."""
        with self._lock:
            after = self._after_all(frame)
            self.post(events.LEAVE, after, first, channels)
            self.lift(frame=after)

    # -- MIDI and mapping --------------------------------------------------------------------

    def key_on(self, key: Key | float, velocity: float, *, frame: int | None = None) -> None:
        """Press a key with a velocity (0 to 127); it plays as the mapping has it.

        A number is a key (fractional MIDI note) of no MIDI channel. Raises ParameterError where
        either is beyond MIDI's range.
        """
        key, other = Key.of(key), within_midi("velocity", velocity) / 127.0
        self.post(events.NOTE_ON, frame, key.channel, key.note, other)

    def key_off(self, key: Key | float, *, frame: int | None = None) -> None:
        """Let a key go, which ends its note unless a pedal keeps it; see `key_on`."""
        key = Key.of(key)
        self.post(events.NOTE_OFF, frame, key.channel, key.note)

    def receive(
        self, message: mido.Message | Sequence[int], *, frame: int | None = None, port: int = 0
    ) -> None:
        """Send a channel message or a system reset, or its bytes, of a port (16 channels each)."""
        data = message.bytes() if isinstance(message, BaseMessage) else message
        self.post(events.MESSAGE, frame, packed(data, port))

    def end_port_notes(self, port: int, *, frame: int | None = None) -> None:
        """End the notes of a port that is gone, and forget its moves, but those for all notes."""
        self.post(events.DISCONNECT, frame, port)

    def move(self, address: str, argument: float, *, frame: int | None = None) -> None:
        """Move the targets of an OSC address that the mapping binds; others move nothing."""
        self.post(events.CONTROL, frame, self.controls.number(address), argument)

    def remap(self, mapping: Mapping, *, frame: int | None = None) -> None:
        """Take another mapping while notes sound.

        Moves stay where their source is still bound. A parameter whose start value differs takes
        the new one, unless it was moved since.
        """
        with self._lock:
            self.mapping = mapping
            self._change_tables(frame)

    def know_programs(self) -> None:
        """Read again which presets MIDI programs select, where they do; those that changed."""
        if self._programs is None:
            return
        programs = self.presets.programs()
        with self._lock:
            if programs != self._programs:
                self._programs = programs
                self._change_tables(self.frame_of())

    def _change_tables(self, frame: int | None) -> None:
        slot = (self._slot + 1) % TABLE_SLOTS
        # Where the audio side still uses that slot, `finish_remap` comes back to it.
        self._has_stale_tables = int(self.record["tables"]) == slot
        if not self._has_stale_tables:
            self.instrument.tables[slot] = self._tables()[0]
            self._slot = slot
            # In the server's own queue, so that the tables come in this order.
            self.instrument.post(events.TABLES_TO, frame=self._at(frame), index=slot)

    def finish_remap(self) -> None:
        """Take a mapping or programs that came too soon after others; to be called now and then."""
        if self._has_stale_tables:
            with self._lock:
                self._change_tables(self._after_all(self.frame_of()))

    # -- by hand -----------------------------------------------------------------------------

    def slide(self, pitch: float, *, frame: int | None = None) -> float:
        """Slide the finger to a pitch (fractional MIDI note); return the pitch within range.

        The sounding note slides; in silence, the finger waits there for the bow.
        """
        pitch = RangePolicy.CLAMP.fit(pitch, self.notes) or pitch
        self.post(commands.SLIDE, frame, value=pitch)
        return pitch

    def draw(self, speed: float, force: float, *, frame: int | None = None) -> tuple[float, float]:
        """Draw the bow by hand at a speed (m/s) and force (N), on the string of the fingering.

        Takes the bow over as direct writes do; 0 and 0 lift it. Returns both as accepted.
        """
        speed, force = find("/bow/speed").clamped(speed), find("/bow/force").clamped(force)
        drawn = {"/bow/speed": speed, "/bow/force": force, "/bow/assist": 0.0}
        with self._lock:
            for address, value in drawn.items():
                self._note(address, value, frame)
            self.post(commands.DRAW, frame, value=speed, other=force)
        return speed, force

    def lift(self, *, frame: int | None = None) -> None:
        """Lift a bow drawn by hand, and return it to the player."""
        self.post(commands.LIFT, frame)
