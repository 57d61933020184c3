"""A written score: notes and the marks on them, before anybody has played it.

Readers of notation make a `Written`; `performed` decides what bow and fingers do. Beats are quarter
notes since the beginning, exact, with all repeats unfolded. Pitches are MIDI notes as they sound
(60 is C4), fractional for quarter tones.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import NamedTuple

from yehu_server.scores.score import COMMON_TIME, KeySignature, Metre

# Bounds for readers: what a file may ask for, repeats unfolded.
MAX_BYTES = 16 << 20  # of a file
MAX_NOTES = 100_000
MAX_BEATS = 400_000  # quarter notes; a day at 278 a minute
MAX_PARTS = 64
LOWEST_TEMPO, HIGHEST_TEMPO = 5.0, 1000.0  # quarter notes a minute
HAIRPINS = ("crescendo", "diminuendo")
DEFAULT_TEMPO = 100.0  # where none is written
MAX_NAMED = 12  # marks that were not understood
LONGEST_CHANGE = Fraction(8)  # quarters of a change of tempo, where nothing written ends it

# Marks on notes, and the meaning of their values; None stands for the default value.
MARKS: Mapping[str, str] = {
    "staccato": "short",
    "staccatissimo": "very short",
    "spiccato": "short, off the string",
    "tenuto": "held for its full length",
    "portato": "on one bow with its neighbours, but apart",
    "accent": "louder",
    "marcato": "much louder, and shorter",
    "soft-accent": "swells and fades",
    "stress": "a little louder",
    "unstress": "a little softer",
    "up-bow": "an up-bow",
    "down-bow": "a down-bow",
    "open-string": "no finger",
    "finger": "which finger, 0 (none) to 4",
    "inner-string": "on the inner string (F4)",
    "outer-string": "on the outer string (C5)",
    "pizzicato": "plucked, this note alone",
    "snap-pizzicato": "plucked hard",
    "articulation": "value: number of a row of `params.articulations`",
    "tremolo": "value: number of strokes through the stem, 1 to 8; None: as quick as hands go",
    "trill": "value: semitones up to the other note",
    "mordent": "with the note below; value: semitones down",
    "inverted-mordent": "with the note above; value: semitones up",
    "turn": "above, note, below, note; values: semitones up, and down",
    "inverted-turn": "below, note, above, note; values: semitones up, and down",
    "vibrato": "value: depth in cents; 0: none",
    "harmonic": "value: pitch that the finger touches, where it is written",
    "fermata": "values: how many times as long; and from which of its quarters on, of a tied note",
    "breath": "a short gap after it",
    "caesura": "time stops for a moment after it",
    "slide-in-up": "begins lower and slides into its pitch",
    "slide-in-down": "begins higher and slides into its pitch",
    "slide-out-up": "slides away upwards at its end",
    "slide-out-down": "slides away downwards at its end",
    "arpeggio": "no meaning for one note at a time",
}

# Names of spans. The notes of a span are those that begin from `begin` on and up to `end`,
# both included; a hairpin or a change of tempo is complete at `end`.
SPANS: Mapping[str, str] = {
    "slur": "its notes are on one bow",
    "glissando": "the finger slides from the first note to the last, all the way",
    "portamento": "the finger slides into the last note, late",
    "crescendo": "louder",
    "diminuendo": "softer",
    "ritardando": "value: the tempo at the end, as a share of that at the beginning",
    "accelerando": "value: the tempo at the end, as a multiple of that at the beginning",
}

# Signs at a beat, which hold from there on. MIDI velocities, by ear; mf is the keyboard's 80 at
# which parameters hold as they are.
DYNAMICS: Mapping[str, int] = {
    "pppp": 16, "ppp": 24, "pp": 36, "p": 50, "mp": 64, "mf": 80, "f": 96, "ff": 112, "fff": 122,
    "ffff": 127, "n": 10,
}  # fmt: skip
# One note of the first loudness, and then the second; None: as before.
FORCED: Mapping[str, tuple[str, str | None]] = {
    "sf": ("f", None), "sfz": ("ff", None), "sffz": ("fff", None), "fz": ("ff", None),
    "rf": ("f", None), "rfz": ("f", None), "fp": ("f", "p"), "sfp": ("f", "p"),
    "sfpp": ("f", "pp"), "sfzp": ("ff", "p"), "pf": ("p", "f"),
}  # fmt: skip
SIGNS: Mapping[str, str] = {
    **{name: f"velocity {velocity}" for name, velocity in DYNAMICS.items()},
    **{name: f"{first}, then {then or 'as before'}" for name, (first, then) in FORCED.items()},
    "velocity": "value: loudness as MIDI has it, 1 to 127",
    "pizz": "plucked from here on",
    "arco": "bowed again",
    "tremolo": "tremolo from here on, until `arco` or `ordinary`",
    "articulation": "value: number of a row of `params.articulations`, from here on until `arco`, "
    "`ordinary` or 0",
    "gesture": "value: the same, for the next note alone",
    "sul-ponticello": "near the bridge",
    "sul-tasto": "far from the bridge",
    "flautando": "a light, quick bow",
    "ordinary": "takes back place, lightness, tremolo and shortness of the bow's strokes",
    "legato": "all notes slurred until `non-legato`",
    "non-legato": "takes `legato` back",
    "staccato": "all notes short until `non-staccato`",
    "non-staccato": "takes `staccato` back",
    "vibrato": "value: depth in cents, 0 for none; from here on",
    "inner-string": "on the inner string from here on",
    "outer-string": "on the outer string from here on",
    "either-string": "takes the strings back",
    "fermata": "on a rest: time stops for a moment",
    "caesura": "time stops for a moment before it",
    "breath": "the note before ends a little early",
}


def times(text: str, count: int) -> str:
    """A warning, and the number of its occurrences."""
    return f"{text} ({count} times)" if count > 1 else text


def listed(names: Sequence[str], most: int) -> str:
    """Names for a line: the first of them, and the number of others."""
    more = [f"{len(names) - most} others"] if len(names) > most else []
    return ", ".join([*names[:most], *more])


class Mark(NamedTuple):
    """A mark on a note: a name of MARKS, and its values where it has any."""

    name: str
    value: float | None = None
    second: float | None = None


NO_NAMES = frozenset[str]()


@lru_cache(maxsize=4096)
def _names_of(marks: tuple[Mark, ...]) -> frozenset[str]:
    return frozenset(mark.name for mark in marks)


class Grace(NamedTuple):
    """A small note before or after another. It takes its time from that one."""

    pitch: float
    length: Fraction = Fraction(1, 2)  # as written, in quarters: only for showing
    marks: tuple[Mark, ...] = ()


class Note(NamedTuple):
    """A note as written, with tied ones joined to one."""

    # Where it begins and how long it is written, in quarters; the length is above 0.
    beat: Fraction
    length: Fraction
    pitch: float  # as it sounds; of a harmonic, what is heard
    marks: tuple[Mark, ...] = ()
    # Grace notes, in their order.
    before: tuple[Grace, ...] = ()
    after: tuple[Grace, ...] = ()
    # How the pitch moves within the note: points of a share of its length, 0 to 1 and ascending,
    # and of semitones from `pitch`, joined by straight lines. Empty: it stays.
    contour: tuple[tuple[float, float], ...] = ()

    @property
    def end(self) -> Fraction:
        """The beat at which it ends."""
        return self.beat + self.length

    @property
    def begins_at(self) -> float:
        """The beat at which it begins, as a float."""
        return self.beat.numerator / self.beat.denominator

    @property
    def ends_at(self) -> float:
        """The beat at which it ends, as a float: had much sooner than the fraction."""
        beat, length = self.beat, self.length
        under, its_under = beat.denominator, length.denominator
        return (beat.numerator * its_under + length.numerator * under) / (under * its_under)

    @property
    def held_from(self) -> Fraction:
        """The beat from which a fermata holds it, if it has one."""
        mark = self.marked("fermata")
        late = mark.second if mark is not None else None
        return self.beat + Fraction(late).limit_denominator(5040) if late else self.beat

    def marks_at(self, beat: Fraction) -> list[Mark]:
        """The marks to be written where it begins, or at what it is tied to."""
        return [
            mark._replace(second=None) if mark.name == "fermata" else mark
            for mark in self.marks
            if beat == (self.held_from if mark.name == "fermata" else self.beat)
        ]

    @property
    def names(self) -> frozenset[str]:
        """The names of its marks."""
        return _names_of(self.marks) if self.marks else NO_NAMES

    def marked(self, name: str) -> Mark | None:
        """The mark of a name, if it has one."""
        for mark in self.marks:
            if mark.name == name:
                return mark
        return None


class Span(NamedTuple):
    """A sign over several notes: a name of SPANS, and its first and last beat."""

    name: str
    begin: Fraction
    end: Fraction
    value: float | None = None


class Sign(NamedTuple):
    """A sign at a beat that holds from there on: a name of SIGNS."""

    beat: Fraction
    name: str
    value: float | None = None


@dataclass(frozen=True)
class Part:
    """The part of one player: one note at a time, in order of beats."""

    name: str
    notes: tuple[Note, ...]
    spans: tuple[Span, ...] = ()
    signs: tuple[Sign, ...] = ()

    @cached_property
    def begins_at(self) -> list[float]:
        """The beats at which its notes begin, as floats."""
        return [note.beat.numerator / note.beat.denominator for note in self.notes]

    @cached_property
    def names(self) -> list[frozenset[str]]:
        """The names of its notes' marks."""
        return [_names_of(note.marks) if note.marks else NO_NAMES for note in self.notes]

    @cached_property
    def ends_at(self) -> list[float]:
        """The beats at which its notes end, as floats."""
        return [note.ends_at for note in self.notes]

    def sounds_at(self, beat: Fraction) -> bool:
        """Whether a note sounds at a beat."""
        at = bisect_right(self.notes, beat, key=lambda note: note.beat) - 1
        return at >= 0 and beat < self.notes[at].end


class Tempo(NamedTuple):
    """A tempo, in quarter notes a minute, from a beat on."""

    beat: Fraction
    quarters_per_minute: float


class Bar(NamedTuple):
    """A bar line: the beat after it, and the bar's number as written."""

    beat: Fraction
    number: str


@dataclass(frozen=True)
class Written:
    """A score as written."""

    parts: tuple[Part, ...]
    # In order of beats. Without bars they are counted by the metres.
    tempi: tuple[Tempo, ...] = ()
    metres: tuple[Metre, ...] = (COMMON_TIME,)
    bars: tuple[Bar, ...] = ()
    title: str = ""
    # Marks that were not understood, as written (one printable line), and their numbers.
    unknown: Mapping[str, int] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()  # one line each, about anything else that is not as it should be
    keys: tuple[KeySignature, ...] = ()  # in order of beats; empty where none is written
    # One line each, which a player should know and which are no fault of the score.
    remarks: tuple[str, ...] = ()
    tune: int | None = None  # the part with the tune, from 0, where lines alone do not show it

    @property
    def not_understood(self) -> list[str]:
        """A line with all marks that were not understood; none where all were."""
        named = [times(mark, count) for mark, count in self.unknown.items()]
        return [f"not understood: {listed(named, MAX_NAMED)}"] if named else []

    @property
    def names(self) -> tuple[str, ...]:
        """A name for each part, unlike the others: that in the score, else its number."""
        found: list[str] = []
        for number, part in enumerate(self.parts, start=1):
            name = own = part.name or f"part {number}"
            count = 1
            while name in found:
                count += 1
                name = f"{own} ({count})"
            found.append(name)
        return tuple(found)

    @property
    def end(self) -> Fraction:
        """The beat at which the last note ends."""
        notes = (note for part in self.parts for note in part.notes)
        last = max(notes, key=lambda note: note.ends_at, default=None)
        return Fraction(0) if last is None else last.end

    def fifths_at(self, beat: Fraction) -> int:
        """The sharps of the key at a beat, below 0 flats; without a key 0."""
        at = bisect_right(self.keys, beat, key=lambda key: key.beat)
        return self.keys[at - 1].fifths if at else 0

    def place(self, beat: Fraction) -> tuple[str, Fraction]:
        """The bar of a beat, by its number, and the quarters since that bar began, from 0."""
        if self.bars:
            at = max(bisect_right(self.bars, beat, key=lambda bar: bar.beat) - 1, 0)
            return self.bars[at].number, beat - self.bars[at].beat
        number, begun = 1, Fraction(0)
        quarters = Fraction(4)
        for metre in self.metres:
            start = Fraction(metre.beat)
            if start > beat:
                break
            number += -((begun - start) // quarters)  # a bar that is cut short counts as one
            begun, quarters = start, Fraction(metre.quarters)
        whole = (beat - begun) // quarters
        return str(number + whole), beat - begun - whole * quarters
