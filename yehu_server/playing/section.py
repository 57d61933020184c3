"""A section: several people who play one part, each an instrument of their own.

It stands where the `Wishes` of one instrument do, and passes each wish on to the players: notes
at the frame at which each of them begins, which is at most ``section_timing.LATEST_MS`` after the
planned one; everything else as it is wished, but not before the note that was wished earlier.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from yehu_server.engine.instrument import Instrument
from yehu_server.params.table import ENGINE, TABLE
from yehu_server.player import wishes
from yehu_server.player.rows import ROW
from yehu_server.playing.range_policy import RangePolicy
from yehu_server.playing.section_divisi import CHORD_MS, deal
from yehu_server.playing.section_people import OWN, SECTION, SEED, own_value
from yehu_server.playing.section_timing import Together
from yehu_server.playing.style import Style
from yehu_server.playing.wishes import Key, Wishes

VARIATION = "/playing/variation"
SETTINGS = (wishes.WRITE, wishes.HOLD, wishes.EXPRESS)
Values = tuple[tuple[int, float], ...]  # of a note: rows and values


def section_wishes(style: Style, instruments: Sequence[Instrument]) -> Wishes:
    """What posts wishes of a style to the instruments of one part: one, or those of a section."""
    if len(instruments) == 1:
        return style.wishes(instruments[0])
    return Section(instruments, style.policy, lambda note: style.tuning.pitch(note, style.a4))


class Person:
    """One player of a section.

    Attributes
    ----------
    holds : dict
        Its held keys, in the order begun, and the frame of each.
    note : Key, optional
        Its note of the last chord.
    """

    def __init__(self, instrument: Instrument, number: int) -> None:
        self.instrument = instrument
        self.number = number
        self.holds: dict[Key, int] = {}
        self.note: Key | None = None
        self._wished, self._waits = 0, 0

    @property
    def sounding(self) -> Key | None:
        """The key that it plays; None in a rest."""
        return next(reversed(self.holds), None)

    def at(self, frame: int) -> int:
        """When to fulfil a wish for a frame: not before the note that was wished before it."""
        return self._waits if self._wished <= frame < self._waits else frame

    def act(self, frame: int, late: int) -> int:
        """When to begin or end what is wished for a frame; later wishes wait for it."""
        self._wished, self._waits = frame, max(self.at(frame), frame + late)
        return self._waits

    def tell(self, kind: int, at: int, key: Key, other: float) -> None:
        """Post a wish about a key."""
        self.instrument.post(kind, frame=at, index=key.channel, value=key.note, other=other)


class Section(Wishes):
    """Asks the players of a section for notes and parameters.

    Keys struck within ``CHORD_MS`` are a chord, whose notes the players divide; one line is played
    by all. Where a note of a chord ends, its players rest until the next note, which is theirs.

    Parameters
    ----------
    instruments : sequence of Instrument
        Those of ``section_people.section_makes``.
    policy, tuning
        See `Wishes`.
    """

    def __init__(
        self,
        instruments: Sequence[Instrument],
        policy: RangePolicy = RangePolicy.TRANSPOSE,
        tuning: Callable[[float], float | None] = float,
    ) -> None:
        first = instruments[0]
        self._all = [Person(instrument, number) for number, instrument in enumerate(instruments)]
        self._people = list(self._all)  # those who play
        self._together = Together(len(instruments), first.rate, first.seed)
        self._window = first.frames(CHORD_MS)
        self._chord: dict[Key, tuple[float, Values]] = {}  # pitches and values
        self._chord_at = 0
        self._dealt: list[Person] = []  # the players of the last onset
        self._is_divided = False
        self._values: list[tuple[int, float]] = []  # for the note that begins next
        self._ending: list[Key] = []  # keys that end together with the next
        self._told: Key | None = None  # the key whose players alone are told
        super().__init__(first, policy, tuning)
        self._value[SECTION] = float(len(instruments))

    @property
    def people(self) -> int:
        """How many players there are, whether they play or rest."""
        return len(self._all)

    @property
    def pitch(self) -> float | None:
        """The pitch of the first player who plays; see `Wishes.pitch`."""
        pitches = (float(person.instrument.meters()["pitch"]) for person in self._people)
        return next((pitch for pitch in pitches if not math.isnan(pitch)), None)

    @property
    def all_sounding(self) -> list[Key]:
        """The keys that sound, the one pressed last as the last of them."""
        self._forget_ended()
        played = {self._sounding, *(person.sounding for person in self._people)}
        return [key for key in self._held if key in played]

    def write(self, address: str, value: float, **options: Any) -> float:
        """Set any parameter of the table, of all players; see `Wishes.write`."""
        self._told = options.get("key")
        try:
            accepted = super().write(address, value, **options)
        finally:
            self._told = None
        if address == SECTION:
            self._let_play(round(accepted), options.get("frame"))
        elif address == VARIATION:
            self._together.variation = accepted
        elif address == SEED:
            self._together.begin(round(accepted))
        return accepted

    def _let_play(self, people: int, frame: int | None) -> None:
        """Let so many play; the others end their notes and rest."""
        if people == len(self._people):
            return
        frame = self._instrument.frame if frame is None else frame
        for person in self._all[people:]:
            self._end_keys(person, list(person.holds), (), person.act(frame, 0))
        self._people = self._all[:people]
        self._together.playing = people
        for address in OWN[1:]:
            kind = wishes.HOLD if self.keeps(address) else wishes.WRITE
            self._tell_all(kind, frame, ROW[address], self._value[address], 0.0)

    # -- passing wishes on ---------------------------------------------------------------------

    def _post(
        self, kind: int, frame: int | None, index: int = 0, value: float = 0.0, other: float = 0.0
    ) -> None:
        frame = self._instrument.frame if frame is None else frame
        if kind == wishes.EXPRESS:
            self._values.append((index, value))
        elif kind == wishes.BEGIN:
            self._begin(frame, Key(index, value), other)
        elif kind == wishes.END:
            self._ending.append(Key(index, value))
            if not other:
                self._end(frame)
        elif kind == wishes.SLIDE:
            self._slide(frame, value)
        else:
            self._tell_all(kind, frame, index, value, other)

    def _tell_all(self, kind: int, frame: int, index: int, value: float, other: float) -> None:
        for person in self._all:
            if self._told is not None and person.sounding not in (None, self._told):
                continue
            own = self._own(person, kind, index, value)
            at = person.at(frame)
            person.instrument.post(kind, frame=at, index=index, value=own, other=other)

    def _own(self, person: Person, kind: int, index: int, value: float) -> float:
        """The value of a parameter that is a player's own."""
        if kind in SETTINGS:
            address = TABLE[index].address
        elif kind == wishes.RAMP:
            address = ENGINE[index].address
        else:
            return value
        return own_value(address, value, person.number, len(self._people))

    # -- notes ---------------------------------------------------------------------------------

    def _begin(self, frame: int, key: Key, pitch: float) -> None:
        values, self._values = tuple(self._values), []
        is_chord = 0 <= frame - self._chord_at < self._window and key not in self._chord
        if is_chord and self._chord and all(other in self._held for other in self._chord):
            self._chord[key] = pitch, values
            self._divide(frame)
            return
        free = [person for person in self._people if not person.holds]
        self._is_divided = self._is_divided and 0 < len(free) < len(self._people)
        self._dealt = free if self._is_divided else list(self._people)
        self._chord, self._chord_at = {key: (pitch, values)}, frame
        late = self._together.onset(frame)
        for person in self._dealt:
            self._begin_key(person, key, person.act(frame, late[person.number]))

    def _divide(self, frame: int) -> None:
        """Deal the chord's notes anew among the players of the onset."""
        self._is_divided = True
        keys = list(self._chord)
        notes = deal(len(self._dealt), [pitch for pitch, _ in self._chord.values()])
        for person, note in zip(self._dealt, notes, strict=True):
            before, key = person.note, keys[note]
            if key != before:
                at = person.at(frame)  # before it began, the same stroke
                self._begin_key(person, key, at)
                if before is not None and before in person.holds:
                    self._end_keys(person, [before], (), at)

    def _begin_key(self, person: Person, key: Key, at: int) -> None:
        pitch, values = self._chord[key]
        person.note = key
        person.holds.pop(key, None)
        person.holds[key] = at
        self._express_to(person, values, at)
        person.tell(wishes.BEGIN, at, key, pitch)

    def _end(self, frame: int) -> None:
        values, self._values = tuple(self._values), []
        ending, self._ending = self._ending, []
        late = self._together.release(frame)
        for person in self._all:
            own = [key for key in ending if key in person.holds]
            if own:
                begun = max(person.holds[key] for key in own)
                at = person.act(frame, max(late[person.number], begun - frame))
                self._end_keys(person, own, values, at)

    def _end_keys(self, person: Person, keys: list[Key], values: Values, at: int) -> None:
        """End keys of a player; `values` are those of the key that sounds again."""
        for key in keys:
            del person.holds[key]
        if values and person.sounding == self._sounding:
            self._express_to(person, values, at)
        for key in keys:
            person.tell(wishes.END, at, key, float(key is not keys[-1]))

    def _express_to(self, person: Person, values: Values, at: int) -> None:
        for row, value in values:
            own = self._own(person, wishes.EXPRESS, row, value)
            person.instrument.post(wishes.EXPRESS, frame=at, index=row, value=own)

    def _slide(self, frame: int, pitch: float) -> None:
        """Slide the fingers of those who play the key pressed last; of all, where nobody does."""
        last = self._sounding
        playing = [p for p in self._people if last and p.sounding == last]
        for person in playing or self._people:
            person.instrument.post(wishes.SLIDE, frame=person.at(frame), value=pitch)

    def _forget_ended(self) -> None:
        before = self._rests
        super()._forget_ended()
        if self._rests != before:
            self._let_go()

    def _let_go(self) -> None:
        """Forget what is held."""
        for person in self._all:
            person.holds.clear()
        self._chord.clear()
        self._is_divided = False
