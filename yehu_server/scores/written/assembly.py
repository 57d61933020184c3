"""Make a score with its repeats unfolded of the bars of all parts as they stand on the page."""

from collections import Counter
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import groupby
from typing import Any

from yehu_server.errors import ScoreError
from yehu_server.scores.score import COMMON_TIME, KeySignature, Metre
from yehu_server.scores.written import notated
from yehu_server.scores.written.notated import Bar, Part, Tempo, Written
from yehu_server.scores.written.repeats import BarLines, left_out, order_of
from yehu_server.scores.written.ticks import TICKS, Ticks, bounded, metre_at, quarters_of
from yehu_server.scores.written.voices import RawBar, parts_of

MAX_KINDS = 100  # of unknown marks that are named
MAX_REPEATED, MAX_OFTEN = 10_000, 4  # notes, or times as many as written
MAX_LEFT_OUT = 8  # places of bars that are named


def assembled(
    parts: Sequence[tuple[str, list[RawBar]]],
    title: str,
    unknown: Counter[str],
    warnings: Counter[str],
    sections: Sequence[range] = (),
) -> Written:
    """Return a score of the bars of its parts, which are named.

    `unknown` counts marks that were not understood, `warnings` all else that was
    wrong. `sections` are bars that are played one after another, each with repeats of its own, as a
    header of ABC says; without them all bars. Raises ScoreError where it is beyond bounds.
    """
    parts_bars = [bars for _, bars in parts]
    count = max(map(len, parts_bars), default=0)
    lines = [_lines(parts_bars, number) for number in range(count)]
    order: list[int] = []
    for section in sections or [range(count)]:
        begin = section.start
        order += (begin + at for at in order_of(lines[begin : section.stop]))
    _check_amount(parts_bars, order)
    played, end = _timed(parts_bars, order)
    found: list[Part] = []
    tempi: dict[Fraction, tuple[int, float]] = {}
    for name, bars in parts:
        its_parts, its_tempi = parts_of(name, bars, played, end)
        found += its_parts
        for beat, ranked in its_tempi.items():
            if beat not in tempi or ranked[0] > tempi[beat][0]:
                tempi[beat] = ranked
    longest = max(parts_bars, key=len, default=[])
    lines_of_warnings = [notated.times(text, number) for text, number in warnings.items()]
    if missing := left_out(count, order):
        lines_of_warnings.insert(0, _left_out_line(missing, longest))
    return Written(
        tuple(found),
        tuple(Tempo(beat, tempo) for beat, (_, tempo) in sorted(tempi.items())),
        tuple(_metres(longest, played)),
        tuple(Bar(quarters_of(begin), longest[number].number) for number, begin in played),
        title,
        dict(unknown.most_common(MAX_KINDS)),
        tuple(lines_of_warnings),
        keys=tuple(_keys(longest, played)),
    )


def _left_out_line(missing: Sequence[int], bars: Sequence[RawBar]) -> str:
    """A line that names bars by their numbers."""
    together = groupby(enumerate(missing), key=lambda each: each[1] - each[0])
    runs = ([bars[at].number for _, at in run] for _, run in together)
    names = [run[0] if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs]
    plural = "bar is" if len(missing) == 1 else "bars are"
    named = notated.listed(names, MAX_LEFT_OUT)
    return f"{len(missing)} {plural} not played, which repeats or jumps pass over: {named}"


def _keys(bars: Sequence[RawBar], played: Iterable[tuple[int, Ticks]]) -> Iterable[KeySignature]:
    holding, last = _holding(bar.fifths for bar in bars), None
    for number, begin in played:
        fifths = holding[number]
        if fifths is not None and fifths != last:
            last = fifths
            yield KeySignature(quarters_of(begin), fifths)


def _check_amount(parts_bars: list[list[RawBar]], order: list[int]) -> None:
    """Refuse scores that are too large, or that repeats make so."""
    written = sum(len(bar.notes) for bars in parts_bars for bar in bars)
    if written > notated.MAX_NOTES:
        raise ScoreError(f"has more than {notated.MAX_NOTES} notes")
    played = sum(
        len(bars[number].notes) for bars in parts_bars for number in order if number < len(bars)
    )
    if played > max(MAX_REPEATED, MAX_OFTEN * written):
        raise ScoreError(f"has {played} notes with its repeats, more than {MAX_REPEATED}")


def _lines(parts_bars: list[list[RawBar]], number: int) -> BarLines:
    """The bar lines of all parts as one; many writers give repeats to the first part alone."""
    found = BarLines()
    for bars in parts_bars:
        if number < len(bars):
            lines = bars[number].lines
            found.forward |= lines.forward
            found.double |= lines.double
            found.times = max(found.times, lines.times)
            found.endings |= lines.endings
            found.opens |= lines.opens
            found.jumps |= lines.jumps
    return found


def _timed(
    parts_bars: list[list[RawBar]], order: list[int]
) -> tuple[list[tuple[int, Ticks]], Ticks]:
    """The beats at which bars begin, as the fullest part has them, and that of the end."""
    lengths: dict[int, Ticks] = {}
    metres = _holding(bar.metre for bar in max(parts_bars, key=len, default=[]))
    begin: Ticks = 0
    played = []
    for number in order:
        if number not in lengths:
            own = [bars[number] for bars in parts_bars if number < len(bars)]
            lengths[number] = _length(own, metres[number])
        played.append((number, begin))
        begin = bounded(begin + lengths[number])
        if begin > notated.MAX_BEATS * TICKS:
            raise ScoreError(f"is longer than {notated.MAX_BEATS} quarters, with its repeats")
    return played, begin


def _length(bars: Sequence[RawBar], metre: Ticks | None) -> Ticks:
    """The length of a bar in all parts; a rest that is too long in one part does not count."""
    lengths = {bar.length for bar in bars if bar.notes} or {bar.length for bar in bars}
    if metre is None or len(lengths) == 1 or max(lengths) <= metre:
        return max(lengths)
    sounding = [note.at + note.length for bar in bars for note in bar.notes if not note.is_grace]
    return max([metre, *sounding])


def _holding(written: Iterable[Any]) -> list[Any]:
    """The value that holds at each bar, such as the metre: the last written one, or None."""
    held = None
    return [held := held if own is None else own for own in written]


def _metres(bars: list[RawBar], played: list[tuple[int, Ticks]]) -> list[Metre]:
    """The time signatures, in order; a short first bar counts back from the second."""
    metres = [COMMON_TIME]
    holding = _holding(bar.metre for bar in bars)
    for number, begin in played:
        metre = holding[number] if number < len(holding) else None
        if metre is not None and float(metre / TICKS) != metres[-1].quarters:
            metres.append(metre_at(begin, metre))
    if bars and played and len(played) > 1 and played[0][0] == 0:
        metre = holding[0] or 4 * TICKS
        upbeat = played[1][1]
        if upbeat < metre:  # bars are counted from the first whole one
            metres.insert(1, metre_at(0, metre))
            metres.append(metre_at(upbeat, holding[min(1, len(bars) - 1)] or metre))
            metres.sort(key=lambda metre: metre.beat)
    return metres
