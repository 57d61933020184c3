"""A player of one instrument: notes and wishes in, moves of bow and finger out.

Who owns the bow and the fingers: this player, as long as notes sound. A direct write to
a parameter marked ``owned`` takes that one over until the next note begins or `release`
is called. Any parameter written with ``hold`` stays as it is until `release`, whatever
notes and controllers say (decisions/0006).
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

from yehu_server.errors import ParameterError
from yehu_server.params.spec import Place
from yehu_server.params.table import TABLE, find
from yehu_server.playing.bowing import ORDINARY, manner
from yehu_server.playing.calibration import OPEN_NOTES
from yehu_server.playing.fingering import Fingering, OpenStrings, RangePolicy, choose, stay
from yehu_server.playing.intonation import Intonation


class Sink(Protocol):
    """What a player moves: an ``engine.instrument.Instrument``, or a stand-in."""

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        """Let a parameter of the engine move to a value."""

    def silence(self, *, frame: int | None = None) -> None:
        """Stop the sound at once."""


@dataclass(frozen=True)
class Key:
    """What identifies a held note: where it came from and which key it is.

    `channel` is any number that tells sources apart; `note` may lie between the keys.
    """

    channel: int
    note: float


SILENCED = ("/bow/speed", "/bow/side", "/finger/1/press")
# A finger that is up may be put elsewhere at once; one that is down slides.
BEND_RAMP_MS = find("/playing/bend").smooth_ms
LANDING_MS = 5.0
CROSSING_MS = 20.0  # from one string to the other
# A loud note before a soft one has to die away before it may be turned up.
RISING_MS, FALLING_MS = 90.0, 15.0
# Standard deviations at full variation. By ear.
VARIED_SHARE = 0.1  # of bow speed and force
VARIED_CENTS = 6.0


class Performer:
    """Plays one note at a time, the last one; see the module's docstring for ownership.

    Parameters
    ----------
    sink : Sink
        The instrument.
    policy : RangePolicy
        What happens to notes out of range.
    open_strings : OpenStrings
        When C5 is played open.
    seed : int
        Of the variation between notes; the same seed plays the same.

    Attributes
    ----------
    expression : callable
        Asked at the beginning of each note, with its key, for parameters of the player that
        this note is to have: how a channel's bend and touch come with its notes.
    """

    def __init__(
        self,
        sink: Sink,
        intonation: Intonation | None = None,
        policy: RangePolicy = RangePolicy.TRANSPOSE,
        seed: int = 0,
        open_strings: OpenStrings = OpenStrings.ALWAYS,
    ) -> None:
        self._sink = sink
        self._open_strings = open_strings
        self._intonation = intonation or Intonation()
        self._policy = policy
        self._chance = random.Random(seed)  # noqa: S311 - for music, not secrets
        self._deviation = (0.0, 0.0, 0.0)  # of this note: speed, pressure, pitch; normal
        self._value = {p.address: p.default for p in TABLE if p.place is Place.PLAYER}
        self._held: dict[Key, float] = {}  # in the order pressed; values are fitted notes
        self._sounding: Key | None = None
        self._fingering: Fingering | None = None
        self._direction = -1.0  # so that the first stroke is a down-bow, v_b > 0
        self._began: int | None = None  # the frame of the stroke of the bow
        self._taken: set[str] = set()
        self._kept: set[str] = set()
        self._by_hand = False  # the bow is drawn by `draw`
        # The bow's relative position as asked, and as the note has it.
        self._beta = self._beta_now = find("/bow/position").default
        self._balance = 0.0  # dB
        self._bowing = ORDINARY  # how the sounding pitch is bowed
        # What a parameter of the player moves while a note sounds.
        self._followers: dict[str, tuple[Callable[[int | None], None], ...]] = {
            "/playing/bend": (self._follow_bend,),
            "/playing/press": (self._press,),
            # A faster bow pulls the pitch.
            "/playing/speed": (lambda frame: self._draw(frame, None), self._follow_bend),
            "/playing/pressure": (self._lean,),
            "/playing/assist": (self._set_assist,),
            "/playing/volume": (self._set_level,),
            "/playing/expression": (self._set_level,),
            "/body/evenness": (self._even_out,),
        }
        self.expression: Callable[[Key], Mapping[str, float]] = lambda _key: {}
        self.notes_played = 0
        self.notes_out_of_range = 0

    @property
    def pitch(self) -> float | None:
        """The pitch (fractional MIDI note) that the finger aims at while a note sounds."""
        return None if self._sounding is None else self._pitch

    @property
    def sounding(self) -> Key | None:
        """The key whose note sounds."""
        return self._sounding

    def value(self, address: str) -> float:
        """The present value of a parameter of the player. Errors: ParameterError."""
        try:
            return self._value[find(address).address]
        except KeyError:
            raise ParameterError(f"{address} is not held by the player") from None

    def write(
        self, address: str, value: float, *, frame: int | None = None, hold: bool = False
    ) -> float:
        """Set any parameter of the table; return the value it then has.

        Errors: ParameterError for an unknown address or a value that is not finite.
        """
        param = find(address)
        accepted = param.accept(value)
        if param.place is Place.ENGINE:
            if address == "/bow/position":  # what later notes start from
                self._beta = self._beta_now = accepted
            if param.owned:
                (self._kept if hold else self._taken).add(address)
                if address == "/bow/force":  # raw newtons are heard only without assist
                    self._take_over("/bow/assist", 0.0, frame, hold)
            return self._sink.write(address, accepted, frame=frame)
        if hold:
            self._kept.add(address)
        elif address in self._kept:
            return self._value[address]
        if self._value[address] == accepted:
            return accepted
        self._value[address] = accepted
        for follow in self._followers.get(address, ()):
            follow(frame)
        return accepted

    def release(self) -> None:
        """Give every parameter that was taken over back to the player."""
        self._taken.clear()
        self._kept.clear()
        self._by_hand = False

    def keeps(self, address: str) -> bool:
        """Whether a parameter was written with ``hold``."""
        return address in self._kept

    def holds(self, key: Key) -> bool:
        """Whether a key is held."""
        return key in self._held

    def held(self, channel: int) -> list[Key]:
        """The held keys of one channel, in the order pressed."""
        return [key for key in self._held if key.channel == channel]

    def note_on(self, key: Key, *, frame: int | None = None) -> bool:
        """Begin a note: legato where another sounds, else with a new stroke of the bow.

        Keys struck at one frame are one stroke, of the last of them.
        Returns whether there is such a note.
        """
        note = self._policy.fit(key.note)
        if note != key.note:
            self.notes_out_of_range += 1
        if note is None:
            return False
        self.notes_played += 1
        self._taken.clear()
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
        """End a note; the last one still held comes back, legato."""
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
            self._stop(frame)

    def all_notes_off(self, *, frame: int | None = None, channel: int | None = None) -> None:
        """End every note, or every note of one channel, as if the keys were let go."""
        ending = [key for key in self._held if channel in (None, key.channel)]
        self.notes_off(ending, frame=frame)

    def all_sound_off(self, *, frame: int | None = None, channel: int | None = None) -> None:
        """The same, and what still rings ends at once, unless another channel's note sounds."""
        self.all_notes_off(frame=frame, channel=channel)
        if self._sounding is None:
            self._fingering = None  # the hand comes off
            self._by_hand = False
            self._taken -= set(SILENCED)
            for address in SILENCED:
                self._move(address, 0.0, frame, LANDING_MS)
            self._sink.silence(frame=frame)

    def slide(self, pitch: float, *, frame: int | None = None) -> float:
        """Move the finger to a pitch (fractional MIDI note); return the one it takes.

        The sounding note goes there; without one, the finger waits there for the bow.
        """
        pitch = RangePolicy.CLAMP.fit(pitch) or pitch
        if self._sounding is not None:
            self._held[self._sounding] = pitch
            self._follow_bend(frame)
            return pitch
        fingering = self._choose(pitch, self._fingering)
        self._place(fingering, frame, BEND_RAMP_MS)
        if self._by_hand:
            self._sink.write("/bow/side", self._side, frame=frame, ramp_ms=CROSSING_MS)
        return pitch

    def draw(self, speed: float, force: float, *, frame: int | None = None) -> tuple[float, float]:
        """Draw the bow by hand: m/s and newtons, on the string that the finger or note chose.

        Takes the bow over as direct writes do; no speed and no force lifts it.
        Returns speed and force accepted.
        """
        speed = self.write("/bow/speed", speed, frame=frame)
        force = self.write("/bow/force", force, frame=frame)
        self._by_hand = speed != 0.0 or force != 0.0
        side = (self._side or 1.0) if self._by_hand else 0.0
        self.write("/bow/side", side, frame=frame)
        return speed, force

    def lift(self, *, frame: int | None = None) -> None:
        """Lift the bow where it is drawn by hand, and take it back."""
        if self._by_hand:
            for address in ("/bow/speed", "/bow/side"):
                self._sink.write(address, 0.0, frame=frame)
        self.release()

    def _start(self, key: Key, frame: int | None, *, legato: bool, at_once: bool = False) -> None:
        was = self._fingering
        self._sounding = key
        for address, wish in self.expression(key).items():
            if address not in self._kept:
                self._value[address] = find(address).accept(wish)
        self._deviation = (
            self._chance.gauss(0.0, 1.0),
            self._chance.gauss(0.0, 1.0),
            self._chance.gauss(0.0, 1.0),
        )
        if not legato:
            self._direction = -self._direction
        fingering = self._choose(self._pitch, was)
        self._place(fingering, frame, 0.0 if at_once else self._value["/playing/glide"])
        slurred = legato and not at_once
        crossing = slurred and was is not None and was.side != self._side
        attack = self._value["/playing/attack"]
        self._set_assist(frame)
        self._set_level(frame)
        self._even_out(frame)
        self._lean(frame)
        self._move("/bow/side", self._side, frame, CROSSING_MS if crossing else attack / 4.0)
        self._draw(frame, self._value["/playing/glide"] if slurred else attack)

    def _choose(self, pitch: float, hand: Fingering | None) -> Fingering:
        speed = self._speed_at(pitch)
        return choose(pitch, hand, self._intonation, speed, self._open_strings)

    def _stop(self, frame: int | None) -> None:
        self._sounding = None
        release = self._value["/playing/release"]
        self._move("/bow/speed", 0.0, frame, release)
        self._move("/bow/side", 0.0, frame, release)

    @property
    def _side(self) -> float:
        return self._fingering.side if self._fingering else 0.0

    @property
    def _pitch(self) -> float:
        """Fractional MIDI note the finger aims at."""
        note = self._held[self._sounding] if self._sounding is not None else 0
        stray = self._varied(2, VARIED_CENTS / 100.0)
        return note + self._value["/playing/bend"] + stray

    def _varied(self, which: int, spread: float) -> float:
        return self._value["/playing/variation"] * spread * self._deviation[which]

    def _set_assist(self, frame: int | None) -> None:
        self._move("/bow/assist", self._value["/playing/assist"], frame)

    def _set_level(self, frame: int | None) -> None:
        level = (self._value["/playing/volume"] * self._value["/playing/expression"]) ** 2
        self._move("/output/level", level, frame)

    def _speed_at(self, pitch: float) -> float:
        """Bow speed (m/s) for a pitch: as wished, as far as the note bears it."""
        wish = self._value["/playing/speed"] * (1.0 + self._varied(0, VARIED_SHARE))
        return min(wish, manner(pitch).top_speed)

    def _adapt(self, frame: int | None) -> None:
        """Bow a pitch that has slid as it wants to be bowed."""
        if manner(self._pitch) is not self._bowing:
            self._lean(frame)
            self._draw(frame, None)

    def _lean(self, frame: int | None) -> None:
        wish = self._value["/playing/pressure"] * (1.0 + self._varied(1, VARIED_SHARE))
        if self._sounding is None:
            self._move("/bow/pressure", wish, frame)
            return
        self._bowing = manner(self._pitch)
        self._move("/bow/pressure", self._bowing.pressure(wish), frame)
        position = self._beta * self._bowing.farther
        if position != self._beta_now and self._is_ours("/bow/position"):
            self._beta_now = position
            self._move("/bow/position", position, frame)

    def _even_out(self, frame: int | None) -> None:
        """Let the note be as loud as the others, as far as asked."""
        if self._sounding is None or self._fingering is None:
            return
        pitch, string = self._pitch, self._fingering.string
        heard = float(OPEN_NOTES[string]) if self._fingering.position is None else pitch
        speed, wish = self._speed_at(pitch), self._value["/playing/speed"]
        balance = self._intonation.balance_db(string, heard, speed, wish)
        balance *= self._value["/body/evenness"]
        ramp_ms = RISING_MS if balance > self._balance else FALLING_MS
        self._balance = balance
        self._move("/output/balance", balance, frame, ramp_ms)

    def _draw(self, frame: int | None, ramp_ms: float | None) -> None:
        if self._sounding is not None:
            speed = self._direction * self._speed_at(self._pitch)
            self._move("/bow/speed", speed, frame, ramp_ms)

    def _place(self, fingering: Fingering, frame: int | None, glide_ms: float) -> None:
        was_down = self._fingering is not None and self._fingering.position is not None
        self._fingering = fingering
        if fingering.position is not None:
            ramp = glide_ms if was_down else 0.0
            self._move("/finger/1/position", fingering.position, frame, ramp)
        self._press(frame)

    def _press(self, frame: int | None) -> None:
        down = self._fingering is not None and self._fingering.position is not None
        press = self._value["/playing/press"] if down else 0.0
        if down and self._sounding is not None:
            press = max(press, manner(self._pitch).press)
        self._move("/finger/1/press", press, frame, LANDING_MS)

    def _follow_bend(self, frame: int | None) -> None:
        if self._sounding is None or self._fingering is None:
            return
        pitch, string = self._pitch, self._fingering.string
        fingering = stay(pitch, string, self._intonation, self._speed_at(pitch))
        crossing = fingering.string != self._fingering.string
        self._adapt(frame)
        self._place(fingering, frame, BEND_RAMP_MS)
        self._even_out(frame)
        if crossing:
            self._move("/bow/side", self._side, frame, CROSSING_MS)

    def _take_over(self, address: str, value: float, frame: int | None, hold: bool) -> None:
        (self._kept if hold else self._taken).add(address)
        self._sink.write(address, value, frame=frame)

    def _move(
        self, address: str, value: float, frame: int | None, ramp_ms: float | None = None
    ) -> None:
        if self._is_ours(address):
            self._sink.write(address, value, frame=frame, ramp_ms=ramp_ms)

    def _is_ours(self, address: str) -> bool:
        return address not in self._taken and address not in self._kept
