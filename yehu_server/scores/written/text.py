"""Show what was understood of a written score, as text and as JSON."""

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Iterator
from fractions import Fraction
from functools import lru_cache
from itertools import groupby
from operator import itemgetter
from typing import Any

from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.written.dynamics import LEVELS
from yehu_server.scores.written.in_range import default_parts, moved_part
from yehu_server.scores.written.layout import name_of
from yehu_server.scores.written.notated import Grace, Mark, Note, Part, Written

ARTICULATED = {float(number): row.name for number, row in enumerate(ARTICULATIONS)}
MAX_TEMPI = 20  # that the head shows


def lines_of(written: Written, within: NoteRange = YEHU) -> Iterator[str]:
    """The score as lines: its head, then each part's notes, moved for those `within`."""
    yield written.title or "(no title)"
    yield from written.remarks
    for key in written.keys:
        yield f"bar {written.place(key.beat)[0]}: 1={key.do}"
    tempi = _changes((each.beat, each.quarters_per_minute) for each in written.tempi)
    for beat, quarters in tempi[:MAX_TEMPI]:
        yield f"bar {written.place(beat)[0]}: {quarters:g} quarters a minute"
    if len(tempi) > MAX_TEMPI:
        yield f"and {len(tempi) - MAX_TEMPI} more changes of tempo"
    for beat, quarters in _changes((Fraction(each.beat), each.quarters) for each in written.metres):
        bar = written.place(beat)[0]
        yield f"bar {bar}: {quarters:g} quarter{'' if quarters == 1.0 else 's'} in a bar"
    played = next(iter(default_parts(written, within)), None)
    for number, (part, name) in enumerate(zip(written.parts, written.names, strict=True), start=1):
        yield ""
        summary = _summary(written, part, within, is_played=number - 1 == played)
        yield f"part {number}: {name}, {summary}"
        yield f"{'bar':>5}  {'quarter':<8}  {'note':<7}  {'length':<7}  marks"
        yield from _notes(written, part)
    yield ""
    yield from [*written.warnings, *written.not_understood] or ["all marks understood"]


def _summary(written: Written, part: Part, within: NoteRange, *, is_played: bool) -> str:
    """The number and range of a part's notes, and whether it is played and moved."""
    if not part.notes:
        return "0 notes, not played"
    by_pitch = sorted(part.notes, key=lambda note: note.pitch)
    ends = by_pitch[0], by_pitch[-1]
    lowest, highest = (name_of(each.pitch, written.fifths_at(each.beat)) for each in ends)
    text = f"{len(part.notes)} note{'' if len(part.notes) == 1 else 's'}, {lowest} to {highest}"
    if is_played:
        text += ", played where no other is asked for"
    moved = moved_part(part, within)[1].summary
    return f"{text}; {moved}" if moved else text


def _changes(values: Iterable[tuple[Fraction, float]]) -> list[tuple[Fraction, float]]:
    """The values, by beats, that are not as the one before; of several at a beat the last."""
    held = sorted(dict(values).items())
    return [next(same) for _, same in groupby(held, key=itemgetter(1))]


def _notes(written: Written, part: Part) -> Iterator[str]:
    around = _around(written, part)
    last = ""
    for note in part.notes:
        bar, quarters = written.place(note.beat)
        fifths = written.fifths_at(note.beat)
        marks = [*around.get(note.beat, ()), *_graces("before", note.before, fifths)]
        marks += map(_mark, note.marks)
        if note.contour:
            marks.append("the pitch moves")
        marks += _graces("after", note.after, fifths)
        shown = "" if bar == last else bar
        last = bar
        yield (
            f"{shown:>5}  {_mixed(quarters + 1):<8}  {name_of(note.pitch, fifths):<7}  "
            f"{_mixed(note.length):<7}  {', '.join(marks)}"
        ).rstrip()


def _around(written: Written, part: Part) -> dict[Fraction, list[str]]:
    """Signs and spans as text, by the beats of the notes that they stand at."""
    beats = [note.beat for note in part.notes]
    around: dict[Fraction, list[str]] = defaultdict(list)

    def put(beat: Fraction, text: str) -> None:
        at = min(max(bisect_right(beats, beat) - 1, 0), len(beats) - 1)
        around[beats[at]].append(text)

    for sign in part.signs:
        text = f"[{_mark(Mark(sign.name, sign.value))}]"
        at = bisect_left(beats, sign.beat)  # it holds from the next note on
        if at and sign.name in LEVELS and beats[at - 1] < sign.beat < part.notes[at - 1].end:
            put(sign.beat, f"{text} from quarter {_mixed(written.place(sign.beat)[1] + 1)}")
        elif at < len(beats):
            put(beats[at], text)
    for span in part.spans if beats else ():
        put(span.begin, f"{span.name} (")
        put(span.end, f") {span.name}")
    return around


def _mark(mark: Mark) -> str:
    if mark.name in ("articulation", "gesture") and mark.value in ARTICULATED:
        return ARTICULATED[mark.value]
    if mark.value is None:
        return mark.name
    values = [value for value in (mark.value, mark.second) if value is not None]
    return " ".join([mark.name, *(f"{value:g}" for value in values)])


def _graces(where: str, graces: tuple[Grace, ...], fifths: int) -> Iterator[str]:
    if graces:
        yield f"{where}: {' '.join(name_of(grace.pitch, fifths) for grace in graces)}"


@lru_cache(maxsize=4096)
def _mixed(value: Fraction) -> str:
    """A number of quarters, such as 2 1/2."""
    whole, rest = divmod(value, 1)
    if not rest:
        return str(whole)
    return f"{whole} {rest}" if whole else str(rest)


def fields_of(written: Written) -> dict[str, Any]:
    """The score as JSON values; beats and lengths in quarters, pitches as MIDI notes."""
    return {
        "title": written.title,
        "tempi": [[float(each.beat), each.quarters_per_minute] for each in written.tempi],
        "keys": [[float(each.beat), each.fifths] for each in written.keys],
        "metres": [[each.beat, each.quarters] for each in written.metres],
        "parts": [_part(written, part) for part in written.parts],
        "unknown": dict(written.unknown),
        "warnings": list(written.warnings),
        "remarks": list(written.remarks),
    }


def _part(written: Written, part: Part) -> dict[str, Any]:
    return {
        "name": part.name,
        "notes": [_note(written, note) for note in part.notes],
        "spans": [
            [span.name, float(span.begin), float(span.end), span.value] for span in part.spans
        ],
        "signs": [[sign.name, float(sign.beat), sign.value] for sign in part.signs],
    }


def _note(written: Written, note: Note) -> dict[str, Any]:
    return {
        "bar": written.place(note.beat)[0],
        "beat": float(note.beat),
        "length": float(note.length),
        "pitch": note.pitch,
        "marks": [
            [mark.name, mark.value, *([mark.second] if mark.second else [])] for mark in note.marks
        ],
        "before": [grace.pitch for grace in note.before],
        "after": [grace.pitch for grace in note.after],
        "contour": [list(point) for point in note.contour],
    }
