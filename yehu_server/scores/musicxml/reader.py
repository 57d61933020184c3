"""Read MusicXML: `.musicxml`, `.xml` and `.mxl`. docs/scores.md tells what is understood.

Each voice becomes a part of its own, with one note at a time: the highest of a chord.
"""

from __future__ import annotations

import os
from collections import Counter
from fractions import Fraction
from xml.etree.ElementTree import Element, SubElement

from yehu_server.errors import ScoreError
from yehu_server.scores.musicxml.bars import FINEST, BarReader, RawBar
from yehu_server.scores.musicxml.file import read_root
from yehu_server.scores.musicxml.marks import printable
from yehu_server.scores.musicxml.repeats import BarLines, order_of
from yehu_server.scores.musicxml.voices import parts_of
from yehu_server.scores.score import COMMON_TIME, Metre, naming
from yehu_server.scores.written.notated import (
    MOST_BEATS,
    MOST_NOTES,
    MOST_PARTS,
    Bar,
    Part,
    Tempo,
    Written,
    times,
)

MOST_KINDS = 100  # of unknown marks that are named
MOST_REPEATED, MOST_OFTEN = 10_000, 4  # notes, or times as many as written


def read_musicxml(path: str | os.PathLike[str]) -> Written:
    """Read a MusicXML file, plain or compressed.

    Raises
    ------
    ScoreError
        One line naming the file, whatever its bytes: where it cannot be read, is no MusicXML or
        is beyond all bounds.
    """
    with naming(path):
        return written_of(read_root(path))


def written_of(root: Element) -> Written:
    """Return the score of a root element.

    Raises
    ------
    ScoreError
        Where it is none, or beyond bounds.
    """
    if root.tag == "score-timewise":
        root = _partwise(root)
    if root.tag != "score-partwise":
        raise ScoreError(f"is no MusicXML score: its root is <{printable(root.tag)}>")
    unknown: Counter[str] = Counter()
    warnings: Counter[str] = Counter()
    elements = root.findall("part")
    if len(elements) > MOST_PARTS:
        raise ScoreError(f"has more than {MOST_PARTS} parts")
    parts_bars = []
    for element in elements:
        reader = BarReader(unknown, warnings)
        parts_bars.append([reader.read(measure) for measure in element.iterfind("measure")])
    count = max(map(len, parts_bars), default=0)
    order = order_of([_lines(parts_bars, number) for number in range(count)])
    _check_amount(parts_bars, order)
    played, end = _timed(parts_bars, order)
    names = _names(root)
    parts: list[Part] = []
    tempi: dict[Fraction, float] = {}
    for element, bars in zip(elements, parts_bars, strict=True):
        found, its_tempi = parts_of(names.get(element.get("id", ""), ""), bars, played, end)
        parts += found
        for beat, tempo in its_tempi:
            tempi.setdefault(beat, tempo)
    longest = parts_bars[0] if parts_bars else []
    return Written(
        tuple(parts),
        tuple(Tempo(beat, tempo) for beat, tempo in sorted(tempi.items())),
        tuple(_metres(longest, played)),
        tuple(
            Bar(begin, longest[number].number) for number, begin in played if number < len(longest)
        ),
        _title(root),
        dict(unknown.most_common(MOST_KINDS)),
        tuple(times(text, count) for text, count in warnings.items()),
    )


def _check_amount(parts_bars: list[list[RawBar]], order: list[int]) -> None:
    """Refuse scores that are too large, or that repeats make so."""
    written = sum(len(bar.notes) for bars in parts_bars for bar in bars)
    if written > MOST_NOTES:
        raise ScoreError(f"has more than {MOST_NOTES} notes")
    played = sum(
        len(bars[number].notes) for bars in parts_bars for number in order if number < len(bars)
    )
    if played > max(MOST_REPEATED, MOST_OFTEN * written):
        raise ScoreError(f"has {played} notes with its repeats, more than {MOST_REPEATED}")


def _partwise(root: Element) -> Element:
    """The same score with its bars in parts, and not its parts in bars."""
    changed = Element("score-partwise")
    changed.extend(child for child in root if child.tag != "measure")
    parts: dict[str, Element] = {}
    for measure in root.iterfind("measure"):
        for part in measure.iterfind("part"):
            name = part.get("id", "")
            if name not in parts:
                parts[name] = SubElement(changed, "part", {"id": name})
            SubElement(parts[name], "measure", dict(measure.attrib)).extend(part)
    return changed


def _lines(parts_bars: list[list[RawBar]], number: int) -> BarLines:
    """What the bar lines of all parts say; many writers give repeats to the first part alone."""
    found = BarLines()
    for bars in parts_bars:
        if number < len(bars):
            lines = bars[number].lines
            found.forward |= lines.forward
            found.times = max(found.times, lines.times)
            found.endings |= lines.endings
            found.jumps |= lines.jumps
    return found


def _timed(
    parts_bars: list[list[RawBar]], order: list[int]
) -> tuple[list[tuple[int, Fraction]], Fraction]:
    """The beats at which bars begin, as the fullest part has them, and that of the end."""
    lengths: dict[int, Fraction] = {}
    begin = Fraction(0)
    played = []
    for number in order:
        if number not in lengths:
            lengths[number] = max(bars[number].length for bars in parts_bars if number < len(bars))
        played.append((number, begin))
        begin += lengths[number]
        if begin.denominator > FINEST:
            begin = begin.limit_denominator(FINEST)
        if begin > MOST_BEATS:
            raise ScoreError(f"is longer than {MOST_BEATS} quarters, with its repeats")
    return played, begin


def _metres(bars: list[RawBar], played: list[tuple[int, Fraction]]) -> list[Metre]:
    """The time signatures, in order; a short first bar counts back from the second."""
    metres = [COMMON_TIME]
    holding: list[Fraction | None] = []  # at each bar as written
    for bar in bars:
        holding.append(bar.metre or (holding[-1] if holding else None))
    for number, begin in played:
        quarters = holding[number] if number < len(holding) else None
        if quarters is not None and float(quarters) != metres[-1].quarters:
            metres.append(Metre(float(begin), float(quarters)))
    if bars and played and len(played) > 1 and played[0][0] == 0:
        quarters = holding[0] or Fraction(4)
        upbeat = played[1][1]
        if upbeat < quarters:  # bars are counted from the first whole one
            metres.insert(1, Metre(0.0, float(quarters)))
            metres.append(Metre(float(upbeat), float(holding[min(1, len(bars) - 1)] or quarters)))
            metres.sort(key=lambda metre: metre.beat)
    return metres


def _names(root: Element) -> dict[str, str]:
    return {
        part.get("id", ""): printable(part.findtext("part-name") or "")
        for part in root.iterfind("part-list/score-part")
    }


def _title(root: Element) -> str:
    for path in ("work/work-title", "movement-title"):
        title = (root.findtext(path) or "").strip()
        if title:
            return printable(title)
    return ""
