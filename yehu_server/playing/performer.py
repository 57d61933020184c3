"""The player of one instrument: turns notes and parameters into moves of bow and fingers.

The player owns bow and fingers while notes sound; see ``ownership``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from yehu_server.errors import ParameterError
from yehu_server.params.spec import TURNED_ON, Place
from yehu_server.params.table import TABLE, find
from yehu_server.playing.calibration import OPEN_NOTES
from yehu_server.playing.evenness import Evenness
from yehu_server.playing.fingering import (
    OPEN_WITHIN,
    Fingering,
    OpenStrings,
    RangePolicy,
    choose,
    stay,
)
from yehu_server.playing.intonation import Intonation
from yehu_server.playing.left_hand import LIFTING_MS, LeftHand
from yehu_server.playing.ownership import Ownership, Sink
from yehu_server.playing.right_hand import SLURRED_MS, RightHand
from yehu_server.playing.variation import Variation


@dataclass(frozen=True)
class Key:
    """Identifies a held note by its channel and key.

    `channel` is any number that distinguishes sources; `note` may be fractional.
    """

    channel: int
    note: float


BEND_RAMP_MS = find("/playing/bend").smooth_ms
# The level is this power of dynamics: together with the slower bow, dynamics 0.5 is some 12 dB
# below 1, and 0.1 some 35 dB. By ear.
DYNAMICS_EXPONENT = 1.5


class Performer:
    """Plays one note at a time, the last one.

    Parameters
    ----------
    sink : Sink
        The instrument.
    policy : RangePolicy
        What happens to notes out of range.
    open_strings : OpenStrings
        When C5 is played open.
    seed : int
        Seed of the variation between notes.
    tuning : callable
        Maps a key to its pitch, both fractional MIDI notes, or None; by default to itself.

    Attributes
    ----------
    expression : callable
        Returns values of parameters, by address, for the key of a note that begins.
    """

    def __init__(
        self,
        sink: Sink,
        intonation: Intonation | None = None,
        policy: RangePolicy = RangePolicy.TRANSPOSE,
        seed: int = 0,
        open_strings: OpenStrings = OpenStrings.ALWAYS,
        tuning: Callable[[float], float | None] = float,
    ) -> None:
        self._own = Ownership(sink)
        self._value = {p.address: p.default for p in TABLE if not p.owned}
        self._left = LeftHand(self._own, self._value.__getitem__)
        self._right = RightHand(self._own, self._value.__getitem__)
        self._open_strings = open_strings
        self._intonation = intonation or Intonation()
        self._policy = policy
        self._tuning = tuning
        self._variation = Variation(seed, self._value.__getitem__)
        self._value["/engine/seed"] = find("/engine/seed").accept(seed)
        self._held: dict[Key, float] = {}  # in the order pressed; values are notes within range
        self._sounding: Key | None = None
        self._began: int | None = None  # the frame at which the stroke of the bow began
        self._finger_pitch = float(OPEN_NOTES[0])  # the pitch that a finger last stopped
        self._by_hand = False  # whether the bow is drawn by `draw`
        self._speed = 0.0  # of a bow drawn by hand (m/s)
        self._evenness = Evenness(self._own, self._intonation, self._value.__getitem__)
        # The moves that follow a parameter of the player while a note sounds.
        self._followers: dict[str, tuple[Callable[[int | None], None], ...]] = {
            "/playing/bend": (self._follow_bend,),
            "/playing/press": (self._press,),
            "/playing/dynamics": (self._draw, self._follow_bend, self._set_level),
            # A faster bow changes the pitch.
            "/playing/speed": (self._draw, self._follow_bend),
            "/playing/pressure": (self._lean,),
            "/playing/bow_position": (self._lean,),
            "/playing/tremolo": (self._draw,),
            "/playing/vibrato": (self._left.rock,),
            "/playing/vibrato_press": (self._left.rock,),
            "/playing/vibrato_rate": (self._left.rock,),
            "/playing/assist": (self._set_assist,),
            "/playing/volume": (self._set_level,),
            "/playing/expression": (self._set_level,),
            "/body/evenness": (self._even_out,),
            "/engine/calibration": (self._trust, self._follow_bend),
            "/engine/seed": (self._seed,),
        }
        self.expression: Callable[[Key], Mapping[str, float]] = lambda _key: {}
        self.notes_played = 0
        self.notes_out_of_range = 0

    # -- parameters --------------------------------------------------------------------------

    @property
    def pitch(self) -> float | None:
        """The pitch (fractional MIDI note) while a note sounds or the bow is drawn by hand."""
        if self._sounding is not None:
            return self._pitch
        return self._finger_pitch if self._by_hand else None

    @property
    def sounding(self) -> Key | None:
        """The key whose note sounds, if any."""
        return self._sounding

    def value(self, address: str) -> float:
        """The value of a parameter.

        Raises
        ------
        ParameterError
            Where there is no such parameter, or the player moves it.
        """
        try:
            return self._value[find(address).address]
        except KeyError:
            raise ParameterError(f"{address} is moved by the player") from None

    def write(
        self,
        address: str,
        value: float,
        *,
        frame: int | None = None,
        hold: bool = False,
        glide_ms: float = 0.0,
    ) -> float:
        """Set any parameter of the table; return the value it then has.

        The moves of bow and fingers that follow take at least `glide_ms`.

        Raises
        ------
        ParameterError
            Where the address is unknown or the value is not finite.
        """
        param = find(address)
        accepted = param.accept(value)
        if param.owned:
            self._own.give_up(address, hold=hold)
            if address == "/bow/force":  # raw newtons are heard only without assist
                self._own.give_up("/bow/assist", hold=hold)
                self._own.sink.write("/bow/assist", 0.0, frame=frame)
            return self._own.sink.write(address, accepted, frame=frame)
        if hold:
            self._own.give_up(address, hold=True)
        elif self._own.keeps(address):
            return self._value[address]
        if self._value[address] == accepted:
            return accepted
        self._value[address] = accepted
        if param.place is Place.ENGINE:
            ramp_ms = max(param.smooth_ms, glide_ms)
            self._own.sink.write(address, accepted, frame=frame, ramp_ms=ramp_ms)
        with self._own.gliding(glide_ms):
            for follow in self._followers.get(address, ()):
                follow(frame)
        return accepted

    def release(self) -> None:
        """Return every parameter that was taken over to the player."""
        self._own.release()
        self._by_hand = False

    def keeps(self, address: str) -> bool:
        """Whether a parameter was written with ``hold``."""
        return self._own.keeps(address)

    # -- notes -------------------------------------------------------------------------------

    def holds(self, key: Key) -> bool:
        """Whether a key is held."""
        return key in self._held

    def held(self, channel: int) -> list[Key]:
        """The held keys of one channel, in the order pressed."""
        return [key for key in self._held if key.channel == channel]

    def note_on(self, key: Key, *, frame: int | None = None) -> bool:
        """Begin a note, legato where another sounds, else with a new stroke of the bow.

        Keys struck at one frame make one stroke. Returns whether the instrument has the note.
        """
        tuned = self._tuning(key.note)
        note = None if tuned is None else self._policy.fit(tuned)
        if tuned is None or note is None or abs(note - tuned) > OPEN_WITHIN:
            self.notes_out_of_range += 1
        if note is None:
            return False
        self.notes_played += 1
        self._own.take_back()
        self._by_hand = False
        legato = self._sounding is not None and self._sounding != key
        at_once = legato and frame is not None and frame == self._began
        self._held.pop(key, None)
        self._held[key] = note
        self._start(key, frame, legato=legato, at_once=at_once)
        if not legato:
            self._began = frame
        return True

    def note_off(self, key: Key, *, frame: int | None = None) -> None:
        """End a note; of those still held the last one sounds again, legato."""
        self.notes_off([key], frame=frame)

    def notes_off(self, keys: Iterable[Key], *, frame: int | None = None) -> None:
        """End several notes at once."""
        for key in keys:
            self._held.pop(key, None)
        if self._sounding is None or self._sounding in self._held:
            return
        if self._held:
            self._start(next(reversed(self._held)), frame, legato=True)
        else:
            self._sounding = None
            self._right.lift(self._value["/playing/release"], frame)

    def all_notes_off(self, *, frame: int | None = None, channel: int | None = None) -> None:
        """End all notes, or those of one channel, as if the keys were released."""
        ending = [key for key in self._held if channel in (None, key.channel)]
        self.notes_off(ending, frame=frame)

    def all_sound_off(self, *, frame: int | None = None, channel: int | None = None) -> None:
        """As `all_notes_off`, and stop the sound at once, unless another channel's note sounds."""
        self.all_notes_off(frame=frame, channel=channel)
        if self._sounding is None:
            self._by_hand = False
            self._own.take_back("/bow/speed", "/bow/side")
            self._right.lift(LIFTING_MS, frame)
            self._left.leave(frame)
            self._finger_pitch = float(OPEN_NOTES[0])
            self._own.sink.silence(frame=frame)

    # -- by hand -----------------------------------------------------------------------------

    def slide(self, pitch: float, *, frame: int | None = None) -> float:
        """Slide the finger to a pitch (fractional MIDI note); return the pitch within range.

        The sounding note slides; in silence, the finger waits there for the bow.
        """
        pitch = RangePolicy.CLAMP.fit(pitch) or pitch
        if self._sounding is not None:
            self._held[self._sounding] = pitch
            self._follow_bend(frame)
            return pitch
        self._finger_pitch = pitch
        self._left.stop(self._choose(pitch), frame, slide_ms=BEND_RAMP_MS)
        if self._by_hand:
            self._own.sink.write("/bow/side", self._left.side, frame=frame)
            self._even_out(frame)
        return pitch

    def draw(self, speed: float, force: float, *, frame: int | None = None) -> tuple[float, float]:
        """Draw the bow by hand at a speed (m/s) and force (N), on the string of the fingering.

        Takes the bow over as direct writes do; 0 and 0 lift it. Returns both as accepted.
        """
        speed = self.write("/bow/speed", speed, frame=frame)
        force = self.write("/bow/force", force, frame=frame)
        self._by_hand = speed != 0.0 or force != 0.0
        side = (self._left.side or 1.0) if self._by_hand else 0.0
        self.write("/bow/side", side, frame=frame)
        self._speed = abs(speed)
        self._even_out(frame)
        return speed, force

    def lift(self, *, frame: int | None = None) -> None:
        """Lift a bow drawn by hand, and return it to the player."""
        if self._by_hand:
            for address in ("/bow/speed", "/bow/side"):
                self._own.sink.write(address, 0.0, frame=frame)
        self._own.take_back()
        self._by_hand = False

    # -- the moves of a note -------------------------------------------------------------------

    def _start(self, key: Key, frame: int | None, *, legato: bool, at_once: bool = False) -> None:
        self._sounding = key
        for address, wish in self.expression(key).items():
            param = find(address)
            if param.place is Place.ENGINE:
                self.write(address, wish, frame=frame)
            elif not self._own.keeps(address):
                self._value[address] = param.accept(wish)
        self._variation.next_note()
        self._right.hurry, self._right.weight = self._variation.bow_factors()
        slide_ms = None
        if at_once:
            slide_ms = 0.0
        elif self._is_on("/playing/portamento"):
            slide_ms = self._value["/playing/portamento_time"]
        pitch = self._finger_pitch = self._pitch
        self._left.stop(self._choose(pitch), frame, pitch=pitch, slide_ms=slide_ms)
        self._left.rock(frame)
        self._left.begin_rocking(frame)
        self._set_assist(frame)
        self._set_level(frame)
        self._even_out(frame)
        self._lean(frame)
        if not legato:
            self._right.turn()
        if self._is_on("/playing/pizzicato"):
            self._right.pluck(self._left.side, frame)
        else:
            slurred = legato and not at_once
            self._draw(frame, SLURRED_MS if slurred else self._value["/playing/attack"])

    def _choose(self, pitch: float) -> Fingering:
        speed = self._right.wished_speed
        hand = self._left.fingering
        return choose(pitch, hand, self._intonation, speed, self._open_strings, self._string)

    @property
    def _string(self) -> int | None:
        """The string wished for; None for either."""
        wish = round(self._value["/playing/string"])
        return None if wish == 0 else wish - 1

    @property
    def _pitch(self) -> float:
        """Pitch (fractional MIDI note) of the sounding key, with its bend."""
        note = self._held[self._sounding] if self._sounding is not None else 0
        return note + self._value["/playing/bend"] + self._variation.semitones

    def _is_on(self, address: str) -> bool:
        return self._value[address] >= TURNED_ON

    def _trust(self, _frame: int | None) -> None:
        self._intonation.trust = self._value["/engine/calibration"]

    def _seed(self, _frame: int | None) -> None:
        self._variation.seed(int(self._value["/engine/seed"]))

    def _set_assist(self, frame: int | None) -> None:
        self._own.move("/bow/assist", self._value["/playing/assist"], frame)

    def _set_level(self, frame: int | None) -> None:
        level = (self._value["/playing/volume"] * self._value["/playing/expression"]) ** 2
        level *= self._value["/playing/dynamics"] ** DYNAMICS_EXPONENT
        self._own.move("/output/level", level, frame)

    def _draw(self, frame: int | None, ramp_ms: float | None = None) -> None:
        if self._sounding is not None and not self._is_on("/playing/pizzicato"):
            self._right.draw(self._pitch, self._left.side, frame, ramp_ms)

    def _lean(self, frame: int | None) -> None:
        self._right.lean(None if self._sounding is None else self._pitch, frame)

    def _press(self, frame: int | None) -> None:
        self._left.press(frame, None if self._sounding is None else self._pitch)

    def _even_out(self, frame: int | None) -> None:
        """Set the gain that evens out the loudness of notes."""
        if (pitch := self.pitch) is not None:
            speed = self._speed if self._by_hand else self._right.wished_speed
            self._evenness.follow(self._left.fingering, pitch, speed, frame)

    def _follow_bend(self, frame: int | None) -> None:
        if self._sounding is None or self._left.fingering is None:
            return
        pitch, string = self._pitch, self._left.fingering.string
        self._finger_pitch = pitch
        speed = self._right.wished_speed
        fingering = stay(pitch, string, self._intonation, speed, self._string)
        if not self._right.bows_alike(pitch):
            self._lean(frame)
            self._draw(frame)
        self._left.stop(fingering, frame, pitch=pitch, slide_ms=BEND_RAMP_MS)
        self._even_out(frame)
        if fingering.string != string:
            self._draw(frame)
