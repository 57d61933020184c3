"""Read jianpu (简谱) as [jianpu-ly] has it, 二四谱 and 工尺谱 (docs/jianpu.md)."""

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from yehu_server.errors import ScoreError
from yehu_server.scores.jianpu.characters import NOTATIONS, mode_named
from yehu_server.scores.jianpu.form import unfolded
from yehu_server.scores.jianpu.mark_words import IGNORED_HEADERS
from yehu_server.scores.jianpu.parser import PartParser
from yehu_server.scores.jianpu.part import PartBuilder
from yehu_server.scores.jianpu.scale import Scale
from yehu_server.scores.jianpu.text import Header, Word, decoded, words_of
from yehu_server.scores.score import (
    COMMON_TIME,
    Metre,
    errors_name,
    printable,
    read_score_bytes,
)
from yehu_server.scores.written import notated
from yehu_server.scores.written.notated import Bar, Part, Tempo, Written
from yehu_server.scores.written.ticks import TICKS, Ticks, metre_at

MAX_BYTES = 1 << 20
MAX_MOVEMENTS = 64
MAX_UNKNOWN = 100  # different words that are named
MAX_NUMBERED = 10_000  # bars

Words = list[Word | Header]  # of a part


def read_jianpu(path: str | os.PathLike[str]) -> Written:
    """Read a file of jianpu or 二四谱.

    Raises ScoreError, one line that names the file, and the line and column of what cannot be read:
    where it is missing, larger than 1 MiB or no text; has no notes, or more than
    `form.MAX_UNFOLDED` in a part; where a repeat or tuplet does not end.
    """
    with errors_name(path):
        return parse_jianpu(read_score_bytes(path, MAX_BYTES))


def parse_jianpu(data: bytes) -> Written:
    """Read the bytes of a file; see `read_jianpu`, whose errors these are without the name."""
    text, guess = decoded(data)
    unknown: Counter[str] = Counter()
    notices: Counter[str] = Counter()
    reader = _Reader(unknown, notices)
    for movement in _movements(text):
        reader.read(movement)
    written = reader.written()
    lines = [guess] if guess else []
    lines += [notated.times(notice, count) for notice, count in notices.items()]
    named = dict(unknown.most_common(MAX_UNKNOWN))
    if others := unknown.total() - sum(named.values()):
        named["other words"] = others
    return replace(written, unknown=named, warnings=tuple(lines))


def _movements(text: str) -> list[list[Words]]:
    movements: list[list[Words]] = [[[]]]
    for word in words_of(text):
        if isinstance(word, Word) and word.text in ("NextPart", "NextScore"):
            if word.text == "NextScore":
                movements.append([])
            movements[-1].append([])
            if len(movements[-1]) > notated.MAX_PARTS or len(movements) > MAX_MOVEMENTS:
                raise ScoreError(f"has more than {notated.MAX_PARTS} parts or movements")
        else:
            movements[-1][-1].append(word)
    return movements


class _Reader:
    """Joins parts and movements to one score."""

    def __init__(self, unknown: Counter[str], notices: Counter[str]) -> None:
        self._unknown, self._notices = unknown, notices
        self._title = ""
        self._characters: dict[str, float] | None = None
        self._names: dict[int, str] = {}
        self._parts: dict[int, list[PartBuilder]] = {}
        self._end: Ticks = 0

    def read(self, movement: Sequence[Words]) -> None:
        """Read the parts of a movement, which begins where the one before ended."""
        played = []
        key, metre = None, None  # with which the part before begins
        for number, part in enumerate(movement):
            scale = Scale(self._characters, key)
            parser = PartParser(self._unknown, self._notices, scale, metre)
            for word in part:
                if isinstance(word, Header):
                    self._head(word, parser.scale, number)
                else:
                    parser.read(word)
            if number and key and not scale.has_own:
                self._notices["a part without a key is in that of the one before, not in C"] += 1
            key, metre = scale.first_key, parser.metre or metre
            order, warnings = unfolded(parser.end())
            self._notices.update(warnings)
            played.append(PartBuilder(self._end, self._notices))
            played[-1].build(order)
        if len({each.end for each in played}) > 1:
            self._notices["parts differ in length"] += 1
        for number, each in enumerate(played):
            self._parts.setdefault(number, []).append(each)
        self._end = max(each.end for each in played)
        if self._end > notated.MAX_BEATS * TICKS:
            raise ScoreError(f"lasts more than {notated.MAX_BEATS} quarter notes")

    def _head(self, header: Header, scale: Scale, part: int) -> None:
        if header.name in ("title", "标题", "曲名"):
            self._title = self._title or printable(header.value)
        elif header.name in ("instrument", "乐器"):
            self._names.setdefault(part, printable(header.value))
        elif header.name in ("notation", "谱", "谱式") and header.value in NOTATIONS:
            self._characters = NOTATIONS[header.value]
            scale.characters = self._characters
        elif header.name in ("mode", "调", "调式") and mode_named(header.value):
            scale.mode = mode_named(header.value) or scale.mode
        elif header.name not in IGNORED_HEADERS:
            value = f"={header.value}" if header.name in ("notation", "mode", "谱", "调") else "="
            self._unknown[printable(f"{header.name}{value}")] += 1

    def written(self) -> Written:
        """Return the score. Raises ScoreError where it has no notes."""
        parts = []
        for number, movements in sorted(self._parts.items()):
            notes = tuple(note for each in movements for note in each.notes)
            signs = tuple(sign for each in movements for sign in each.signs)
            spans = (span for each in movements for span in each.spans)
            ordered = tuple(sorted(spans, key=lambda span: float(span.begin)))
            parts.append(Part(self._names.get(number, ""), notes, ordered, signs))
        if not any(part.notes for part in parts):
            raise ScoreError("has no notes of jianpu")
        metres = self._metres()
        keys = tuple(key for each in self._parts[0] for key in each.keys)
        bars = self._bars(metres)
        return Written(tuple(parts), self._tempi(), metres, bars, self._title, keys=keys)

    def _tempi(self) -> tuple[Tempo, ...]:
        """The tempi of all parts; where several change it at once, that of the first."""
        found: dict[Fraction, Tempo] = {}
        for movements in self._parts.values():
            of_part = {tempo.beat: tempo for each in movements for tempo in each.tempi}
            found = {**of_part, **found}
        return tuple(found[beat] for beat in sorted(found))

    def _metres(self) -> tuple[Metre, ...]:
        found = {COMMON_TIME.beat: COMMON_TIME}
        found.update({metre.beat: metre for each in self._parts[0] for metre in each.metres})
        return tuple(found[beat] for beat in sorted(found))

    def _bars(self, metres: Sequence[Metre]) -> tuple[Bar, ...]:
        """Bars numbered from 1 after a pickup; none where no bar is a pickup."""
        if not any(each.has_pickup for each in self._parts[0]):
            return ()
        bars: list[Bar] = []
        number = 1
        last = metre_at(self._end, 0)
        for metre, after in pairwise((*metres, last)):
            beat, end = Fraction(metre.beat), Fraction(after.beat)
            if metre.quarters < after.quarters and end - beat == metre.quarters:  # a pickup
                number -= 1
            while beat < end and len(bars) < MAX_NUMBERED:
                bars.append(Bar(beat, str(number)))
                beat += Fraction(metre.quarters)
                number += 1
        return tuple(bars)
