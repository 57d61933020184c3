"""What was understood of a written score, as text for a person and as JSON."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from yehu_server.playing.pitch_and_level import note_name
from yehu_server.scores.written.notated import Grace, Mark, Note, Part, Tempo, Written
from yehu_server.scores.written.performed import CHANNELS

MOST_TEMPI = 20  # that the head shows


def lines_of(written: Written) -> Iterator[str]:
    """The score as lines: what is at its head, then the notes of each part."""
    yield written.title or "(no title)"
    tempi = _tempi(written)
    for tempo in tempi[:MOST_TEMPI]:
        yield f"bar {written.place(tempo.beat)[0]}: {tempo.quarters_per_minute:g} quarters a minute"
    if len(tempi) > MOST_TEMPI:
        yield f"and {len(tempi) - MOST_TEMPI} more changes of tempo"
    last = 0.0
    for metre in written.metres:
        if metre.quarters != last:
            last = metre.quarters
            bar = written.place(Fraction(metre.beat))[0]
            yield f"bar {bar}: {last:g} quarter{'' if last == 1.0 else 's'} in a bar"
    channels = iter(CHANNELS)
    for number, part in enumerate(written.parts, start=1):
        yield ""
        channel = next(channels, None) if part.notes else None
        where = "not played" if channel is None else f"channel {channel + 1}"
        name = f": {part.name}" if part.name else ""
        yield f"part {number}{name}, {where}, {len(part.notes)} notes"
        yield f"{'bar':>5}  {'quarter':<8}  {'note':<7}  {'length':<7}  marks"
        yield from _notes(written, part)
    yield ""
    yield from told_unknown(written)


def told_unknown(written: Written) -> Iterator[str]:
    """What was not understood, and the warnings."""
    yield from [*written.not_understood, *written.warnings] or ["all marks understood"]


def _tempi(written: Written) -> list[Tempo]:
    shown: list[Tempo] = []
    for tempo in written.tempi:
        if not shown or tempo.quarters_per_minute != shown[-1].quarters_per_minute:
            shown.append(tempo)
    return shown


def _notes(written: Written, part: Part) -> Iterator[str]:
    around = _around(part)
    last = ""
    for note in part.notes:
        bar, quarters = written.place(note.beat)
        marks = [*around.get(note.beat, ()), *_graces("before", note.before)]
        marks += map(_mark, note.marks)
        if note.contour:
            marks.append("the pitch moves")
        marks += _graces("after", note.after)
        shown = "" if bar == last else bar
        last = bar
        yield (
            f"{shown:>5}  {_mixed(quarters + 1):<8}  {note_name(note.pitch):<7}  "
            f"{_mixed(note.length):<7}  {', '.join(marks)}"
        ).rstrip()


def _around(part: Part) -> dict[Fraction, list[str]]:
    """What signs and spans say, by the beat of the note that they stand at."""
    beats = [note.beat for note in part.notes]
    around: dict[Fraction, list[str]] = defaultdict(list)

    def put(beat: Fraction, text: str) -> None:
        at = min(max(bisect_right(beats, beat) - 1, 0), len(beats) - 1)
        around[beats[at]].append(text)

    for sign in part.signs:
        at = bisect_left(beats, sign.beat)  # it holds from the next note on
        if at < len(beats):
            put(beats[at], f"[{_mark(Mark(sign.name, sign.value))}]")
    for span in part.spans if beats else ():
        put(span.begin, f"{span.name} (")
        put(span.end, f") {span.name}")
    return around


def _mark(mark: Mark) -> str:
    return mark.name if mark.value is None else f"{mark.name} {mark.value:g}"


def _graces(where: str, graces: tuple[Grace, ...]) -> Iterator[str]:
    if graces:
        yield f"{where}: {' '.join(note_name(grace.pitch) for grace in graces)}"


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
        "metres": [[each.beat, each.quarters] for each in written.metres],
        "parts": [_part(written, part) for part in written.parts],
        "unknown": dict(written.unknown),
        "warnings": list(written.warnings),
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
        "marks": [[mark.name, mark.value] for mark in note.marks],
        "before": [grace.pitch for grace in note.before],
        "after": [grace.pitch for grace in note.after],
        "contour": [list(point) for point in note.contour],
    }
