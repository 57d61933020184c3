"""Counts bars along a jianpu text, and notes where a bar line comes too early or too late."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction

from yehu_server.scores.jianpu.text import Word

UNFIT = "bar lines do not fit the metre"


class Bars:
    """The place within the bar, in the order of the page.

    Only once a metre is written are notes held against it. `length` is that of a whole bar, `place`
    what has passed of it, both in quarters.
    """

    def __init__(self, notices: Counter[str]) -> None:
        self.length, self.place = Fraction(4), Fraction(0)
        self._notices = notices
        self._is_written = False
        self._before_repeat = Fraction(0)
        self._upbeat = Fraction(0)
        self._short: Word | None = None  # the end of a bar that an upbeat completes, if it is last

    def change(self, length: Fraction, first: Fraction) -> None:
        """A metre is written; its first bar may be a short one."""
        self.length, self.place = length, length - first
        self._upbeat = first
        self._is_written = True

    def step(self, length: Fraction, word: Word) -> None:
        """A note is written."""
        if self._short is not None:
            self._tell(UNFIT, self._short)
            self._short = None
        self.place += length
        if self.place >= self.length:
            over, self.place = self.place - self.length, self.place % self.length
            if over and length < self.length and self._is_written:
                self._tell("notes cross a bar line", word)

    def line(self, word: Word) -> None:
        """A bar line is written."""
        if self.place and self._is_written:
            if self.place + self._upbeat == self.length:
                self._short = word
            else:
                self._tell(UNFIT, word)
            self.place = Fraction(0)

    def repeat(self, begin: Fraction, times: int) -> None:
        """A repeat ends, which began at a place."""
        self._before_repeat = self.place
        self.place = (begin + times * (self.place - begin)) % self.length

    def undo_repeat(self) -> None:
        """The repeat that has just ended has endings, which follow its first time."""
        self.place = self._before_repeat

    def return_to(self, place: Fraction) -> None:
        """The next ending begins where the first one did."""
        self.place = place

    def _tell(self, what: str, word: Word) -> None:
        first = next((text for text in self._notices if text.startswith(what)), None)
        self._notices[first or f"{what} (first at line {word.line}, column {word.column})"] += 1
