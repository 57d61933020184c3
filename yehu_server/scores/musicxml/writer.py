"""Write a score as MusicXML, unfolded, that `reader` reads as the same score."""

import math
from bisect import bisect_right
from collections import Counter, deque
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from yehu_server.scores.musicxml.marks import VALUES, MarkWriter
from yehu_server.scores.written import layout, notated
from yehu_server.scores.written.layout import PageBar, Piece, Placed
from yehu_server.scores.written.notated import Grace, Part, Span, Tempo, Written
from yehu_server.scores.written.words import WRITTEN_CHANGES, words_of_sign

HEAD = (
    b'<?xml version="1.0" encoding="UTF-8"?>\n<!DOCTYPE score-partwise PUBLIC '
    b'"-//Recordare//DTD MusicXML 4.0 Partwise//EN" '
    b'"http://www.musicxml.org/dtds/partwise.dtd">\n'
)
MAX_DIVISIONS, DEFAULT_DIVISIONS = 16_383, 5040  # of a quarter note
DOTTED = {Fraction(1): 0, Fraction(3, 2): 1, Fraction(7, 4): 2}
# Lengths that one sign has, the longest first, with its name and its dots.
SIGNED = sorted(
    ((value * factor, (name, dots)) for name, value in VALUES.items()
     for factor, dots in DOTTED.items()), reverse=True,
)  # fmt: skip
SIGNS_OF = dict(SIGNED)
LINES = {"slur": "slur", "glissando": "glissando", "portamento": "slide"}
MAX_LINES = 16  # of a kind, open at once


def musicxml_of(written: Written) -> tuple[bytes, dict[str, int]]:
    """Return a score as MusicXML, and what that cannot say: names, with counts."""
    lost: Counter[str] = Counter()
    divisions = math.lcm(*_denominators(written))
    if divisions > MAX_DIVISIONS:
        divisions = DEFAULT_DIVISIONS
        written, moved = layout.rounded(written, [divisions])
        lost["beats finer than 1/5040 of a quarter"] += moved
    root = Element("score-partwise", version="4.0")
    if written.title:
        SubElement(SubElement(root, "work"), "work-title").text = written.title
    encoding = SubElement(SubElement(root, "identification"), "encoding")
    SubElement(encoding, "software").text = "yehu-server"
    listed = SubElement(root, "part-list")
    bars = layout.page_bars(written)
    for number, part in enumerate(written.parts, start=1):
        name = SubElement(listed, "score-part", id=f"P{number}")
        SubElement(name, "part-name").text = part.name
        element = SubElement(root, "part", id=f"P{number}")
        own_tempi = number == 1 or any(span.name in WRITTEN_CHANGES for span in part.spans)
        tempi = written.tempi if own_tempi else ()
        _PartWriter(written, part, bars, divisions, lost).write(element, tempi)
    indent(root, " ")
    return HEAD + tostring(root, encoding="utf-8") + b"\n", dict(+lost)


def _denominators(written: Written) -> Iterable[int]:
    yield 1
    yield from (bar.beat.denominator for bar in written.bars)
    yield from (tempo.beat.denominator for tempo in written.tempi)
    for metre in written.metres:
        yield Fraction(metre.beat).limit_denominator(64).denominator
        yield Fraction(metre.quarters).limit_denominator(64).denominator
    for part in written.parts:
        for note in part.notes:
            yield from (note.beat.denominator, note.length.denominator)
        for each in layout.placed(part):
            yield each.beat.denominator


def _signed_lengths(length: Fraction, factor: Fraction) -> list[Fraction]:
    """Lengths that have a sign each, in a tuplet of some factor, and are as long together."""
    found = []
    left = length / factor
    while left > 0:
        fits = next((value for value, _ in SIGNED if value <= left), None)
        if fits is None:
            return [length]  # shorter than any sign
        found.append(fits * factor)
        left -= fits
    return found


class _PartWriter:
    def __init__(
        self,
        written: Written,
        part: Part,
        bars: Sequence[PageBar],
        divisions: int,
        lost: Counter[str],
    ) -> None:
        self._written, self._part, self._bars = written, part, bars
        self._divisions, self._lost = divisions, lost
        self._fifths = 0
        self._keys = list(written.keys)
        self._quarters: Fraction | None = None
        self._lines: dict[str, list[Span | None]] = {}  # those that are open, by kind
        self._marks = MarkWriter(lost)
        self._turns: list[tuple[Fraction, bool, Span]] = []  # a beat, and what ends there or begins
        self._fermatas = {sign.beat for sign in part.signs if sign.name == "fermata"}
        self._pieces = layout.pieces_of(part, bars)
        self._rests = {piece.begin for bar in self._pieces for piece in bar if piece.note is None}
        self._end = bars[-1].end if bars else Fraction(0)

    def write(self, element: Element, tempi: Sequence[Tempo]) -> None:
        """Write all bars into an element."""
        events = deque(filter(self._is_direction, layout.placed(self._part, tempi)))
        self._turns = list(self._ends_of_lines())
        for number, pieces in enumerate(self._pieces):
            bar = self._bars[number]
            measure = SubElement(element, "measure", number=bar.number)
            self._attributes(measure, bar, is_first=number == 0)
            self._marks.alters = {}
            is_last = number == len(self._bars) - 1
            for whole in pieces:
                factor = whole.factor
                for piece in layout.split(whole, _signed_lengths(whole.length, factor)):
                    while events and events[0].beat < piece.end:
                        self._direction(measure, events.popleft(), piece.begin)
                    self._piece(measure, piece, factor)
            while is_last and events:
                self._direction(measure, events.popleft(), bar.end)

    def _ends_of_lines(self) -> Iterator[tuple[Fraction, bool, Span]]:
        """The ends and beginnings of slurs and slides between different notes, the last first."""
        begins = [note.beat for note in self._part.notes]
        found: list[tuple[Fraction, bool, Span]] = []
        for span in self._part.spans:
            if span.name in LINES:
                first, last = (bisect_right(begins, at) - 1 for at in (span.begin, span.end))
                if 0 <= first < last and span.begin < self._part.notes[first].end:
                    found += [(span.begin, False, span), (span.end, True, span)]
                else:
                    self._lost[span.name] += 1
        return iter(sorted(found, key=lambda each: (-each[0], each[1])))

    def _attributes(self, measure: Element, bar: PageBar, *, is_first: bool) -> None:
        quarters = max(bar.quarters, bar.length)
        if is_first and bar.length < quarters:
            measure.set("implicit", "yes")
        found = Element("attributes")
        if is_first:
            SubElement(found, "divisions").text = str(self._divisions)
        while self._keys and self._keys[0].beat <= bar.begin:
            key = self._keys.pop(0)
            self._fifths = min(max(key.fifths, -7), 7)
            for old in found.findall("key"):
                found.remove(old)
            SubElement(SubElement(found, "key"), "fifths").text = str(self._fifths)
        figures = layout.signature(quarters)
        if figures is not None and quarters != self._quarters:
            self._quarters = quarters
            time = SubElement(found, "time")
            SubElement(time, "beats").text = str(figures[0])
            SubElement(time, "beat-type").text = str(figures[1])
        if is_first:
            clef = SubElement(found, "clef")
            SubElement(clef, "sign").text = "G"
            SubElement(clef, "line").text = "2"
        if len(found):
            measure.append(found)

    # -- notes -------------------------------------------------------------------------------

    def _piece(self, measure: Element, piece: Piece, factor: Fraction) -> None:
        note = piece.note
        if note is not None and piece.is_first:
            for grace in note.before:
                self._grace(measure, grace, is_after=False)
        element = SubElement(measure, "note")
        if note is None:
            SubElement(element, "rest")
        else:
            self._pitch(element, note.pitch, is_struck=piece.is_first)
        SubElement(element, "duration").text = str(round(piece.length * self._divisions))
        ties = (
            []
            if note is None
            else ["stop"] * (not piece.is_first) + ["start"] * (not piece.is_last)
        )
        for kind in ties:
            SubElement(element, "tie", type=kind)
        SubElement(element, "voice").text = "1"
        self._value(element, piece.length / factor)
        if factor != 1 and piece.length / factor in SIGNS_OF:
            change = SubElement(element, "time-modification")
            SubElement(change, "actual-notes").text = str(factor.denominator)
            SubElement(change, "normal-notes").text = str(factor.numerator)
        notations = Element("notations")
        for kind in ties:
            SubElement(notations, "tied", type=kind)
        if note is not None:
            self._note_lines(notations, piece)
            self._lost["pitches that move within a note"] += piece.is_first and bool(note.contour)
            self._marks.write(notations, note.pitch, note.marks_at(piece.begin), self._fifths)
        elif piece.begin in self._fermatas:
            SubElement(notations, "fermata")
        if len(notations):
            element.append(notations)
        if note is not None and piece.is_last:
            for grace in note.after:
                self._grace(measure, grace, is_after=True)

    def _note_lines(self, notations: Element, piece: Piece) -> None:
        """Begin and end slurs and slides at the note where they do."""
        while self._turns and self._turns[-1][0] < piece.end:
            _, is_end, span = self._turns.pop()
            kind = LINES[span.name]
            number = self._line(kind, span, is_end=is_end)
            if number is None:
                self._lost[span.name] += not is_end
                continue
            SubElement(notations, kind, {"type": "stop" if is_end else "start", "number": number})

    def _line(self, kind: str, span: Span, *, is_end: bool) -> str | None:
        """Begin or end a line; return the number that it has among those open, if there is room."""
        open_ = self._lines.setdefault(kind, [None] * MAX_LINES)
        sought = span if is_end else None
        at = next((at for at, each in enumerate(open_) if each is sought), None)
        if at is None:
            return None
        open_[at] = None if is_end else span
        return str(at + 1)

    def _grace(self, measure: Element, grace: Grace, *, is_after: bool) -> None:
        element = SubElement(measure, "note")
        words = {"steal-time-previous": "50"} if is_after else {"slash": "yes"}
        SubElement(element, "grace", words)
        self._pitch(element, grace.pitch)
        SubElement(element, "voice").text = "1"
        self._value(element, grace.length)
        if grace.marks:
            notations = SubElement(element, "notations")
            self._marks.write(notations, grace.pitch, grace.marks, self._fifths)

    def _pitch(self, element: Element, pitch: float, *, is_struck: bool = True) -> None:
        letter, alter, octave = layout.spelled(pitch, self._fifths)
        if is_struck:
            self._marks.alters[layout.LETTERS[letter], octave] = alter
        found = SubElement(element, "pitch")
        SubElement(found, "step").text = layout.LETTERS[letter]
        if alter:
            SubElement(found, "alter").text = f"{alter:g}"
        SubElement(found, "octave").text = str(octave)

    def _value(self, element: Element, length: Fraction) -> None:
        """Write the type and dots of a length, where there are any for it."""
        if length in SIGNS_OF:
            name, dots = SIGNS_OF[length]
            SubElement(element, "type").text = name
            for _ in range(dots):
                SubElement(element, "dot")

    # -- directions --------------------------------------------------------------------------

    def _is_direction(self, each: Placed) -> bool:
        """Whether something is written over the staff; counts what cannot be written at all."""
        what = each.what
        if isinstance(what, Tempo):
            return True
        if isinstance(what, Span):
            if what.name in WRITTEN_CHANGES and each.is_end:
                is_read = layout.ends_as_read(what, self._part, self._written, self._end)
                self._lost[f"how far a {what.name} goes"] += not is_read
            return what.name in notated.HAIRPINS or (
                what.name in WRITTEN_CHANGES and not each.is_end
            )
        if what.name in notated.DYNAMICS or what.name in notated.FORCED or what.name == "velocity":
            return True
        if words_of_sign(what.name, what.value) is not None:
            return True
        if what.name != "fermata" or what.beat not in self._rests:
            self._lost[what.name] += 1
        return False

    def _direction(self, measure: Element, each: Placed, now: Fraction) -> None:
        element = SubElement(measure, "direction")
        what = each.what
        kind = SubElement(element, "direction-type")
        sound: dict[str, str] = {}
        if isinstance(what, Tempo):
            metronome = SubElement(kind, "metronome")
            SubElement(metronome, "beat-unit").text = "quarter"
            SubElement(metronome, "per-minute").text = f"{what.quarters_per_minute:.4g}"
            sound = {"tempo": repr(what.quarters_per_minute)}
        elif isinstance(what, Span) and what.name in notated.HAIRPINS:
            number = self._line("wedge", what, is_end=each.is_end) or "1"
            form = "stop" if each.is_end else what.name
            SubElement(kind, "wedge", {"type": form, "number": number})
        elif isinstance(what, Span):
            SubElement(kind, "words").text = WRITTEN_CHANGES[what.name]
        elif what.name == "velocity":
            SubElement(kind, "words")
            sound = {"dynamics": repr((what.value or 80.0) / 0.9)}
        elif (text := words_of_sign(what.name, what.value)) is not None:
            SubElement(kind, "words").text = text
        else:
            SubElement(SubElement(kind, "dynamics"), what.name)
        offset = round((each.beat - now) * self._divisions)
        if offset:
            SubElement(element, "offset", sound="yes").text = str(offset)
        if sound:
            SubElement(element, "sound", sound)
