"""Posts what is wished of the player: the only way from Python to bow and fingers.

The player decides in the audio callback (``yehu_server.player``). What it will do follows from
the wishes, so that parameters and held keys can be told at once, in the order of posting.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from yehu_server.engine.instrument import Instrument
from yehu_server.params.spec import Param
from yehu_server.params.table import SLOT, TABLE, find
from yehu_server.player import wishes
from yehu_server.player.fingering import OPEN_WITHIN
from yehu_server.player.rows import ROW
from yehu_server.playing.range_policy import RangePolicy


@dataclass(frozen=True)
class Key:
    """Identifies a held note by its channel and key.

    `channel` is any number that distinguishes sources; `note` may be fractional.
    """

    channel: int
    note: float


@dataclass(frozen=True)
class Pending:
    """A direct write: its value, its number among all wishes, and its frame."""

    value: float
    number: int
    frame: int


class Wishes:
    """Asks the player of an instrument for notes and parameters.

    Parameters
    ----------
    policy : RangePolicy
        What happens to notes out of range.
    tuning : callable
        Maps a key to its pitch, both fractional MIDI notes, or None; by default to itself.
    """

    def __init__(
        self,
        instrument: Instrument,
        policy: RangePolicy = RangePolicy.TRANSPOSE,
        tuning: Callable[[float], float | None] = float,
    ) -> None:
        self._instrument = instrument
        self._policy = policy
        self._tuning = tuning
        self._value = {p.address: p.default for p in TABLE if not p.owned}
        self._value["/engine/seed"] = find("/engine/seed").accept(instrument.seed)
        self._kept: set[str] = set()
        self._pending: dict[str, Pending] = {}
        self._held: dict[Key, int] = {}  # in the order pressed; the frame each begins at
        self._sounding: Key | None = None
        self._rests = 0  # number of those that ended all notes
        self.notes_played = 0
        self.notes_out_of_range = 0

    def _post(
        self, kind: int, frame: int | None, index: int = 0, value: float = 0.0, other: float = 0.0
    ) -> None:
        self._instrument.post(kind, frame=frame, index=index, value=value, other=other)

    @property
    def people(self) -> int:
        """How many players there are."""
        return 1

    # -- parameters --------------------------------------------------------------------------

    @property
    def pitch(self) -> float | None:
        """The pitch (fractional MIDI note) while a note sounds or the bow is drawn by hand."""
        pitch = float(self._instrument.meters()["pitch"])
        return None if math.isnan(pitch) else pitch

    def value(self, address: str) -> float:
        """The value of a parameter; one of bow and fingers may be moving to it.

        Raises
        ------
        ParameterError
            Where there is no such parameter.
        """
        param = find(address)
        return self._owned(param) if param.owned else self._value[param.address]

    def _owned(self, param: Param) -> float:
        """A value as just written, until the audio side has it."""
        pending = self._pending.get(param.address)
        if pending is not None:
            meters = self._instrument.meters()
            if meters["drained"] <= pending.number or meters["next_frame"] <= pending.frame:
                return pending.value
            del self._pending[param.address]
        return self._instrument.target(param.address)

    def write(
        self,
        address: str,
        value: float,
        *,
        frame: int | None = None,
        hold: bool = False,
        glide_ms: float = 0.0,
        key: Key | None = None,  # noqa: ARG002 - one instrument plays one key
    ) -> float:
        """Set any parameter of the table; return the value it then has.

        The moves of bow and fingers that follow take at least `glide_ms`. Where several keys
        sound (`all_sounding`), `key` is the one that it is for; by default it is for all.

        Raises
        ------
        ParameterError
            Where the address is unknown or the value is not finite.
        """
        param = find(address)
        accepted = param.accept(value)
        if address == "/playing/section":
            accepted = min(float(round(accepted)), float(self.people))
        if param.owned:
            self._note(address, accepted, frame)
            if address == "/bow/force":  # raw newtons are heard only without assist
                self._note("/bow/assist", 0.0, frame)
        elif address in self._kept and not hold:
            return self._value[address]
        else:
            self._value[address] = accepted
        if hold:
            self._kept.add(address)
        kind = wishes.HOLD if hold else wishes.WRITE
        self._post(kind, frame, ROW[address], accepted, glide_ms)
        return accepted

    def start_with(self, address: str, value: float) -> float:
        """Hold a parameter at a value, from the first sample on; see `write`."""
        accepted = self.write(address, value, hold=True)
        self.jump(address, accepted)
        return accepted

    def jump(self, address: str, value: float) -> None:
        """Have the engine begin with a value that a parameter was given, and not move there."""
        if address in SLOT:
            self._post(wishes.RAMP, None, SLOT[address], find(address).accept(value))

    def _note(self, address: str, value: float, frame: int | None) -> None:
        at = self._instrument.frame if frame is None else frame
        self._pending[address] = Pending(value, self._instrument.posted, at)

    def release(self, *, frame: int | None = None) -> None:
        """Return every parameter that was taken over to the player."""
        self._kept.clear()
        self._post(wishes.RELEASE, frame)

    def keeps(self, address: str) -> bool:
        """Whether a parameter was written with ``hold``."""
        return address in self._kept

    # -- notes -------------------------------------------------------------------------------

    @property
    def sounding(self) -> Key | None:
        """The key whose note sounds, if any."""
        self._forget_ended()
        return self._sounding

    @property
    def all_sounding(self) -> list[Key]:
        """The keys that sound at once: more than one where a section divides."""
        return [] if self.sounding is None else [self.sounding]

    def holds(self, key: Key) -> bool:
        """Whether a key is held."""
        self._forget_ended()
        return key in self._held

    def held(self, channel: int | None = None) -> list[Key]:
        """The held keys, of one channel or all, in the order pressed."""
        self._forget_ended()
        return [key for key in self._held if channel in (None, key.channel)]

    def _forget_ended(self) -> None:
        """Forget the notes that ended as the audio process died."""
        if len(self._instrument.rests) != self._rests:
            self._rests = len(self._instrument.rests)
            self._held.clear()
            self._sounding = None

    def has(self, key: Key) -> bool:
        """Whether the instrument has a note for a key."""
        return self._pitch(key) is not None

    def _pitch(self, key: Key) -> float | None:
        tuned = self._tuning(key.note)
        return None if tuned is None else self._policy.fit(tuned)

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

        Parameters
        ----------
        values : mapping
            Values of parameters, by address, for this note.
        tuned : float
            Its pitch (fractional MIDI note); by default as the tuning has it.
        """
        self._forget_ended()
        tuned = self._tuning(key.note) if tuned is None else tuned
        pitch = None if tuned is None else self._policy.fit(tuned)
        if tuned is None or pitch is None or abs(pitch - tuned) > OPEN_WITHIN:
            self.notes_out_of_range += 1
        if pitch is None:
            return False
        self.notes_played += 1
        self._held.pop(key, None)
        self._held[key] = self._instrument.frame if frame is None else frame
        self._sounding = key
        self._express(values, frame)
        self._post(wishes.BEGIN, frame, key.channel, key.note, pitch)
        return True

    def heir(self, keys: Iterable[Key]) -> Key | None:
        """The key that will sound again when these end; None where none will."""
        self._forget_ended()
        ending = set(keys)
        if self._sounding not in ending:
            return None
        return next((key for key in reversed(self._held) if key not in ending), None)

    def notes_off(
        self,
        keys: Iterable[Key],
        values: Mapping[str, float] | None = None,
        *,
        frame: int | None = None,
    ) -> None:
        """End several notes at once; of those still held the last one sounds again, legato.

        Parameters
        ----------
        values : mapping
            Values of parameters, by address, for the note that sounds again; see `heir`.
        """
        self._forget_ended()
        ending = list(dict.fromkeys(keys))
        # A note whose end comes before its beginning, as it was asked for ahead, ends as it begins.
        for key in ending:
            begun = self._held.pop(key, None)
            if frame is not None and begun is not None:
                frame = max(frame, begun)
        if self._sounding in ending:
            self._sounding = next(reversed(self._held), None)
            if self._sounding is not None:
                self._express(values, frame)
        for key in ending:
            more = float(key is not ending[-1])
            self._post(wishes.END, frame, key.channel, key.note, more)

    def note_off(
        self,
        key: Key,
        values: Mapping[str, float] | None = None,
        *,
        frame: int | None = None,
    ) -> None:
        """End a note; see `notes_off`."""
        self.notes_off([key], values, frame=frame)

    def _express(self, values: Mapping[str, float] | None, frame: int | None) -> None:
        for address, value in (values or {}).items():
            if address not in self._kept:
                self._value[address] = find(address).accept(value)
                self._post(wishes.EXPRESS, frame, ROW[address], self._value[address])

    def stop_sound(self, *, frame: int | None = None, is_panic: bool = False) -> None:
        """Lift bow and fingers and stop the sound at once, unless a note sounds.

        In a panic also what sounds ends, whatever is known of it here.
        """
        if is_panic or self.sounding is None:
            self._post(wishes.STOP, frame, value=float(is_panic))

    # -- by hand -----------------------------------------------------------------------------

    def slide(self, pitch: float, *, frame: int | None = None) -> float:
        """Slide the finger to a pitch (fractional MIDI note); return the pitch within range.

        The sounding note slides; in silence, the finger waits there for the bow.
        """
        pitch = RangePolicy.CLAMP.fit(pitch) or pitch
        self._post(wishes.SLIDE, frame, value=pitch)
        return pitch

    def draw(self, speed: float, force: float, *, frame: int | None = None) -> tuple[float, float]:
        """Draw the bow by hand at a speed (m/s) and force (N), on the string of the fingering.

        Takes the bow over as direct writes do; 0 and 0 lift it. Returns both as accepted.
        """
        speed, force = find("/bow/speed").accept(speed), find("/bow/force").accept(force)
        for address, value in (("/bow/speed", speed), ("/bow/force", force), ("/bow/assist", 0.0)):
            self._note(address, value, frame)
        self._post(wishes.DRAW, frame, value=speed, other=force)
        return speed, force

    def lift(self, *, frame: int | None = None) -> None:
        """Lift a bow drawn by hand, and return it to the player."""
        self._post(wishes.LIFT, frame)
