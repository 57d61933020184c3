"""Repeats and endings along a jianpu text: which list an element belongs to."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from yehu_server.score.jianpu.bars import Bars
from yehu_server.score.jianpu.form import MOST_DEPTH, MOST_TIMES, Repeat
from yehu_server.score.jianpu.text import Word, failure


@dataclass
class _Open:
    """A repeat, or the endings of one, that has not ended yet."""

    elements: list[object]
    word: Word
    repeat: Repeat
    begin: Fraction  # within the bar, of the repeat or of its first ending
    endings: bool = False


class Braces:
    """Collects elements, in the order of the page."""

    def __init__(self, bars: Bars) -> None:
        self._all: list[object] = []
        self._stack: list[_Open] = []
        self._bars = bars

    def add(self, element: object) -> None:
        """Put an element where the page is."""
        self._elements().append(element)

    def _elements(self) -> list[object]:
        return self._stack[-1].elements if self._stack else self._all

    def open_repeat(self, times: str, word: Word) -> None:
        """A repeat begins. Raises ScoreError beyond its bounds."""
        if len(times) > 4 or int(times) > MOST_TIMES:
            raise failure(word, f"more than {MOST_TIMES} times")
        if len(self._stack) >= MOST_DEPTH:
            raise failure(word, f"more than {MOST_DEPTH} repeats within each other")
        repeat = Repeat(int(times))
        self.add(repeat)
        self._stack.append(_Open(repeat.body, word, repeat, self._bars.place))

    def open_endings(self, word: Word) -> None:
        """The endings of the repeat before begin. Raises ScoreError where there is none."""
        elements = self._elements()
        before = elements[-1] if elements else None
        if not isinstance(before, Repeat) or before.endings:
            raise failure(word, "A{ belongs after the } of a repeat")
        if len(self._stack) >= MOST_DEPTH:
            raise failure(word, f"more than {MOST_DEPTH} repeats within each other")
        before.endings.append([])
        self._bars.undo_repeat()
        opened = _Open(before.endings[0], word, before, self._bars.place, endings=True)
        self._stack.append(opened)

    def bar_line(self, word: Word) -> None:
        """A bar line, or the end of one ending where endings are open."""
        opened = self._stack[-1] if self._stack else None
        if opened is None or not opened.endings:
            self._bars.line(word)
            return
        if len(opened.repeat.endings) == MOST_TIMES:
            raise failure(word, f"more than {MOST_TIMES} endings")
        opened.elements = []
        opened.repeat.endings.append(opened.elements)
        self._bars.return_to(opened.begin)

    def close(self, word: Word) -> None:
        """A repeat or its endings end. Raises ScoreError where none is open."""
        if not self._stack:
            raise failure(word, "} without a { before it")
        closed = self._stack.pop()
        if not closed.endings:
            self._bars.repeat(closed.begin, closed.repeat.times)

    def all_closed(self) -> list[object]:
        """Return all elements. Raises ScoreError where a repeat has no end."""
        if self._stack:
            raise failure(self._stack[-1].word, "has no } that ends it")
        return self._all
