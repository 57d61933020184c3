"""Posts notes and parameters to a part, and reads the values that it has.

What the wishes come to is decided in compiled code (``midi``, ``player``), at their frames.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG_BYTES
from yehu_server.core.midi.events import NOTE_ON, RELEASE_ALL, SET
from yehu_server.core.midi.record import NONE, SECTION
from yehu_server.core.midi.tables import plain_tables
from yehu_server.core.player import wishes
from yehu_server.core.player.note_range import NoteRange
from yehu_server.core.player.rows import ROW
from yehu_server.params.spec import Param
from yehu_server.params.table import SLOT, find
from yehu_server.playing.mapping import Mapping as Binds
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, STANDARD_A4, RangePolicy, Tuning

UNMAPPED = Binds("", ())
OWN_VALUES = -1.0  # in place of a velocity: the note has been given its values


@dataclass(frozen=True)
class Key:
    """Identifies a held note by its channel and key.

    `channel` is any number that distinguishes sources; `note` may be fractional.
    """

    channel: int
    note: float


@dataclass(frozen=True)
class Pending:
    """A direct write: its value, its number among all events, and its frame."""

    value: float
    number: int
    frame: int
    is_held: bool


class WishPoster:
    """Asks the player of an instrument, or those of a section, for notes and parameters.

    `instruments` (Instrument, or sequence of Instrument): who plays the part; those of a section
    lie one after another on the stage.
    `policy`: what happens to notes out of range.
    `a4` (Hz).
    """

    def __init__(
        self,
        instruments: Instrument | Sequence[Instrument],
        policy: RangePolicy = RangePolicy.TRANSPOSE,
        tuning: Tuning = EQUAL,
        a4: float = STANDARD_A4,
    ) -> None:
        self._all = [instruments] if isinstance(instruments, Instrument) else list(instruments)
        self._instrument = self._all[0]
        places = [instrument.address for instrument in self._all]
        if places != [places[0] + number * RIG_BYTES for number in range(len(places))]:
            raise ValueError("the instruments of a section lie one after another on a stage")
        self.policy, self._tuning, self._a4 = policy, tuning, a4
        self.controls = Controls()
        self.pending: dict[str, Pending] = {}
        self._instrument.begin_part(self.tables(UNMAPPED), len(self._all))
        for other in self._all[1:]:
            other.begin_part(plain_tables(), 0)

    def tables(self, mapping: Binds, **more: Any) -> Any:
        """Tables of a mapping with this part's tuning and range; `more` as of `make_tables`."""
        more |= {"tuning": self._tuning, "a4": self._a4, "policy": self.policy}
        return make_tables(mapping, self.controls, notes=self.notes, **more)

    @property
    def notes(self) -> NoteRange:
        """The notes that the instrument has."""
        return self._instrument.spec.notes

    @property
    def instrument(self) -> Instrument:
        """The first instrument, which has the record of the part."""
        return self._instrument

    @property
    def people(self) -> int:
        """How many players there are, whether they play or rest."""
        return len(self._all)

    @property
    def record(self) -> Any:
        """The part's record (``midi.record.MIDI``), with all that is posted for now."""
        self._instrument.interpret_events()
        return self._instrument.midi

    def post(
        self, kind: int, frame: int | None, index: int = 0, value: float = 0.0, other: float = 0.0
    ) -> None:
        """Post an event (``midi.events``); without a frame, for now."""
        self._instrument.post(kind, frame=frame, index=index, value=value, other=other)

    # -- parameters --------------------------------------------------------------------------

    @property
    def pitch(self) -> float | None:
        """The pitch (fractional MIDI note) while a note sounds or the bow is drawn by hand."""
        pitches = (float(instrument.meters()["pitch"]) for instrument in self._all)
        return next((pitch for pitch in pitches if not math.isnan(pitch)), None)

    def value(self, address: str) -> float:
        """The value that a parameter has or moves to; raises ParameterError where there is none."""
        param = find(address)
        pending = self._waiting(param)
        if pending is not None:
            return pending.value
        if param.player_controlled:
            return self._instrument.target(param.address)
        return float(self.record["value"][ROW[param.address]])

    def _waiting(self, param: Param) -> Pending | None:
        """The last direct write to a parameter, while the audio side does not have it."""
        pending = self.pending.get(param.address)
        if pending is None:
            return None
        meters = self._instrument.meters()
        is_done = meters["drained"] > pending.number and meters["next_frame"] > pending.frame
        # An instrument that is not live interprets due events whenever its record is read.
        is_read = not self._instrument.is_live and pending.frame <= self._instrument.frame
        if is_done or (is_read and not param.player_controlled):
            del self.pending[param.address]
            return None
        return pending

    def write(
        self,
        address: str,
        value: float,
        *,
        frame: int | None = None,
        hold: bool = False,
        glide_ms: float = 0.0,
        kind: int = wishes.WRITE,
    ) -> float:
        """Set any parameter of the table; return the value it then has.

        The moves of bow and fingers that follow take at least `glide_ms`. Raises ParameterError
        where the address is unknown or the value is not finite.

        `kind`: of the event: a plain write, or one that counts as a move of a controller.
        """
        param = find(address)
        accepted = param.clamped(value)
        row = ROW[param.address]
        if row == SECTION:
            accepted = min(float(round(accepted)), float(self.people))
        if not param.player_controlled and not hold and self.keeps(address):
            accepted = self.value(address)
        self._note(param.address, accepted, frame, is_held=hold)
        if param.address == "/bow/force":  # raw newtons are heard only without assist
            self._note("/bow/assist", 0.0, frame, is_held=hold)
        self.post(wishes.HOLD if hold else kind, frame, row, accepted, glide_ms)
        return accepted

    def set(
        self, address: str, value: float, *, frame: int | None = None, glide_ms: float = 0.0
    ) -> float:
        """Set a parameter for all channels, until a controller moves it; see `write`."""
        return self.write(address, value, frame=frame, glide_ms=glide_ms, kind=SET)

    def start_with(self, address: str, value: float) -> float:
        """Hold a parameter at a value, from the first sample on; see `write`."""
        accepted = self.write(address, value, hold=True)
        self.jump(address, accepted)
        return accepted

    def jump(self, address: str, value: float) -> None:
        """Have the engine begin with a value that a parameter was given, and not move there."""
        if address in SLOT:
            self.post(wishes.RAMP, None, SLOT[address], find(address).clamped(value))

    def expect(self, values: Mapping[str, float], frame: int | None) -> None:
        """Answer with these values, but for held ones, until the audio side has what sets them."""
        for address, value in values.items():
            if not self.keeps(address):
                self._note(address, value, frame)

    def _note(
        self, address: str, value: float, frame: int | None, *, is_held: bool = False
    ) -> None:
        at = self._instrument.frame if frame is None else frame
        self.pending[address] = Pending(value, self._instrument.posted, at, is_held)

    def release(self, *, frame: int | None = None) -> None:
        """Return every parameter that was taken over to the player."""
        self.pending.clear()
        self.post(wishes.RELEASE, frame)

    def keeps(self, address: str) -> bool:
        """Whether a parameter was written with ``hold``."""
        pending = self._waiting(find(address))
        is_held = pending is not None and pending.is_held
        return is_held or bool(self.record["is_held"][ROW[find(address).address]])

    # -- notes -------------------------------------------------------------------------------

    @property
    def notes_played(self) -> int:
        """Number of notes that were begun."""
        return int(self.record["notes"])

    @property
    def notes_out_of_range(self) -> int:
        """Number of notes that the instrument does not have, played or not."""
        return int(self.record["out_of_range"])

    @property
    def sounding(self) -> Key | None:
        """The key whose note sounds, if any."""
        record = self.record
        return None if record["sounding"] == NONE else self._key(record, record["sounding"])

    def held(self, channel: int | None = None) -> list[Key]:
        """The held keys, of one channel or all, in the order pressed."""
        record = self.record
        keys = (self._key(record, number) for number in range(record["held"]))
        return [key for key in keys if channel in (None, key.channel)]

    @staticmethod
    def _key(record: Any, number: int) -> Key:
        return Key(int(record["held_channel"][number]), float(record["held_key"][number]))

    def has(self, key: Key) -> bool:
        """Whether the instrument has a note for a key."""
        tuned = self._tuning.pitch(key.note, self._a4)
        return tuned is not None and self.policy.fit(tuned, self.notes) is not None

    def note_on(
        self,
        key: Key,
        values: Mapping[str, float] | None = None,
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
        for address, value in (values or {}).items() if has_note else ():
            self.post(wishes.EXPRESS, frame, ROW[address], find(address).clamped(value))
        if tuned is None:
            self.post(NOTE_ON, frame, key.channel, key.note, OWN_VALUES)
        else:
            self.post(wishes.BEGIN, frame, key.channel, key.note, tuned)
        return has_note

    def notes_off(self, keys: Iterable[Key], *, frame: int | None = None) -> None:
        """End several notes at once; of those still held the last one sounds again, legato."""
        ending = list(dict.fromkeys(keys))
        for key in ending:
            more = float(key is not ending[-1])
            self.post(wishes.END, frame, key.channel, key.note, more)

    def note_off(self, key: Key, *, frame: int | None = None) -> None:
        """End a note; see `notes_off`."""
        self.notes_off([key], frame=frame)

    def end_all(self, *, frame: int | None = None) -> None:
        """End all notes, also those that were asked for ahead."""
        self.post(RELEASE_ALL, frame)

    def stop_sound(self, *, frame: int | None = None, is_panic: bool = False) -> None:
        """Lift bow and fingers and stop the sound at once, unless a note sounds.

        In a panic also what sounds ends.
        """
        self.post(wishes.STOP, frame, value=float(is_panic))

    # -- by hand -----------------------------------------------------------------------------

    def slide(self, pitch: float, *, frame: int | None = None) -> float:
        """Slide the finger to a pitch (fractional MIDI note); return the pitch within range.

        The sounding note slides; in silence, the finger waits there for the bow.
        """
        pitch = RangePolicy.CLAMP.fit(pitch, self.notes) or pitch
        self.post(wishes.SLIDE, frame, value=pitch)
        return pitch

    def draw(self, speed: float, force: float, *, frame: int | None = None) -> tuple[float, float]:
        """Draw the bow by hand at a speed (m/s) and force (N), on the string of the fingering.

        Takes the bow over as direct writes do; 0 and 0 lift it. Returns both as accepted.
        """
        speed, force = find("/bow/speed").clamped(speed), find("/bow/force").clamped(force)
        for address, value in (("/bow/speed", speed), ("/bow/force", force), ("/bow/assist", 0.0)):
            self._note(address, value, frame)
        self.post(wishes.DRAW, frame, value=speed, other=force)
        return speed, force

    def lift(self, *, frame: int | None = None) -> None:
        """Lift a bow drawn by hand, and return it to the player."""
        self.post(wishes.LIFT, frame)
