"""The bars of one part of a MusicXML file, as written: notes, directions, bar lines."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from fractions import Fraction
from xml.etree.ElementTree import Element

from yehu_server.errors import ScoreError
from yehu_server.scores.musicxml.directions import DirectionReader, RawDirection
from yehu_server.scores.musicxml.marks import STEPS, NoteMarks, neighbour, number, printable
from yehu_server.scores.musicxml.repeats import MOST_TIMES, BarLines
from yehu_server.scores.written.notated import MOST_BEATS, MOST_NOTES, Mark

MOST_DIVISIONS = 1 << 20  # of a quarter note
FINEST = 1 << 24  # the smallest part of a quarter note is this one
LOWEST, HIGHEST = 0.0, 127.0  # MIDI notes
TYPES = {
    "maxima": Fraction(32), "long": Fraction(16), "breve": Fraction(8), "whole": Fraction(4),
    "half": Fraction(2), "quarter": Fraction(1), "eighth": Fraction(1, 2), "16th": Fraction(1, 4),
    "32nd": Fraction(1, 8), "64th": Fraction(1, 16), "128th": Fraction(1, 32),
}  # fmt: skip
# What is printed, or sounds by other means than this instrument.
PRINTED = {
    "print", "listening", "link", "bookmark", "grouping", "figured-bass", "harmony",
}  # fmt: skip


@dataclass
class RawNote:
    """A note in its bar, before ties are joined; beats in quarters since the bar's beginning."""

    at: Fraction
    length: Fraction
    pitch: float
    voice: tuple[str, str]  # staff and voice
    marks: list[Mark] = field(default_factory=list)
    is_grace: bool = False
    is_after: bool = False  # a grace note that belongs to the note before it
    ties: set[str] = field(default_factory=set)  # start, stop
    # Spans that begin or end here: their name, `start` or `stop`, and their number.
    ends: list[tuple[str, str, str]] = field(default_factory=list)


@dataclass
class RawBar:
    """A bar as written."""

    number: str
    lines: BarLines
    notes: list[RawNote] = field(default_factory=list)
    directions: list[RawDirection] = field(default_factory=list)
    length: Fraction = Fraction(0)  # as filled
    metre: Fraction | None = None  # quarters in a bar, where a time signature stands


class BarReader:
    """Reads the bars of a part, in their order."""

    def __init__(self, unknown: Counter[str], warnings: Counter[str]) -> None:
        self._unknown = unknown
        self._warnings = warnings
        self._divisions = Fraction(1)
        self._fifths = 0
        self._transposed = 0.0  # semitones
        self._metre = Fraction(4)
        self._ending: frozenset[int] = frozenset()
        self._notes = 0
        self._at = Fraction(0)
        self._bar = RawBar("", BarLines())

    def read(self, measure: Element) -> RawBar:
        """Read one <measure>.

        Raises
        ------
        ScoreError
            Where it is longer, or has more notes, than any music.
        """
        lines = BarLines(endings=self._ending)
        self._bar = bar = RawBar(measure.get("number", "")[:8], lines)
        self._at = Fraction(0)
        directions = DirectionReader(bar.directions, lines.jumps, self._unknown)
        for child in measure:
            if child.tag == "note":
                self._note(child)
            elif child.tag == "attributes":
                self._attributes(child)
            elif child.tag in ("backup", "forward"):
                step = self._duration(child)
                self._at = max(self._at + (step if child.tag == "forward" else -step), Fraction(0))
                bar.length = max(bar.length, self._at)
            elif child.tag == "direction":
                directions.read(child, self._at, self._offset(child))
            elif child.tag == "sound":
                directions.sound(child, self._at)
            elif child.tag == "barline":
                self._barline(child)
            elif child.tag not in PRINTED:
                self._unknown[printable(child.tag)] += 1
            elif child.tag in ("harmony", "figured-bass"):
                self._warnings["chord symbols are not played"] += 1
            if self._at.denominator > FINEST:  # divisions that change and change
                self._at = self._at.limit_denominator(FINEST)
            if self._at > MOST_BEATS:
                raise ScoreError(f"has a bar longer than {MOST_BEATS} quarters")
        if not bar.notes:  # rests may be longer than their bar, where they fill it
            bar.length = min(bar.length, self._metre) or self._metre
        return bar

    def _offset(self, direction: Element) -> Fraction:
        """Where a direction stands."""
        offset = Fraction(int(number(direction.findtext("offset")))) / self._divisions
        return max(self._at + offset, Fraction(0))

    def _duration(self, element: Element) -> Fraction:
        value = number(element.findtext("duration"))
        if not 0.0 <= value <= MOST_BEATS * MOST_DIVISIONS:
            self._warnings["durations below zero or beyond reason are left out"] += 1
            return Fraction(0)
        return Fraction(value).limit_denominator(MOST_DIVISIONS) / self._divisions

    # -- attributes and bar lines ------------------------------------------------------------

    def _attributes(self, attributes: Element) -> None:
        for child in attributes:
            if child.tag == "divisions":
                value = Fraction(number(child.text)).limit_denominator(1000)
                if 0 < value <= MOST_DIVISIONS:
                    self._divisions = value
                else:
                    self._warnings["divisions of zero or beyond reason are left out"] += 1
            elif child.tag == "key":
                self._fifths = int(min(max(number(child.findtext("fifths")), -7.0), 7.0))
            elif child.tag == "time":
                self._time(child)
            elif child.tag == "transpose":
                semitones = number(child.findtext("chromatic"))
                self._transposed = semitones + 12.0 * number(child.findtext("octave-change"))

    def _time(self, time: Element) -> None:
        quarters = Fraction(0)
        for beats, unit in zip(time.findall("beats"), time.findall("beat-type"), strict=False):
            count = sum(int(number(each)) for each in (beats.text or "").split("+")[:16])
            kind = int(number(unit.text))
            if count > 0 and 0 < kind <= 256:
                quarters += Fraction(4 * count, kind)
        if 0 < quarters <= 1000:
            self._metre = self._bar.metre = quarters

    def _barline(self, barline: Element) -> None:
        lines = self._bar.lines
        for child in barline:
            if child.tag == "repeat" and child.get("direction") == "forward":
                lines.forward = True
            elif child.tag == "repeat":
                times = number(child.get("times"), 2.0)
                lines.times = int(min(max(times, 2.0), MOST_TIMES))
            elif child.tag == "ending":
                self._read_ending(child)
            elif child.tag in ("segno", "coda"):
                lines.jumps.add(child.tag)
            elif child.tag in ("fermata", "wavy-line"):
                self._unknown[f"{child.tag} on a bar line"] += 1

    def _read_ending(self, ending: Element) -> None:
        numbers = {
            int(number(each)) for each in ending.get("number", "1").replace(",", " ").split()[:16]
        }
        numbers = {each for each in numbers if 0 < each <= MOST_TIMES}
        if ending.get("type") == "start":
            self._ending = self._bar.lines.endings = frozenset(numbers)
        else:
            self._ending = frozenset()

    # -- notes -------------------------------------------------------------------------------

    def _note(self, element: Element) -> None:
        is_grace = element.find("grace") is not None
        is_chord = element.find("chord") is not None
        length = Fraction(0) if is_grace else self._duration(element)
        notes = self._bar.notes
        at = self._at
        if is_chord and notes and not is_grace:
            at = max(self._at - length, Fraction(0)) if notes[-1].is_grace else notes[-1].at
        elif not is_grace:
            self._at += length
            self._bar.length = max(self._bar.length, self._at)
        if element.find("cue") is not None:
            self._warnings["cue notes are not played"] += 1
            return
        if element.find("rest") is not None:
            if element.find("notations/fermata") is not None:
                self._bar.directions.append(RawDirection(at, "sign", "fermata"))
            return
        pitch = self._pitch(element)
        if pitch is None:
            return
        self._notes += 1
        if self._notes > MOST_NOTES:
            raise ScoreError(f"has more than {MOST_NOTES} notes")
        voice = ((element.findtext("staff") or "1")[:8], (element.findtext("voice") or "1")[:8])
        note = RawNote(at, length, pitch, voice, is_grace=is_grace)
        if is_grace:
            note.length = TYPES.get((element.findtext("type") or "").strip(), Fraction(1, 2))
            grace = element.find("grace")
            note.is_after = grace is not None and grace.get("steal-time-previous") is not None
        elif length == 0:
            self._warnings["notes without a duration are left out"] += 1
            return
        self._spans(element, note)
        self._marks(element, note)
        if is_chord and notes and notes[-1].voice == voice and notes[-1].is_grace == is_grace:
            self._in_chord(notes[-1], note)
        else:
            notes.append(note)

    def _in_chord(self, first: RawNote, note: RawNote) -> None:
        """Keep the highest note of a chord, with the marks of all."""
        self._warnings["lower notes of chords are not played"] += 1
        if note.pitch > first.pitch:
            first.pitch, first.ties = note.pitch, note.ties
        first.marks += [mark for mark in note.marks if mark not in first.marks]
        first.ends += [end for end in note.ends if end not in first.ends]

    def _pitch(self, element: Element) -> float | None:
        pitch = element.find("pitch")
        letter = (pitch.findtext("step") or "").strip() if pitch is not None else ""
        if pitch is None or letter not in STEPS:
            self._warnings["notes without a pitch are not played"] += 1
            return None
        octave = number(pitch.findtext("octave"), 4.0)
        value = 12.0 * (octave + 1.0) + STEPS[letter] + number(pitch.findtext("alter"))
        value += self._transposed
        if not LOWEST <= value <= HIGHEST:
            self._warnings["notes beyond all instruments are left out"] += 1
            return None
        return value

    def _spans(self, element: Element, note: RawNote) -> None:
        for tie in (*element.iterfind("tie"), *element.iterfind("notations/tied")):
            kind = tie.get("type", "")
            note.ties |= {"start", "stop"} if kind == "continue" else {kind}
        for notations in element.iterfind("notations"):
            for child in notations.iter():
                if child.tag in ("slur", "glissando", "slide", "wavy-line"):
                    kind, which = child.get("type", ""), child.get("number", "1")[:8]
                    note.ends.append((child.tag, kind, which))
                elif child.tag == "tremolo" and child.get("type") in ("start", "stop"):
                    note.ends.append(("tremolo", child.get("type", ""), ""))

    def _marks(self, element: Element, note: RawNote) -> None:
        letter = (element.findtext("pitch/step") or "C").strip()
        octave = int(number(element.findtext("pitch/octave"), 4.0))
        fifths = self._fifths

        def interval(way: int, alter: float | None) -> float:
            other = neighbour(letter, octave, way, fifths, alter) + self._transposed
            by = abs(other - note.pitch)
            return by if 0.5 <= by <= 4.0 else 2.0

        marks = NoteMarks(interval, lambda name: self._unknown.update([name]))
        for notations in element.iterfind("notations"):
            marks.read(notations)
            for dynamics in notations.iterfind("dynamics"):
                DirectionReader(self._bar.directions, set(), self._unknown).dynamics(
                    dynamics, note.at
                )
        note.marks = marks.marks
