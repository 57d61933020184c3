"""Make the notes, spans and signs of a part from its elements, in the order of playing."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from yehu_server.scores.jianpu.characters import Contour, living
from yehu_server.scores.jianpu.form import Element, MetreMark
from yehu_server.scores.jianpu.mark_words import THERE_AND_BACK
from yehu_server.scores.jianpu.note_words import Kind
from yehu_server.scores.score import KeySignature, Metre
from yehu_server.scores.written import notated
from yehu_server.scores.written.notated import Mark, Note, Sign, Span, Tempo
from yehu_server.scores.written.ornaments import filled
from yehu_server.scores.written.words import Meaning, OpenSpan

TREMOLO_NOTE = Fraction(1, 8)  # of a tremolo between two notes: a demisemiquaver
MAX_TREMOLO_NOTES = 20_000


@dataclass(slots=True)
class _Draft:
    """A note that may still grow, by ties and dashes."""

    note: Note
    element: Element
    end: Fraction  # the beat at which it ends
    returns: bool = False  # slides away and back
    late: Fraction = Fraction(0)  # where what it is tied to begins, from its beginning

    def grow(self, more: Element, marks: Iterable[Mark], end: Fraction) -> None:
        """Let it go on with another element, up to a beat."""
        note, self.end = self.note, end
        if more.kind is Kind.NOTE:
            self.late = note.length
        grown = note.longer(more.length, marks, self.late)
        self.note = grown._replace(after=(*note.after, *more.after)) if more.after else grown


class PartBuilder:
    """Builds the notes, spans, signs, tempi and metres of a part, as lists.

    `end` is the beat after the last note or rest; with `has_pickup` a metre begins with a short
    bar.
    """

    def __init__(self, begin: Fraction, notices: Counter[str]) -> None:
        self.end, self.has_pickup = begin, False
        self.notes: list[Note] = []
        self.spans: list[Span] = []
        self.signs: list[Sign] = []
        self.tempi: list[Tempo] = []
        self.metres: list[Metre] = []
        self.keys: list[KeySignature] = []
        self._notices = notices
        self._drafts: list[_Draft] = []
        self._fifths: int | None = None
        self._tied = False
        self._slurs: list[Fraction] = []
        self._hairpin = OpenSpan(self.spans)
        self._change = OpenSpan(self.spans, notated.LONGEST_CHANGE)  # of tempo
        self._glissando: Fraction | None = None
        self._tempo = notated.DEFAULT_TEMPO

    def build(self, elements: Sequence[object]) -> None:
        """Take all elements, in the order of playing."""
        for element in elements:
            if isinstance(element, Element):
                self._sound(element)
            elif isinstance(element, MetreMark):
                self._metre(element)
            elif isinstance(element, Meaning):
                self._act(element, self.end)
        self._untied()
        self._hairpin.end(self.end)
        self._change.end(self.end)
        if self._slurs:
            self._notices["slurs without an end left out"] += len(self._slurs)
        for draft in self._drafts:
            self._finish(draft)

    # ------------------------------------------------------------ in time

    def _sound(self, element: Element) -> None:
        begin = self.end
        self.end = begin + element.length
        if element.fifths is not None and element.fifths != self._fifths:
            self._fifths = element.fifths
            self.keys.append(KeySignature(begin, element.fifths))
        last = self._drafts[-1] if self._drafts else None
        goes_on = last is not None and last.end == begin
        if element.kind is Kind.NOTE and element.pitch is not None:
            self._note(element, element.pitch, begin, last if goes_on else None)
        elif element.kind is Kind.DASH and last is not None and goes_on:
            last.grow(element, _marks(element), self.end)
        else:
            self._rest(element, begin)
        for action in element.actions:
            self._act(action, begin)

    def _rest(self, element: Element, begin: Fraction) -> None:
        if element.length:
            self._untied()
        for mark in _marks(element):
            if mark.name in notated.SIGNS:  # such as a fermata
                self.signs.append(Sign(begin, mark.name, mark.value))
            else:
                self._notices["marks on rests left out"] += 1

    def _note(self, element: Element, pitch: float, begin: Fraction, last: _Draft | None) -> None:
        marks = _marks(element)
        if self._tied and last is not None and last.note.pitch == pitch and not element.before:
            last.grow(element, marks, self.end)
            self._tied = False
            return
        self._untied()
        if self._glissando is not None:
            self._span("glissando", self._glissando, begin)
            self._glissando = None
        note = Note(begin, element.length, pitch, tuple(marks), element.before, element.after)
        self._drafts.append(_Draft(note, element, self.end))

    def _act(self, action: Meaning, begin: Fraction) -> None:
        kind, name, value = action.kind, action.name, action.value
        last = self._drafts[-1] if self._drafts else None
        onset = begin if last is None else last.note.beat  # of the note that the word is written at
        if kind == "sign":
            if name in notated.DYNAMICS or name in notated.FORCED:
                self._hairpin.end(begin)
            self.signs.append(Sign(begin, name, value))
        elif kind == "slur":
            self._slurs.append(onset)
        elif kind == "slur end" and self._slurs:
            self._span("slur", self._slurs.pop(), onset)
        elif kind == "slur end":
            self._notices["ends of slurs that did not begin left out"] += 1
        elif kind == "tie":
            self._tied = True
        elif kind == "hairpin":
            self._hairpin.begin(name, begin)
        elif kind == "hairpin end":
            self._hairpin.end(begin)
        elif kind == "glissando":
            self._glissando = onset
        elif kind == "contour" and last is not None:
            last.returns = True
        elif kind == "change":
            self._change.begin(name, begin)
        elif kind in ("tempo", "back"):
            self._change.end(begin)
            self._tempo = self._tempo if value is None else value
            self.tempi.append(Tempo(begin, self._tempo))

    def _untied(self) -> None:
        if self._tied:
            self._notices["ties between different notes left out (a slur is written ( ) )"] += 1
        self._tied = False

    def _span(self, name: str, begin: Fraction, end: Fraction) -> None:
        if end > begin:
            self.spans.append(Span(name, begin, end))

    def _metre(self, mark: MetreMark) -> None:
        if mark.first < mark.bar:
            self.has_pickup = True
            self.metres.append(Metre(float(self.end), float(mark.first)))
        self.metres.append(Metre(float(self.end + mark.first % mark.bar), float(mark.bar)))

    # ------------------------------------------------------------ notes

    def _finish(self, draft: _Draft) -> None:
        note, element = draft.note, draft.element
        if element.other is not None:
            self._tremolo(note, element.other)
            return
        contour: Contour = THERE_AND_BACK if draft.returns else ()
        if element.living:
            contour = living(element.living, note.length)
        self.notes.append(note._replace(contour=contour) if contour else note)

    def _tremolo(self, note: Note, other: float) -> None:
        """Two notes in turns, under one bow."""
        count = max(2, int(note.length / TREMOLO_NOTE))
        if len(self.notes) + count > MAX_TREMOLO_NOTES:
            self._notices["tremolos between two notes, of which the first is played"] += 1
            self.notes.append(Note(note.beat, note.length, note.pitch))
            return
        length = note.length / count
        turns = [
            Note(note.beat + number * length, length, other if number % 2 else note.pitch)
            for number in range(count)
        ]
        turns[0] = turns[0]._replace(marks=note.marks, before=note.before)
        turns[-1] = turns[-1]._replace(after=note.after)
        self.notes += turns
        self._span("slur", note.beat, turns[-1].beat)


def _marks(element: Element) -> list[Mark]:
    marks = (Mark(each.name, each.value) for each in element.actions if each.kind == "mark")
    return [filled(mark, element.around) for mark in marks]
