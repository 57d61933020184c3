"""Parse the words of one part to elements: notes, marks and repeats, in the order of the page."""

import re
from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache

from yehu_server.scores.jianpu.form import (
    JUMPS,
    MAX_UNFOLDED,
    Bars,
    Element,
    MetreMark,
    RepeatStack,
)
from yehu_server.scores.jianpu.mark_words import AHEAD, IGNORED, SLURS_AND_TIES, action_of
from yehu_server.scores.jianpu.note_words import (
    Figure,
    Kind,
    NoteWord,
    Octaves,
    grace_word,
    length_of,
    note_word,
)
from yehu_server.scores.jianpu.scale import Scale
from yehu_server.scores.jianpu.text import Word, failure
from yehu_server.scores.score import printable
from yehu_server.scores.written.notated import HIGHEST_TEMPO, LOWEST_TEMPO, Grace
from yehu_server.scores.written.ornaments import WAYS
from yehu_server.scores.written.ticks import Ticks, ticks_of
from yehu_server.scores.written.words import Meaning

MAX_TUPLET, MAX_BARS_REST = 64, 1000

_TEMPO = re.compile(r"(?:(1|2|4|8|16|32|64)(\.{0,2})|\u2669)=([1-9]\d{0,3})")
_METRE = re.compile(r"([1-9]\d?)/(1|2|4|8|16|32|64)(?:,(1|2|4|8|16|32|64)(\.?))?")
_TUPLET = re.compile(r"([1-9]\d?)\[")
_BARS_REST = re.compile(r"R\*([1-9]\d*)")
_REPEAT = re.compile(r"R([1-9]\d*)?\{")
_LETTER = re.compile(r"letter[A-Z0-9]+")
_BAR_SIGNS = re.compile(  # ‖ is a double one
    r"(:+[|\u2016]+:+|::|[|\u2016\[]*[|\u2016]:+|:+[|\u2016]+\]?|[|\u2016]+\]|\[[|\u2016]+|[|\u2016]+)"
)
_ATTACHED = re.compile(r"[()~]|[^()~]+")
SLUR_AT_BAR = "slurs from the note before a bar line (a slur from the next note is written (1 2))"
Counts = Counter[str]


@lru_cache(maxsize=1024)
def _form_of(text: str) -> re.Match[str] | None:
    """A word of the form, by the first of the patterns that fits; None where it is none."""
    forms = (_BAR_SIGNS, _TUPLET, _REPEAT, _TEMPO, _METRE, _BARS_REST)
    return next(filter(None, (form.fullmatch(text) for form in forms)), None)


@lru_cache(maxsize=1024)
def _pieces_of(text: str, octaves: Octaves) -> list[str]:
    """The words that are written together as one; none where it is no such word."""
    found = _ATTACHED.findall(text)
    signs = {*found} & {*SLURS_AND_TIES}
    has_bar = not {"|", "\u2016"}.isdisjoint(text) or text == "::"
    if has_bar and '"' not in text and not _BAR_SIGNS.fullmatch(text):
        return [piece for piece in _BAR_SIGNS.split(text) if piece]
    if not signs or signs == {*found}:
        return []
    if not all(piece in SLURS_AND_TIES or note_word(piece, octaves) for piece in found):
        return []
    first = next(at for at, each in enumerate(found) if each != "(")
    return [found[first], *found[:first], *found[first + 1 :]]


class PartParser:
    """Reads the words of a part, one after another.

    All parts share the counts of words that are `unknown`, and of other things to warn of. `metre`
    is that with which the part begins, where it names one; that of the call holds until then.
    """

    def __init__(
        self, unknown: Counts, notices: Counts, scale: Scale, metre: MetreMark | None
    ) -> None:
        self.unknown, self.notices = unknown, notices
        self.scale = scale  # headers change it too
        self._bars = Bars(notices)
        self.metre: MetreMark | None = None
        if metre is not None:
            self._bars.change(metre.bar, metre.first)
        self._braces = RepeatStack(self._bars)
        self._octaves = Octaves.UNSAID
        self._keeps_length, self._last_beams = False, 0
        self._tuplet = (1, 1)  # notes in the room of others
        self._tuplet_word: Word | None = None
        self._in_harmonics = False
        self._ahead: list[Meaning] = []
        self._graces: tuple[Grace, ...] = ()
        self._last: Element | None = None
        self._figure: Figure | None = None  # of the last note
        self._is_after_bar = False
        self._count = 0
        self._skips = False  # the argument of \bar
        self._ways: tuple[Callable[[Word], bool], ...] = (
            self._as_note,
            self._as_action,
            self._as_switch,
            self._as_graces,
            self._as_form,
            lambda word: self.scale.read_key(word.text),
            self._as_attached,
        )
        self._forms: dict[re.Pattern[str], Callable[[re.Match[str], Word], None]] = {
            _BAR_SIGNS: self._bar_line,
            _TUPLET: self._begin_tuplet,
            _REPEAT: self._begin_repeat,
            _TEMPO: self._tempo,
            _METRE: self._metre,
            _BARS_REST: self._rest_of_bars,
        }

    def read(self, word: Word) -> None:
        """Read one word. Raises ScoreError where nothing after it could be in time."""
        if self._skips:
            self._skips = False
            if word.text.startswith('"'):
                return
        if word.text == "LP:":
            self.notices["music in LilyPond code (LP:) is not played"] += 1
            return
        for read in self._ways:
            if read(word):
                return
        self.unknown[printable(word.text)] += 1

    def end(self) -> list[object]:
        """Return all elements in the order of the page: notes, tempi, metres, repeats, jumps.

        Raises ScoreError where a repeat or a tuplet has no end.
        """
        elements = self._braces.all_closed()
        if self._tuplet_word is not None:
            raise failure(self._tuplet_word, "has no ] that ends it")
        if self._graces:
            self.notices["grace notes before nothing left out"] += 1
        return elements

    # ------------------------------------------------------------ notes

    def _as_note(self, word: Word) -> bool:
        note = note_word(word.text, self._octaves)
        if note is None:
            return False
        self.scale.shift(note.shift, word)
        if note.kind is Kind.DASH:
            self._add_dashes(note, self._length(note), word)
            return True
        if note.unsure:
            self.notices["octave marks between two figures, read as of the one before"] += 1
        melody = len(note.figures) > 1 and not note.figures[0].sign.isascii()
        for group in [(figure,) for figure in note.figures] if melody else [note.figures]:
            self._add_note(note, group, word)
        self._add_dashes(note, length_of(0, 0, *self._tuplet), word)
        return True

    def _add_dashes(self, note: NoteWord, length: Ticks, word: Word) -> None:
        """Each dash holds the note before it for a length; ``part`` joins them."""
        for _ in range(note.dashes):
            self._add(Element(Kind.DASH, length), word)

    def _add_note(self, note: NoteWord, figures: tuple[Figure, ...], word: Word) -> None:
        element = Element(note.kind, self._length(note), fifths=self.scale.fifths)
        if note.kind is Kind.BEAT:
            self.notices["beats of percussion (x), played as rests"] += 1
        if figures:
            self._give_pitches(element, figures, note.tremolo, word)
        ahead, self._ahead = self._ahead, []
        if note.kind is Kind.NOTE:
            element.actions += ahead
            element.before, self._graces = self._graces, ()
            if self._in_harmonics:
                element.actions.append(Meaning("mark", "harmonic"))
        else:
            self._ahead = ahead
        self._add(element, word)

    def _give_pitches(
        self, element: Element, figures: tuple[Figure, ...], tremolo: bool, word: Word
    ) -> None:
        single = len(figures) == 1
        pitches = [self.scale.pitch(figure, word, shifted=single) for figure in figures]
        element.pitch = max(pitches)
        self._figure = figures[pitches.index(element.pitch)]
        if tremolo and len(figures) == 2:
            element.pitch, element.other = pitches
        elif tremolo:
            element.actions.append(Meaning("mark", "tremolo", 3.0))
        elif not single:
            self.notices[
                "chords, of which the highest note is played (if they are no chords, write a "
                "space between the notes)"
            ] += 1
        element.living = self.scale.living(figures[0])

    def _length(self, note: NoteWord) -> Ticks:
        beams = note.beams
        if beams is None:
            beams = self._last_beams if self._keeps_length else 0
        self._last_beams = beams
        return length_of(beams, note.dots, *self._tuplet)

    def _add(self, element: Element, word: Word) -> None:
        self._count += 1
        if self._count > MAX_UNFOLDED:
            raise failure(word, f"more than {MAX_UNFOLDED} notes")
        self._braces.add(element)
        self._last, self._is_after_bar = element, False
        self._bars.step(element.length, word)

    def _as_graces(self, word: Word) -> bool:
        graces = grace_word(word.text, self._octaves)
        if graces is None:
            return False
        if graces.unsure:
            self.notices["octave marks between two figures, read as of the one before"] += 1
        notes = tuple(Grace(self.scale.pitch(each, word), length) for each, length in graces.notes)
        if not graces.after:
            self._graces += notes
        elif self._last is not None and self._last.kind is not Kind.REST:
            self._last.after += notes
        else:
            self.notices["grace notes after nothing left out"] += 1
        return True

    # ------------------------------------------------------------ marks

    def _as_action(self, word: Word) -> bool:
        if word.text in AHEAD:
            self._ahead.append(AHEAD[word.text])
            return True
        action = action_of(word.text)
        if action is None:
            return False
        if self._last is None:  # before the first note: a moment without length
            self._last = Element(Kind.REST, 0)
            self._braces.add(self._last)
        if action.kind == "slur" and self._braces.is_beginning:  # which has no note before it
            self._ahead.append(action)
            return True
        if action.kind == "slur" and self._is_after_bar:
            self.notices[SLUR_AT_BAR] += 1
        if action.name in WAYS and self._figure is not None:
            self._last.around = self.scale.around(self._figure)
        self._last.actions.append(action)
        return True

    def _as_attached(self, word: Word) -> bool:
        """Notes with brackets, ties or bar lines written onto them."""
        pieces = _pieces_of(word.text, self._octaves)
        column = word.column
        for piece in pieces:
            self.read(Word(piece, word.line, column))
            column += len(piece)
        return bool(pieces)

    def _as_switch(self, word: Word) -> bool:
        text = word.text
        if text in ("Harm:", ":Harm"):
            self._in_harmonics = text == "Harm:"
        elif text == "KeepLength":
            self._keeps_length = True
        elif text in ("OctavesBefore", "OctavesAfter"):
            self._octaves = Octaves.BEFORE if text == "OctavesBefore" else Octaves.AFTER
        elif text == "\\bar":
            self._skips = True
        else:
            return text in IGNORED or _LETTER.fullmatch(text) is not None
        return True

    # ------------------------------------------------------------ tempo, metre

    def _tempo(self, found: re.Match[str], word: Word) -> None:
        unit = Fraction(4, int(found[1] or 4)) * (2 - Fraction(1, 2 ** len(found[2] or "")))
        tempo = float(unit) * int(found[3])
        if not LOWEST_TEMPO <= tempo <= HIGHEST_TEMPO:
            lowest, highest = f"{LOWEST_TEMPO:g}", f"{HIGHEST_TEMPO:g}"
            raise failure(word, f"a tempo of {tempo:g} is not within {lowest} to {highest}")
        self._braces.add(Meaning("tempo", value=tempo))

    def _metre(self, found: re.Match[str], word: Word) -> None:
        bar = first = ticks_of(Fraction(4 * int(found[1]), int(found[2])))
        if found[3]:
            dotted = Fraction(3, 2) if found[4] else 1
            first = ticks_of(Fraction(4, int(found[3])) * dotted)
            if first > bar:
                raise failure(word, "the pickup is longer than the bar")
        mark = MetreMark(bar, first)
        self._braces.add(mark)
        if not self._count:
            self.metre = mark
        self._bars.change(bar, first)

    def _rest_of_bars(self, found: re.Match[str], word: Word) -> None:
        if len(found[1]) > 4 or int(found[1]) > MAX_BARS_REST:
            raise failure(word, f"a rest of more than {MAX_BARS_REST} bars")
        self._add(Element(Kind.REST, int(found[1]) * self._bars.length), word)

    # ------------------------------------------------------------ form

    def _as_form(self, word: Word) -> bool:
        text = word.text
        if text in JUMPS:
            self._braces.add(text)
        elif text == "}":
            self._braces.close(word)
        elif text == "A{":
            self._braces.open_endings(word)
        elif text == "]":
            self._tuplet, self._tuplet_word = (1, 1), None
        elif (found := _form_of(text)) is not None:
            self._forms[found.re](found, word)
        else:
            return False
        return True

    def _bar_line(self, found: re.Match[str], word: Word) -> None:
        text = found[0]
        self._is_after_bar = True
        if text.startswith(":"):
            self._braces.end_by_sign()
        if text == "|" or ":" not in text:
            self._braces.bar_line(word)
        if text.endswith(":"):
            self._braces.begin_by_sign(word)

    def _begin_repeat(self, found: re.Match[str], word: Word) -> None:
        self._braces.open_repeat(found[1] or "2", word)

    def _begin_tuplet(self, found: re.Match[str], word: Word) -> None:
        notes = int(found[1])
        if notes > MAX_TUPLET:
            raise failure(word, f"more than {MAX_TUPLET} notes in a tuplet")
        power = 1 << max(1, (notes - 1).bit_length())
        room = notes * 3 // 2 if power == notes else power // 2
        self._tuplet, self._tuplet_word = (room, notes), word
