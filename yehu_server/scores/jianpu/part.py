"""Make the notes, spans and signs of a part from its elements, in the order of playing."""

from collections import Counter
from collections.abc import Sequence
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
from yehu_server.scores.written.ticks import (
    TICKS,
    Ticks,
    length_of,
    metre_at,
    quarters_of,
    scaled,
)
from yehu_server.scores.written.voices import Draft
from yehu_server.scores.written.words import Meaning, OpenSpan

TREMOLO_NOTE = TICKS // 8  # of a tremolo between two notes: a demisemiquaver
MAX_TREMOLO_NOTES = 20_000


@dataclass(slots=True)
class _Draft(Draft):
    """A note that may still grow, by ties and dashes."""

    other: float | None = None  # of a tremolo between two
    living: str = ""
    returns: bool = False  # slides away and back
    late: Ticks = 0  # where what it is tied to begins, from its beginning

    def grow(self, more: Element) -> None:
        """Let it go on with another element."""
        if more.kind is Kind.NOTE:
            self.late = self.length
        self.hold(more.length, _marks(more), self.late)
        self.after += more.after


class PartBuilder:
    """Builds the notes, spans, signs, tempi and metres of a part, as lists.

    `end` is the beat after the last note or rest; with `has_pickup` a metre begins with a short
    bar.
    """

    def __init__(self, begin: Ticks, notices: Counter[str]) -> None:
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
        self._slurs: list[Ticks] = []
        self._hairpin = OpenSpan(self.spans)
        self._change = OpenSpan(self.spans, notated.LONGEST_CHANGE)  # of tempo
        self._glissando: Ticks | None = None
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
        self._hairpin.end(quarters_of(self.end))
        self._change.end(quarters_of(self.end))
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
            self.keys.append(KeySignature(quarters_of(begin), element.fifths))
        last = self._drafts[-1] if self._drafts else None
        goes_on = last is not None and last.end == begin
        if element.kind is Kind.NOTE and element.pitch is not None:
            self._note(element, element.pitch, begin, last if goes_on else None)
        elif element.kind is Kind.DASH and last is not None and goes_on:
            last.grow(element)
        else:
            self._rest(element, begin)
        for action in element.actions:
            self._act(action, begin)

    def _rest(self, element: Element, begin: Ticks) -> None:
        if element.length:
            self._untied()
        for mark in _marks(element):
            if mark.name in notated.SIGNS:  # such as a fermata
                self.signs.append(Sign(quarters_of(begin), mark.name, mark.value))
            else:
                self._notices["marks on rests left out"] += 1

    def _note(self, element: Element, pitch: float, begin: Ticks, last: _Draft | None) -> None:
        if self._tied and last is not None and last.pitch == pitch and not element.before:
            last.grow(element)
            self._tied = False
            return
        self._untied()
        if self._glissando is not None:
            self._span("glissando", self._glissando, begin)
            self._glissando = None
        marks, before, after = tuple(_marks(element)), element.before, element.after
        own = element.other, element.living
        self._drafts.append(_Draft(begin, element.length, pitch, marks, before, after, *own))

    def _act(self, action: Meaning, begin: Ticks) -> None:
        kind, name, value = action.kind, action.name, action.value
        last = self._drafts[-1] if self._drafts else None
        onset = begin if last is None else last.beat  # of the note that the word is written at
        if kind == "sign":
            if name in notated.DYNAMICS or name in notated.FORCED:
                self._hairpin.end(quarters_of(begin))
            self.signs.append(Sign(quarters_of(begin), name, value))
        elif kind == "slur":
            self._slurs.append(onset)
        elif kind == "slur end" and self._slurs:
            self._span("slur", self._slurs.pop(), onset)
        elif kind == "slur end":
            self._notices["ends of slurs that did not begin left out"] += 1
        elif kind == "tie":
            self._tied = True
        elif kind == "hairpin":
            self._hairpin.begin(name, quarters_of(begin))
        elif kind == "hairpin end":
            self._hairpin.end(quarters_of(begin))
        elif kind == "glissando":
            self._glissando = onset
        elif kind == "contour" and last is not None:
            last.returns = True
        elif kind == "change":
            self._change.begin(name, quarters_of(begin))
        elif kind in ("tempo", "back"):
            self._change.end(quarters_of(begin))
            self._tempo = self._tempo if value is None else value
            self.tempi.append(Tempo(quarters_of(begin), self._tempo))

    def _untied(self) -> None:
        if self._tied:
            self._notices["ties between different notes left out (a slur is written ( ) )"] += 1
        self._tied = False

    def _span(self, name: str, begin: Ticks, end: Ticks) -> None:
        if end > begin:
            self.spans.append(Span(name, quarters_of(begin), quarters_of(end)))

    def _metre(self, mark: MetreMark) -> None:
        if mark.first < mark.bar:
            self.has_pickup = True
            self.metres.append(metre_at(self.end, mark.first))
        self.metres.append(metre_at(self.end + mark.first % mark.bar, mark.bar))

    # ------------------------------------------------------------ notes

    def _finish(self, draft: _Draft) -> None:
        if draft.other is not None:
            self._tremolo(draft, draft.other)
            return
        note = draft.note()
        contour: Contour = THERE_AND_BACK if draft.returns else ()
        if draft.living:
            contour = living(draft.living, note.length)
        self.notes.append(note._replace(contour=contour) if contour else note)

    def _tremolo(self, draft: _Draft, other: float) -> None:
        """Two notes in turns, under one bow."""
        count = max(2, int(draft.length // TREMOLO_NOTE))
        if len(self.notes) + count > MAX_TREMOLO_NOTES:
            self._notices["tremolos between two notes, of which the first is played"] += 1
            self.notes.append(draft.note()._replace(marks=(), before=(), after=()))
            return
        length = scaled(draft.length, Fraction(1, count))
        beats = [draft.beat + number * length for number in range(count)]
        turns = [
            Note(quarters_of(beat), length_of(length), other if number % 2 else draft.pitch)
            for number, beat in enumerate(beats)
        ]
        turns[0] = turns[0]._replace(marks=draft.marks, before=draft.before)
        turns[-1] = turns[-1]._replace(after=draft.after)
        self.notes += turns
        self._span("slur", draft.beat, beats[-1])


def _marks(element: Element) -> list[Mark]:
    marks = (Mark(each.name, each.value) for each in element.actions if each.kind == "mark")
    return [filled(mark, element.around) for mark in marks]
