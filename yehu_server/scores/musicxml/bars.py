"""Read the bars of one part of a MusicXML file: notes, directions, bar lines."""

import re
from collections import Counter
from fractions import Fraction
from xml.etree.ElementTree import Element

from yehu_server.errors import ScoreError
from yehu_server.scores.musicxml.directions import DirectionReader
from yehu_server.scores.musicxml.elements import tell
from yehu_server.scores.musicxml.marks import VALUES, NoteMarks, number
from yehu_server.scores.musicxml.repeat_signs import RepeatSigns
from yehu_server.scores.score import nearest_key
from yehu_server.scores.written.layout import SEMITONES
from yehu_server.scores.written.notated import MAX_BEATS, MAX_NOTES, Mark
from yehu_server.scores.written.ornaments import Alters, around_in
from yehu_server.scores.written.repeats import MAX_TIMES, BarLines
from yehu_server.scores.written.swing import Swing, begin_of_beats, swing_notes
from yehu_server.scores.written.ticks import TICKS, Ticks, bounded, ticks_of
from yehu_server.scores.written.voices import RawBar, RawDirection, RawNote

MAX_DIVISIONS = 1 << 20  # of a quarter note
LOWEST, HIGHEST = 0.0, 127.0  # MIDI notes
_NUMBERS = re.compile(r"\d+")
SWUNG = ("eighth", "16th")


class BarReader:
    """Reads the bars of a part (<part>), in their order."""

    def __init__(self, part: Element, unknown: Counter[str], warnings: Counter[str]) -> None:
        self._unknown = unknown
        self._warnings = warnings
        # Some writers give the divisions after the first notes.
        first = next(map(_divisions, part.iterfind("measure/attributes/divisions")), None)
        self._divisions = Fraction(1) if first is None else first
        self._fifths = 0
        self._transposed = 0.0  # semitones
        self._lengths: dict[str | None, Ticks | None] = {}  # by how they are written
        self._metre: Ticks = 4 * TICKS
        self._beat: Ticks = TICKS
        self._ending: frozenset[int] = frozenset()  # that is open
        self._last_ending = (0, -1)  # the highest number of the last one, and its last bar
        self._bars = 0
        self._notes = 0
        self._head: RawNote | None = None  # what <chord/> belongs to, played or not
        self._graces: list[RawNote] = []  # grace notes before their note
        # Voices and pitches of lower notes of chords, which are not played, that are tied on.
        self._dropped: set[tuple[tuple[str, str], float]] = set()
        self._alters: dict[tuple[str, str], Alters] = {}  # of this bar, by staves and voices
        self._wavy: set[tuple[str, str]] = set()  # voices in which a trill goes on
        self._at: Ticks = 0
        self._bar = RawBar("", BarLines())
        self._signs = RepeatSigns()
        self._swing: Swing | None = None
        self._swings: list[tuple[Ticks, Swing | None]] = []  # of this bar, and from where
        self._last_length: Ticks = 0  # of the bar before

    def read(self, measure: Element) -> RawBar:
        """Read one <measure>. Raises ScoreError where it is longer, or fuller, than any music."""
        lines = BarLines(endings=self._ending)
        self._bar = bar = RawBar(measure.get("number", "")[:8], lines)
        self._bars += 1
        if self._ending:
            self._last_ending = max(self._ending), self._bars
        self._at = 0
        self._head = None
        self._graces = []
        self._alters = {}
        self._swings = [(0, self._swing)]
        directions = DirectionReader(bar.directions, lines.jumps, self._unknown)
        for child in measure:
            if child.tag == "note":
                self._note(child)
            elif child.tag == "attributes":
                self._attributes(child)
            elif child.tag in ("backup", "forward"):
                step = self._duration(child)
                self._at = max(self._at + (step if child.tag == "forward" else -step), 0)
                bar.length = max(bar.length, self._at)
            elif child.tag == "direction":
                directions.read(child, self._at, self._offset(child))
                for sound in child.iterfind("sound"):
                    self._read_swing(sound)
            elif child.tag == "sound":
                directions.sound(child, self._at)
                self._read_swing(child)
            elif child.tag == "barline":
                self._barline(child)
            elif child.tag in ("harmony", "figured-bass"):
                self._warnings["chord symbols are not played"] += 1
            self._at = bounded(self._at)  # divisions may change and change
            if self._at > MAX_BEATS * TICKS:
                raise ScoreError(f"has a bar longer than {MAX_BEATS} quarters")
        bar.notes = [note for note in bar.notes if "dropped" not in note.ties]
        tell(measure, bar.number, self._unknown)
        self._count(self._signs.fill(bar))
        self._swing_notes()
        if not bar.notes:  # rests may be longer than their bar, where they fill it
            bar.length = min(bar.length, self._metre) or self._metre
        return bar

    def _swing_notes(self) -> None:
        """Play pairs of notes as <swing> says, from where it says it."""
        bar = self._bar
        begin = begin_of_beats(bar.length, self._last_length, self._metre)
        ends = [at for at, _ in self._swings[1:]]
        for (at, swing), end in zip(self._swings, [*ends, None], strict=True):
            if swing is not None:
                notes = [n for n in bar.notes if n.at >= at and (end is None or n.at < end)]
                swing_notes(notes, swing, begin)
        self._last_length = bar.length

    def _read_swing(self, sound: Element) -> None:
        for swing in sound.iterfind("swing"):
            first, second = (int(number(swing.findtext(name))) for name in ("first", "second"))
            unit = (swing.findtext("swing-type") or "eighth").strip()
            is_even = swing.find("straight") is not None
            if not is_even and not (0 < first < 100 and 0 < second < 100 and unit in SWUNG):
                self._unknown[f"swing (bar {self._bar.number})"] += 1
            else:
                self._swing = None if is_even else Swing(ticks_of(VALUES[unit]), first, second)
                self._swings.append((self._at, self._swing))

    def _count(self, notes: int) -> None:
        self._notes += notes
        if self._notes > MAX_NOTES:
            raise ScoreError(f"has more than {MAX_NOTES} notes")

    def _offset(self, direction: Element) -> Ticks:
        text = direction.findtext("offset")
        offset = Fraction(int(number(text))) / self._divisions if text else Fraction(0)
        return max(self._at + ticks_of(offset), 0)

    def _duration(self, element: Element) -> Ticks:
        text = element.findtext("duration")
        if text not in self._lengths:
            value = number(text)
            is_usual = 0.0 <= value <= MAX_BEATS * MAX_DIVISIONS
            length = Fraction(value if is_usual else 0.0).limit_denominator(MAX_DIVISIONS)
            self._lengths[text] = ticks_of(length / self._divisions) if is_usual else None
        found = self._lengths[text]
        if found is None:
            self._warnings["durations below zero or beyond reason are left out"] += 1
        return found or 0

    # -- attributes and bar lines ------------------------------------------------------------

    def _attributes(self, attributes: Element) -> None:
        for child in attributes:
            if child.tag == "divisions":
                value = _divisions(child)
                if value is not None:
                    self._divisions, self._lengths = value, {}
                else:
                    self._warnings["divisions of zero or beyond reason are left out"] += 1
            elif child.tag == "key":
                self._fifths = int(min(max(number(child.findtext("fifths")), -7.0), 7.0))
            elif child.tag == "time":
                self._time(child)
            elif child.tag == "measure-style":
                self._signs.read(child, self._at, self._beat)
            elif child.tag == "transpose":
                semitones = number(child.findtext("chromatic"))
                self._transposed = semitones + 12.0 * number(child.findtext("octave-change"))
        if attributes.find("key") is not None and self._bar.fifths is None:
            # Of the key that sounds, which a transposing part does not write.
            fifths = self._fifths + 7 * int(self._transposed)
            self._bar.fifths = nearest_key(fifths) if self._transposed else fifths

    def _time(self, time: Element) -> None:
        quarters = Fraction(0)
        for beats, unit in zip(time.findall("beats"), time.findall("beat-type"), strict=False):
            count = sum(int(number(each)) for each in (beats.text or "").split("+")[:16])
            kind = int(number(unit.text))
            if count > 0 and 0 < kind <= 256:
                quarters += Fraction(4 * count, kind)
        if 0 < quarters <= 1000:
            self._metre = self._bar.metre = ticks_of(quarters)
            beat = Fraction(4, kind)
            if kind >= 8 and quarters > 3 * beat and quarters % (3 * beat) == 0:
                beat *= 3
            self._beat = ticks_of(beat)

    def _barline(self, barline: Element) -> None:
        lines = self._bar.lines
        for child in sorted(barline, key=lambda each: each.tag == "ending"):  # repeats first
            if child.tag == "repeat" and child.get("direction") == "forward":
                lines.forward = True
            elif child.tag == "repeat":
                times = number(child.get("times"), 2.0)
                lines.times = int(min(max(times, 2.0), MAX_TIMES))
            elif child.tag == "ending":
                self._read_ending(child)
            elif child.tag in ("segno", "coda"):
                lines.jumps.add(child.tag)
            elif child.tag in ("fermata", "wavy-line"):
                self._unknown[f"{child.tag} on a bar line"] += 1

    def _read_ending(self, ending: Element) -> None:
        numbers = _numbers(ending.get("number", ""))
        lines = self._bar.lines
        starts = ending.get("type") == "start"
        if starts or not lines.endings:  # one that ends and has not begun has one bar
            highest, last = self._last_ending
            follows = highest + 1 if last == self._bars - 1 else 1
            if not (starts and numbers):  # the number at an end may be left over from before
                numbers = frozenset({min(follows, MAX_TIMES)})
            if starts or self._bar.lines.times:
                lines.endings, lines.opens = numbers, True
        if lines.endings:
            self._last_ending = max(lines.endings), self._bars
        self._ending = lines.endings if starts else frozenset()

    # -- notes -------------------------------------------------------------------------------

    def _note(self, element: Element) -> None:
        is_grace = element.find("grace") is not None
        length = 0 if is_grace else self._duration(element)
        staff, own = element.findtext("staff") or "1", element.findtext("voice") or "1"
        note = RawNote(self._at, length, 0.0, (staff[:8], own[:8]), is_grace=is_grace)
        head = self._head
        is_chord = head is not None and element.find("chord") is not None
        if is_chord and head is not None:
            note.at, note.voice, note.is_grace = head.at, head.voice, head.is_grace
        else:
            self._at += length
            self._bar.length = max(self._bar.length, self._at)
            self._head = note
        is_rest = element.find("rest") is not None
        is_cue = element.find("cue") is not None
        if not is_rest and (is_cue or element.get("print-spacing") == "no"):  # as MuseScore has it
            what = "cue notes" if is_cue else "hidden notes without a place on the page"
            self._warnings[f"{what} are not played"] += 1
            return
        if is_rest:
            if element.find("notations/fermata") is not None:
                self._bar.directions.append(RawDirection(note.at, "sign", "fermata"))
            return
        pitch = self._pitch(element)
        if pitch is None:
            return
        self._count(1)
        note.pitch = pitch
        note.turns = _numbers(element.get("time-only", ""))
        if note.is_grace:
            value = VALUES.get((element.findtext("type") or "").strip(), Fraction(1, 2))
            note.length = ticks_of(value)
            grace = element.find("grace")
            note.is_after = grace is not None and grace.get("steal-time-previous") is not None
        elif length == 0:
            self._warnings["notes without a duration are left out"] += 1
            return
        self._ties(element, note)
        self._marks(element, note)
        self._spans(element, note)
        if self._dropped and "stop" in note.ties and (note.voice, note.pitch) in self._dropped:
            self._dropped.discard((note.voice, note.pitch))
            self._drop(note)
        notes = self._bar.notes
        last = notes[-1] if notes else None
        place = (note.at, note.voice, note.is_grace)
        if is_chord and last is not None and (last.at, last.voice, last.is_grace) == place:
            self._in_chord(last, note)
            return
        notes.append(note)
        if note.is_grace:
            self._graces.append(note)
            return
        for small in self._graces:  # it may stand on the other staff
            if small.voice[1] == note.voice[1]:
                small.voice = note.voice
        self._graces = [each for each in self._graces if each.voice[1] != note.voice[1]]

    def _in_chord(self, first: RawNote, note: RawNote) -> None:
        """Keep the highest note of a chord, with the marks of all."""
        self._warnings["lower notes of chords are not played"] += 1
        dropped = RawNote(note.at, note.length, note.pitch, note.voice, ties=note.ties)
        if ("dropped" not in note.ties, note.pitch) > ("dropped" not in first.ties, first.pitch):
            dropped.pitch, dropped.ties = first.pitch, first.ties
            first.pitch, first.ties, first.around = note.pitch, note.ties, note.around
        self._drop(dropped)
        first.marks += [mark for mark in note.marks if mark not in first.marks]
        first.ends += [end for end in note.ends if end not in first.ends]

    def _drop(self, note: RawNote) -> None:
        """Leave out a note; what it is tied to is left out, too, and not struck."""
        if "start" in note.ties:
            self._dropped.add((note.voice, note.pitch))
        note.ties |= {"dropped"}

    def _pitch(self, element: Element) -> float | None:
        pitch = element.find("pitch")
        letter = (pitch.findtext("step") or "").strip() if pitch is not None else ""
        if pitch is None or letter not in SEMITONES:
            self._warnings["notes without a pitch are not played"] += 1
            return None
        octave = number(pitch.findtext("octave"), 4.0)
        value = 12.0 * (octave + 1.0) + SEMITONES[letter] + number(pitch.findtext("alter"))
        value += self._transposed
        if not LOWEST <= value <= HIGHEST:
            self._warnings["notes beyond all instruments are left out"] += 1
            return None
        return value

    def _ties(self, element: Element, note: RawNote) -> None:
        for tie in (*element.iterfind("tie"), *element.iterfind("notations/tied")):
            kind = tie.get("type", "")
            note.ties |= {"start", "stop"} if kind == "continue" else {kind}

    def _spans(self, element: Element, note: RawNote) -> None:
        """Begin and end lines here; a wavy line after a trill lets the notes under it trill."""
        if note.voice in self._wavy and not note.is_grace:
            note.marks.append(Mark("trill"))
        is_trill = any(mark.name == "trill" for mark in note.marks)
        for notations in element.iterfind("notations"):
            for child in notations.iter():
                kind, which = child.get("type", ""), child.get("number", "1")[:8]
                if child.tag == "wavy-line" and is_trill:
                    (self._wavy.add if kind == "start" else self._wavy.discard)(note.voice)
                elif child.tag in ("slur", "glissando", "slide", "wavy-line"):
                    note.ends.append((child.tag, kind, which))
                elif child.tag == "tremolo" and child.get("type") in ("start", "stop"):
                    note.ends.append(("tremolo", child.get("type", ""), ""))

    def _marks(self, element: Element, note: RawNote) -> None:
        letter = (element.findtext("pitch/step") or "C").strip()
        octave = int(number(element.findtext("pitch/octave"), 4.0))
        place = letter, octave, number(element.findtext("pitch/alter"))
        alters, fifths = self._alters.setdefault(note.voice, {}), self._fifths
        if "stop" not in note.ties:  # tied over a bar line, an accidental is of its note alone
            alters[place[:2]] = place[2]
        note.around = around_in(place, alters, fifths)
        marks = NoteMarks(
            lambda alter: around_in(place, alters, fifths, alter),
            lambda name: self._unknown.update([name]),
        )
        for notations in element.iterfind("notations"):
            marks.read(notations)
            for dynamics in notations.iterfind("dynamics"):
                DirectionReader(self._bar.directions, set(), self._unknown).dynamics(
                    dynamics, note.at
                )
        note.marks = marks.marks


def _numbers(text: str) -> frozenset[int]:
    """The passes that endings and `time-only` name."""
    numbers = {int(number(each)) for each in _NUMBERS.findall(text[:64])}
    return frozenset(each for each in numbers if 0 < each <= MAX_TIMES)


def _divisions(element: Element) -> Fraction | None:
    """The divisions of a quarter note; None where they are zero or beyond reason."""
    value = Fraction(number(element.text)).limit_denominator(1000)
    return value if 0 < value <= MAX_DIVISIONS else None
