"""Collect the elements of a jianpu text in bars, and unfold its repeats, endings and jumps."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from yehu_server.errors import ScoreError
from yehu_server.scores.jianpu.note_words import Kind
from yehu_server.scores.jianpu.text import Word, failure
from yehu_server.scores.written.notated import Grace
from yehu_server.scores.written.ornaments import HALF, WHOLE, Around
from yehu_server.scores.written.ticks import TICKS, Ticks
from yehu_server.scores.written.words import Meaning

UNFIT = "bar lines do not fit the metre"
FINE, SEGNO, TO_CODA, DA_CAPO, DAL_SEGNO = JUMPS = ("Fine", "Segno", "ToCoda", "DC", "DS")
BACK, ENDS = (DA_CAPO, DAL_SEGNO), (FINE, TO_CODA)
MAX_UNFOLDED = 50_000  # notes, rests and dashes of a part
MAX_DEPTH = 8  # repeats within repeats
MAX_TIMES = 100


class Bars:
    """Tracks the place within the bar, in the order of the page, and warns of bars that do not fit.

    Notes are checked only once a metre is written. `length` is that of a whole bar, `place`
    what has passed of it, both in ticks.
    """

    def __init__(self, notices: Counter[str]) -> None:
        self.length: Ticks = 4 * TICKS
        self.place: Ticks = 0
        self._notices = notices
        self._is_written = False
        self.before_repeat: Ticks = 0  # the place where the last one's first time ended
        self._upbeat: Ticks = 0
        self._short: Word | None = None  # the end of a bar that an upbeat completes, if it is last

    def change(self, length: Ticks, first: Ticks) -> None:
        """Begin a metre; its first bar may be shorter."""
        self.length, self.place = length, length - first
        self._upbeat = first
        self._is_written = True

    def step(self, length: Ticks, word: Word) -> None:
        """Advance by a note."""
        if self._short is not None:
            self._warn(UNFIT, self._short)
            self._short = None
        self.place += length
        if self.place >= self.length:
            over, self.place = self.place - self.length, self.place % self.length
            if over and length < self.length and self._is_written:
                self._warn("notes cross a bar line", word)

    def line(self, word: Word) -> None:
        """Check the place at a bar line."""
        if self.place and self._is_written:
            if self.place + self._upbeat == self.length:
                self._short = word
            else:
                self._warn(UNFIT, word)
            self.place = 0

    def repeat(self, begin: Ticks, times: int) -> None:
        """Move to the place after a repeat, which began at a place."""
        self.before_repeat = self.place
        self.place = (begin + times * (self.place - begin)) % self.length

    def _warn(self, what: str, word: Word) -> None:
        first = next((text for text in self._notices if text.startswith(what)), None)
        self._notices[first or f"{what} (first at line {word.line}, column {word.column})"] += 1


@dataclass(slots=True)
class Element:
    """A note, rest or dash, which may be played several times."""

    kind: Kind
    length: Ticks
    pitch: float | None = None  # MIDI note; None for a rest or dash
    other: float | None = None  # the other note of a tremolo between two
    living: str = ""  # the character, of a living note of 二四谱
    fifths: int | None = None  # of the key, where one is written
    around: Around = (WHOLE, HALF)
    before: tuple[Grace, ...] = ()
    after: tuple[Grace, ...] = ()
    actions: list[Meaning] = field(default_factory=list)  # what the words after it do, in order


@dataclass(frozen=True, slots=True)
class MetreMark:
    """A metre from here on, and how long the bar is that it begins with."""

    bar: Ticks
    first: Ticks


@dataclass
class Repeat:
    """A passage that is played several times, and its endings, one for each time."""

    times: int
    body: list[object] = field(default_factory=list)
    endings: list[list[object]] = field(default_factory=list)


@dataclass
class _Open:
    """A repeat, or the endings of one, that has not ended yet; with `signs`, one of bar lines."""

    elements: list[object]
    word: Word
    repeat: Repeat
    begin: Ticks  # within the bar, of the repeat or of its first ending
    endings: bool = False
    signs: bool = False


class RepeatStack:
    """Collects elements, in the order of the page, with the repeats that are open."""

    def __init__(self, bars: Bars) -> None:
        self._stack = [_Open([], Word("", 1, 1), Repeat(1), 0)]  # first the whole piece
        self._bars = bars

    def add(self, element: object) -> None:
        """Add an element to the innermost open repeat."""
        self._stack[-1].elements.append(element)

    @property
    def is_beginning(self) -> bool:
        """Whether a repeat, or an ending, has no note yet."""
        begun = any(isinstance(each, Element | Repeat) for each in self._stack[-1].elements)
        return len(self._stack) > 1 and not begun

    def open_repeat(self, times: str, word: Word, *, signs: bool = False) -> None:
        """Begin a repeat. Raises ScoreError beyond its bounds."""
        if len(times) > 4 or int(times) > MAX_TIMES:
            raise failure(word, f"more than {MAX_TIMES} times")
        repeat = Repeat(int(times))
        self._open(_Open(repeat.body, word, repeat, self._bars.place, signs=signs))
        self._stack[-2].elements.append(repeat)

    def _open(self, opened: _Open) -> None:
        if len(self._stack) > MAX_DEPTH:
            raise failure(opened.word, f"more than {MAX_DEPTH} repeats within each other")
        self._stack.append(opened)

    def open_endings(self, word: Word) -> None:
        """Begin the endings of the last repeat. Raises ScoreError where there is none."""
        before = next(iter(self._stack[-1].elements[-1:]), None)
        if not isinstance(before, Repeat) or before.endings:
            raise failure(word, "A{ belongs after the } of a repeat")
        before.endings.append([])
        self._bars.place = self._bars.before_repeat
        self._open(_Open(before.endings[0], word, before, self._bars.place, endings=True))

    def bar_line(self, word: Word) -> None:
        """Take a bar line; where endings are open it ends one of them."""
        opened = self._stack[-1]
        if not opened.endings:
            self._bars.line(word)
            return
        if len(opened.repeat.endings) == MAX_TIMES:
            raise failure(word, f"more than {MAX_TIMES} endings")
        opened.elements = []
        opened.repeat.endings.append(opened.elements)
        self._bars.place = opened.begin

    def begin_by_sign(self, word: Word) -> None:
        """Begin a repeat at ``|:``; an open one of such a sign ends."""
        self._drop_sign()
        self.open_repeat("2", word, signs=True)

    def end_by_sign(self) -> None:
        """End a repeat at ``:|``: one from its sign, or from the end of the repeat before."""
        if self._stack[-1].signs:
            self._stack.pop()
            return
        elements = self._stack[-1].elements
        repeats = [at for at, each in enumerate(elements) if isinstance(each, Repeat)]
        begin = repeats[-1] + 1 if repeats else 0
        while begin < len(elements) and isinstance(elements[begin], (MetreMark, Meaning)):
            begin += 1
        elements[begin:] = [Repeat(2, elements[begin:])]

    def _drop_sign(self) -> None:
        """Play once what a sign began and none ended."""
        if self._stack[-1].signs:
            self._stack.pop().repeat.times = 1

    def close(self, word: Word) -> None:
        """End a repeat or its endings. Raises ScoreError where none is open."""
        self._drop_sign()
        if len(self._stack) == 1:
            raise failure(word, "} without a { before it")
        closed = self._stack.pop()
        if not closed.endings:
            self._bars.repeat(closed.begin, closed.repeat.times)

    def all_closed(self) -> list[object]:
        """Return all elements. Raises ScoreError where a repeat has no end."""
        self._drop_sign()
        if len(self._stack) > 1:
            raise failure(self._stack[-1].word, "has no } that ends it")
        return self._stack[0].elements


def unfolded(written: Sequence[object]) -> tuple[list[object], list[str]]:
    """Elements in the order of playing, and warnings.

    After a da capo or dal segno, repeats are not taken again, and of endings the last is played.
    Only the first of several is taken. Raises ScoreError where there are more than MAX_UNFOLDED.
    """
    once = _flat(written, repeated=True)
    back = next((at for at, each in enumerate(once) if each in BACK), None)
    if back is None:
        return _without_jumps(once), []
    warnings = []
    if sum(each in BACK for each in _flat(written, repeated=False)) > 1:
        warnings.append("of several DC and DS, only the first is played")
    again = _flat(written, repeated=False)
    turn = next(at for at, each in enumerate(again) if each in BACK)
    start = 0
    if once[back] == DAL_SEGNO:
        signs = [at for at, each in enumerate(again[:turn]) if each == SEGNO]
        if not signs:
            warnings.append("a DS without a Segno: played from the beginning")
        start = signs[-1] if signs else 0
    # To Fine and on with what was not played yet, or by the coda, or to the end.
    ends = (at for at in range(start, len(again)) if again[at] in ENDS[: 1 + (at < turn)])
    played = once[:back] + again[start : next(ends, turn)] + once[back + 1 :]
    _check(len(played))
    return _without_jumps(played), warnings


def _without_jumps(elements: list[object]) -> list[object]:
    return [each for each in elements if not isinstance(each, str)]


def _flat(written: Sequence[object], *, repeated: bool) -> list[object]:
    played: list[object] = []
    for each in written:
        if not isinstance(each, Repeat):
            played.append(each)
            continue
        body = _flat(each.body, repeated=repeated)
        endings = [_flat(ending, repeated=repeated) for ending in each.endings]
        times = max(each.times, len(endings))
        if not repeated:
            played += body + (endings[-1] if endings else [])
            continue
        length = len(body) + max(map(len, endings), default=0)
        _check(length * times / 2)
        for time in range(times):
            played += body
            if endings:  # with fewer endings than times, the first one comes more often
                played += endings[max(0, time - (times - len(endings)))]
        _check(len(played))
    return played


def _check(notes: float) -> None:
    if notes > MAX_UNFOLDED:
        raise ScoreError(f"with its repeats, has more than {MAX_UNFOLDED} notes")
