"""From what sounds, in the order of playing, to the notes, spans and signs of a part."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from yehu_server.scores.jianpu.characters import Contour, living
from yehu_server.scores.jianpu.form import MetreMark, Sounding, TempoMark
from yehu_server.scores.jianpu.mark_words import THERE_AND_BACK, Act, Action
from yehu_server.scores.jianpu.note_words import Kind
from yehu_server.scores.score import Metre
from yehu_server.scores.written.notated import (
    DYNAMICS,
    FORCED,
    LONGEST_CHANGE,
    SIGNS,
    USUAL_TEMPO,
    Mark,
    Note,
    OpenSpan,
    Sign,
    Span,
    Tempo,
)

TREMOLO_NOTE = Fraction(1, 8)  # of a tremolo between two notes: a demisemiquaver
MOST_TREMOLO_NOTES = 20_000


@dataclass(slots=True)
class _Draft:
    """A note that may still grow, by ties and dashes."""

    note: Note
    element: Sounding
    returns: bool = False  # slides away and back

    def grow(self, more: Sounding, marks: Iterable[Mark]) -> None:
        """Let it go on with another element."""
        note = self.note
        self.note = replace(
            note,
            length=note.length + more.length,
            marks=(*note.marks, *marks),
            after=(*note.after, *more.after),
        )


@dataclass
class Played:
    """What a part plays."""

    end: Fraction  # the beat after the last note or rest
    notes: list[Note] = field(default_factory=list)
    spans: list[Span] = field(default_factory=list)
    signs: list[Sign] = field(default_factory=list)
    tempi: list[Tempo] = field(default_factory=list)
    metres: list[Metre] = field(default_factory=list)
    has_pickup: bool = False  # whether a metre begins with a short bar


class PartPlayer:
    """Walks once through the elements of a part."""

    def __init__(self, begin: Fraction, notices: Counter[str]) -> None:
        self._played = played = Played(begin)
        self._notices = notices
        self._drafts: list[_Draft] = []
        self._tied = False
        self._slurs: list[Fraction] = []
        self._hairpin = OpenSpan(played.spans)
        self._change = OpenSpan(played.spans, LONGEST_CHANGE)  # of tempo
        self._glissando: Fraction | None = None
        self._tempo = USUAL_TEMPO

    def play(self, elements: Sequence[object]) -> Played:
        """Return what is played."""
        played = self._played
        for element in elements:
            if isinstance(element, Sounding):
                self._sound(element)
            elif isinstance(element, TempoMark):
                self._change_tempo(element.quarters_per_minute, played.end)
            elif isinstance(element, MetreMark):
                self._metre(element)
        self._untied()
        self._hairpin.end(played.end)
        self._change.end(played.end)
        if self._slurs:
            self._notices["slurs without an end left out"] += len(self._slurs)
        for draft in self._drafts:
            self._finish(draft)
        return played

    # ------------------------------------------------------------ in time

    def _sound(self, element: Sounding) -> None:
        begin = self._played.end
        self._played.end = begin + element.length
        last = self._drafts[-1] if self._drafts else None
        goes_on = last is not None and last.note.end == begin
        if element.kind is Kind.NOTE and element.pitch is not None:
            self._note(element, element.pitch, begin, last if goes_on else None)
        elif element.kind is Kind.DASH and last is not None and goes_on:
            last.grow(element, _marks(element))
        else:
            self._rest(element, begin)
        for action in element.actions:
            if action.act is not Act.MARK:
                self._act(action, begin)

    def _rest(self, element: Sounding, begin: Fraction) -> None:
        if element.length:
            self._untied()
        for mark in _marks(element):
            if mark.name in SIGNS:  # such as a fermata
                self._played.signs.append(Sign(begin, mark.name, mark.value))
            else:
                self._notices["marks on rests left out"] += 1

    def _note(self, element: Sounding, pitch: float, begin: Fraction, last: _Draft | None) -> None:
        marks = _marks(element)
        if self._tied and last is not None and last.note.pitch == pitch and not element.before:
            last.grow(element, [mark for mark in marks if mark not in last.note.marks])
            self._tied = False
            return
        self._untied()
        if self._glissando is not None:
            self._span("glissando", self._glissando, begin)
            self._glissando = None
        note = Note(begin, element.length, pitch, tuple(marks), element.before, element.after)
        self._drafts.append(_Draft(note, element))

    def _act(self, action: Action, begin: Fraction) -> None:
        last = self._drafts[-1] if self._drafts else None
        onset = begin if last is None else last.note.beat  # of the note that the word is written at
        if action.act is Act.SIGN:
            if action.name in DYNAMICS or action.name in FORCED:
                self._hairpin.end(begin)
            self._played.signs.append(Sign(begin, action.name, action.value))
        elif action.act is Act.SLUR:
            self._slurs.append(onset)
        elif action.act is Act.SLUR_END:
            if self._slurs:
                self._span("slur", self._slurs.pop(), onset)
            else:
                self._notices["ends of slurs that did not begin left out"] += 1
        elif action.act is Act.TIE:
            self._tied = True
        elif action.act is Act.HAIRPIN:
            self._hairpin.begin(action.name, begin)
        elif action.act is Act.HAIRPIN_END:
            self._hairpin.end(begin)
        elif action.act is Act.GLISSANDO:
            self._glissando = onset
        elif action.act is Act.CONTOUR and last is not None:
            last.returns = True
        elif action.act is Act.TEMPO and action.value is not None:
            self._change_tempo(action.value, begin)
        elif action.act is Act.TEMPO_CHANGE:
            self._change.begin(action.name, begin)
        elif action.act is Act.TEMPO_AGAIN:
            self._change_tempo(self._tempo, begin)

    def _untied(self) -> None:
        if self._tied:
            self._notices["ties between different notes left out (a slur is written ( ) )"] += 1
        self._tied = False

    def _span(self, name: str, begin: Fraction, end: Fraction) -> None:
        if end > begin:
            self._played.spans.append(Span(name, begin, end))

    def _change_tempo(self, tempo: float, at: Fraction) -> None:
        self._change.end(at)
        self._tempo = tempo
        self._played.tempi.append(Tempo(at, tempo))

    def _metre(self, mark: MetreMark) -> None:
        begin = self._played.end
        if mark.first < mark.bar:
            self._played.has_pickup = True
            self._played.metres.append(Metre(float(begin), float(mark.first)))
        self._played.metres.append(Metre(float(begin + mark.first % mark.bar), float(mark.bar)))

    # ------------------------------------------------------------ notes

    def _finish(self, draft: _Draft) -> None:
        note, element = draft.note, draft.element
        if element.other is not None:
            self._tremolo(note, element.other)
            return
        contour: Contour = THERE_AND_BACK if draft.returns else ()
        if element.living:
            contour = living(element.living, note.length)
        self._played.notes.append(replace(note, contour=contour))

    def _tremolo(self, note: Note, other: float) -> None:
        """Two notes in turns, under one bow."""
        count = max(2, int(note.length / TREMOLO_NOTE))
        if len(self._played.notes) + count > MOST_TREMOLO_NOTES:
            self._notices["tremolos between two notes, of which the first is played"] += 1
            self._played.notes.append(Note(note.beat, note.length, note.pitch))
            return
        length = note.length / count
        turns = [
            Note(note.beat + number * length, length, other if number % 2 else note.pitch)
            for number in range(count)
        ]
        turns[0] = replace(turns[0], marks=note.marks, before=note.before)
        turns[-1] = replace(turns[-1], after=note.after)
        self._played.notes += turns
        self._span("slur", note.beat, turns[-1].beat)


def _marks(element: Sounding) -> list[Mark]:
    marks = (action for action in element.actions if action.act is Act.MARK)
    return [Mark(action.name, action.value) for action in marks]
