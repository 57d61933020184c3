"""Bars as they stand on the page, and the voices of a part as they are played.

Readers of formats in bars, such as MusicXML and ABC, make these bars; `assembly` makes a `Written`
of them. In voices ties are joined, spans closed and repeats unfolded.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from operator import attrgetter
from typing import NamedTuple

from yehu_server.scores.written import notated
from yehu_server.scores.written.notated import Grace, Mark, Note, Part, Sign, Span
from yehu_server.scores.written.ornaments import HALF, WHOLE, Around, filled
from yehu_server.scores.written.repeats import BarLines
from yehu_server.scores.written.ticks import TICKS, Ticks, length_of, quarters_of
from yehu_server.scores.written.words import OpenSpan

# Where a tempo is from: of several at one beat the highest counts. What a program plays goes over
# what is printed, and figures over words.
RANKS = {"words": 0, "figures": 1, "playback": 2}
SPANS = {"slur": "slur", "glissando": "glissando", "slide": "portamento"}
MAX_VOICES = 16  # of a part; no music has more
MAX_WAVY = 100  # notes under a wavy line
LONGEST_HAIRPIN = Fraction(32)  # in words, where no sign ends it


@dataclass(slots=True)
class RawNote:
    """A note in its bar, before ties are joined; beats in ticks since the bar's beginning."""

    at: Ticks
    length: Ticks
    pitch: float
    voice: tuple[str, str]  # staff and voice
    marks: list[Mark] = field(default_factory=list)
    around: Around = (WHOLE, HALF)
    is_grace: bool = False
    is_after: bool = False  # a grace note that belongs to the note before it
    ties: frozenset[str] = frozenset()  # start, stop
    # Spans that begin or end here: their name, `start` or `stop`, and their number.
    ends: list[tuple[str, str, str]] = field(default_factory=list)
    turns: frozenset[int] = frozenset()  # the passes of a repeat in which it sounds; empty: all


class RawDirection(NamedTuple):
    """A direction at a beat of its bar."""

    at: Ticks
    # Sign, wedge, hairpin (words, until the next dynamic), dashes, change (of tempo), back (to
    # the tempo before) or tempo.
    kind: str
    # Of the sign or span; of a wedge also `stop`; of a tempo where it is from, in RANKS.
    name: str = ""
    value: float | None = None
    number: str = ""  # by which a wedge's end finds its beginning


@dataclass
class RawBar:
    """A bar as written."""

    number: str
    lines: BarLines
    notes: list[RawNote] = field(default_factory=list)
    directions: list[RawDirection] = field(default_factory=list)
    length: Ticks = 0  # as filled
    metre: Ticks | None = None  # of a whole bar, where a time signature stands
    fifths: int | None = None  # sharps of a key signature that stands here, below 0 flats


@dataclass(slots=True)
class Draft:
    """A note that may still grow, by what it is tied to; beats in ticks."""

    beat: Ticks
    length: Ticks
    pitch: float
    marks: tuple[Mark, ...] = ()
    before: tuple[Grace, ...] = ()
    after: tuple[Grace, ...] = ()

    @property
    def end(self) -> Ticks:
        """The beat at which it ends."""
        return self.beat + self.length

    def hold(self, length: Ticks, marks: Iterable[Mark], late: Ticks) -> None:
        """Let it go on with more marks; a fermata of them begins so late in it."""
        names = {mark.name for mark in self.marks}
        self.length += length
        self.marks += tuple(
            mark._replace(second=float(late / TICKS) or None) if mark.name == "fermata" else mark
            for mark in marks
            if mark.name not in names
        )

    def note(self) -> Note:
        """The note, in quarters."""
        beat, length = quarters_of(self.beat), length_of(self.length)
        return Note(beat, length, self.pitch, self.marks, self.before, self.after)


@dataclass
class Voice:
    """One voice, bar by bar."""

    notes: list[Draft] = field(default_factory=list)
    spans: list[Span] = field(default_factory=list)
    staff: list[Voice] = field(default_factory=list)  # all voices of its staff
    _graces: list[Grace] = field(default_factory=list)
    _tied: dict[float, int] = field(default_factory=dict)  # by pitch, the note that goes on
    _open: dict[tuple[str, str], Ticks] = field(default_factory=dict)

    def add_bar(self, notes: list[RawNote], begin: Ticks) -> None:
        """Add the notes of a bar that begins at a beat."""
        first = len(self.notes)
        for raw in sorted(notes, key=attrgetter("at")):
            if raw.is_grace:
                self._grace(raw, begin)
            else:
                self._note(raw, begin)
        if self._graces and len(self.notes) > first:  # small notes before the bar line
            self.notes[-1].after += tuple(self._graces)
            self._graces = []

    def _grace(self, raw: RawNote, begin: Ticks) -> None:
        grace = Grace(raw.pitch, length_of(raw.length), _marks(raw))
        if raw.ends:
            self._ends(raw, begin + raw.at)
        if raw.is_after and self.notes:
            self.notes[-1].after += (grace,)
        else:
            self._graces.append(grace)

    def _note(self, raw: RawNote, begin: Ticks) -> None:
        beat, notes = begin + raw.at, self.notes
        if raw.ends:
            self._ends(raw, beat)
        # Some writers write only the beginning of a tie.
        at = self._tied.pop(raw.pitch, None) if self._tied else None
        is_alone = at is None and "stop" in raw.ties
        if is_alone and any(voice.lengthen(raw, beat) for voice in self.staff):
            return
        marks = _marks(raw)
        if at is not None and notes[at].end == beat:
            notes[at].hold(raw.length, marks, notes[at].length)
        else:
            self._shorten_last(beat)
            at = len(notes)
            graces, self._graces = tuple(self._graces), []
            notes.append(Draft(beat, raw.length, raw.pitch, marks, graces))
        if "start" in raw.ties:
            self._tied[raw.pitch] = at
        if raw.ends:
            self._two_note_tremolo(raw)

    def lengthen(self, raw: RawNote, beat: Ticks) -> bool:
        """Let the last note last longer if it is one that another voice ties on; whether it is."""
        at = self._tied.get(raw.pitch)
        if at is None or at != len(self.notes) - 1 or self.notes[at].end != beat:
            return False
        self.notes[at].hold(raw.length, _marks(raw), self.notes[at].length)
        if "start" not in raw.ties:
            del self._tied[raw.pitch]
        return True

    def _shorten_last(self, beat: Ticks) -> None:
        """End what still sounds: one note at a time."""
        notes = self.notes
        while notes and notes[-1].beat + notes[-1].length > beat:
            last = notes[-1]
            if self._tied.get(last.pitch) == len(notes) - 1:
                del self._tied[last.pitch]
            if last.beat < beat:
                last.length = beat - last.beat
            else:
                notes.pop()

    def _ends(self, raw: RawNote, beat: Ticks) -> None:
        """Begin and end the spans of a note; those that end, first."""
        for kind in ("stop", "start"):
            for name, which, number in raw.ends:
                if which != kind or name == "tremolo":
                    continue
                if kind == "start":
                    self._open[name, number] = beat
                    if name == "wavy-line":
                        raw.marks.append(Mark("vibrato"))
                elif (name, number) in self._open:
                    opened = self._open.pop((name, number))
                    if name == "wavy-line":
                        self._vibrate(opened, raw)
                    else:
                        self.spans.append(_span(SPANS[name], opened, beat))

    def _vibrate(self, begin: Ticks, last: RawNote) -> None:
        """Let the notes after the first one of a wavy line have a vibrato, too."""
        if not any(mark.name == "vibrato" for mark in last.marks):
            last.marks.append(Mark("vibrato"))
        for at in range(len(self.notes) - 1, max(len(self.notes) - MAX_WAVY, 0) - 1, -1):
            note = self.notes[at]
            if note.beat <= begin:
                break
            note.hold(0, [Mark("vibrato")], 0)

    def _two_note_tremolo(self, raw: RawNote) -> None:
        """Two notes in quick turns: each trills with the other, on one bow."""
        if ("tremolo", "stop", "") not in raw.ends or len(self.notes) < 2:
            return
        one, other = self.notes[-2:]
        if one.end != other.beat or one.pitch == other.pitch:
            return
        step = other.pitch - one.pitch
        one.marks += (Mark("trill", step),)
        other.marks += (Mark("trill", -step),)
        self.spans.append(_span("slur", one.beat, other.beat))


def _span(name: str, begin: Ticks, end: Ticks) -> Span:
    return Span(name, quarters_of(begin), quarters_of(end))


def _marks(raw: RawNote) -> tuple[Mark, ...]:
    return tuple([filled(mark, raw.around) for mark in raw.marks]) if raw.marks else ()


class Directions:
    """The directions of one part, bar by bar."""

    def __init__(self) -> None:
        self.signs: list[Sign] = []
        self.spans: list[Span] = []
        self.tempi: dict[Fraction, tuple[int, float]] = {}  # with its rank
        self._wedges: dict[str, tuple[str, Fraction]] = {}
        self._hairpin = OpenSpan(self.spans, LONGEST_HAIRPIN)  # in words
        self._change = OpenSpan(self.spans, notated.LONGEST_CHANGE)
        self._steady: float | None = None  # the tempo before a change

    def add_bar(self, directions: list[RawDirection], begin: Ticks) -> None:
        """Add the directions of a bar that begins at a beat."""
        for raw in sorted(directions, key=attrgetter("at")):
            self._add(raw, quarters_of(begin + raw.at))

    def _add(self, raw: RawDirection, beat: Fraction) -> None:
        if raw.kind == "sign":
            if raw.name in notated.DYNAMICS or raw.name in notated.FORCED:
                self._hairpin.end(beat)
            sign = Sign(beat, raw.name, raw.value)
            same = (each for each in self.signs[-8:] if each.name == sign.name)
            if sign not in same:  # two staves may say the same
                self.signs.append(sign)
        elif raw.kind == "wedge" and raw.name in notated.HAIRPINS:
            self._hairpin.end(beat)
            self._wedges[raw.number] = (raw.name, beat)
        elif raw.kind == "wedge":
            name, opened = self._wedges.pop(raw.number, ("", beat))
            if opened < beat:
                self.spans.append(Span(name, opened, beat))
        elif raw.kind == "hairpin":
            self._hairpin.begin(raw.name, beat)
        elif raw.kind == "dashes" and raw.name == "stop":
            self._hairpin.end(beat)
        elif raw.kind == "change":
            self._change.begin(raw.name, beat)
        elif raw.kind in ("back", "tempo"):
            self._change.end(beat)
            tempo = self._steady if raw.kind == "back" else raw.value
            rank = RANKS.get(raw.name, 0)
            before = self.tempi.get(beat)
            if tempo is not None and (before is None or rank > before[0]):
                self.tempi[beat] = rank, tempo
                self._steady = tempo

    def end(self, beat: Fraction) -> None:
        """End what is still open at the end of the score."""
        self._hairpin.end(beat)
        self._change.end(beat)


def parts_of(
    name: str, bars: list[RawBar], played: list[tuple[int, Ticks]], end: Ticks
) -> tuple[list[Part], dict[Fraction, tuple[int, float]]]:
    """Return the voices of one part, and its tempi with their ranks (`RANKS`), by beats.

    `played` are the numbers of the bars in the order in which they are played, and their beats.
    """
    voices: dict[tuple[str, str], Voice] = {}
    for bar in bars:
        for note in bar.notes:
            if len(voices) < MAX_VOICES:
                voices.setdefault(note.voice, Voice())
    for (staff, _), each in voices.items():
        each.staff += [its for (other, _), its in voices.items() if other == staff]
    directions = Directions()
    passes: Counter[int] = Counter()
    for number, begin in played:
        if number >= len(bars):
            continue
        passes[number] += 1
        by_voice: dict[tuple[str, str], list[RawNote]] = {}
        for note in bars[number].notes:
            if not note.turns or passes[number] in note.turns:
                by_voice.setdefault(note.voice, []).append(note)
        for key, notes in by_voice.items():
            if key in voices:
                voices[key].add_bar(notes, begin)
        directions.add_bar(bars[number].directions, begin)
    directions.end(quarters_of(end))
    found, signs = [], tuple(directions.signs)
    staves = [staff for staff, _ in voices]
    for number, ((staff, voice), each) in enumerate(sorted(voices.items())):
        more = f", staff {staff}" if len({*staves}) > 1 else ""
        if staves.count(staff) > 1 and number:
            more += f", voice {voice}"
        spans = sorted(
            (*each.spans, *directions.spans), key=lambda span: (float(span.begin), float(span.end))
        )
        if each.notes:
            made = tuple([draft.note() for draft in each.notes])
            found.append(Part(name + more, made, tuple(spans), signs))
    return found, directions.tempi
