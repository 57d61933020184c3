"""Compare the reader of written scores with music21, over a folder: pitch, beat and length.

    PYTHONPATH=. PYTHON scripts/compare_scores.py FOLDER [--most 1000] [--list differences.txt]

PYTHON has this package's dependencies and music21 (developed with 10.5), which is too large for
every install. A note agrees where music21 reads one at the same beat of the same bar, as bars are
played, at the same pitch; of chords the highest counts. Bars are compared and not beats from the
beginning, since music21 leaves parts of a score apart from each other after a bar that one of them
does not fill. Where it cannot unfold the repeats, or has the bars in another order, each bar counts
once. It also tells how many intervals of the parts are kept when they are moved into range as a
whole, and note by note, as in live playing.
"""

from __future__ import annotations

import argparse
import re
import signal
import warnings
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

from yehu_server.errors import YehuError
from yehu_server.playing.tuning import RangePolicy
from yehu_server.scores.reading import read_written
from yehu_server.scores.written.in_range import moved_part
from yehu_server.scores.written.notated import Part, Written

ENDINGS = (".musicxml", ".xml", ".mxl", ".abc")
LIMIT_S = 90  # for music21 to read a file
LOWEST, HIGHEST = 65, 89
# What files may differ in.
APART = "music21 has the parts apart"
FOLDED = "music21 does not unfold the repeats"
ORDER = "another order of bars"
LENGTHS = "lengths alone"
NOTES = "other notes"


@dataclass(frozen=True)
class Heard:
    """A note in its bar: the bar by its place as played, and by its number."""

    bar: int
    number: str
    offset: Fraction  # quarters
    length: Fraction
    pitch: float


@dataclass
class Reading:
    """All notes of a score, of all parts, and the numbers of its bars as played."""

    notes: list[Heard] = field(default_factory=list)
    bars: list[str] = field(default_factory=list)
    is_unfolded: bool = True
    is_together: bool = True  # all parts begin their bars at the same beats


def read_by_music21(path: Path) -> Reading:
    """What music21 reads."""
    import music21  # type: ignore[import-not-found, unused-ignore]

    parsed: Any = music21.converter.parse(path)
    found = Reading()
    begun: set[tuple[Fraction, ...]] = set()
    for part in parsed.toSoundingPitch().parts:
        try:
            unfolded = part.expandRepeats()
        except music21.repeat.ExpanderException:
            unfolded, found.is_unfolded = part, False
        measures = list(unfolded.getElementsByClass("Measure"))
        begins = [_exact(measure.offset) for measure in measures]
        found.bars = [str(measure.number) for measure in measures]
        begun.add(tuple(begins))
        for each in unfolded.stripTies().flatten().notes:
            if each.duration.isGrace or isinstance(each, music21.harmony.ChordSymbol):
                continue
            if pitches := getattr(each, "pitches", ()):
                pitch = max(float(pitch.ps) for pitch in pitches)
                length = _exact(each.quarterLength)
                found.notes.append(_heard(begins, found.bars, _exact(each.offset), length, pitch))
    found.is_together = len(begun) <= 1
    return found


def read_by_us(written: Written) -> Reading:
    """The same by our own reader."""
    begins = [bar.beat for bar in written.bars]
    numbers = [_number(bar.number) for bar in written.bars]
    notes = [
        _heard(begins, numbers, note.beat, note.length, note.pitch)
        for part in written.parts
        for note in part.notes
    ]
    return Reading(notes, numbers)


def _number(text: str) -> str:
    """The number of a bar as music21 has it: without the letter of one that a line divides."""
    found = re.match(r"\d+", text)
    return found[0] if found else text


def _heard(
    begins: list[Fraction], numbers: list[str], beat: Fraction, length: Fraction, pitch: float
) -> Heard:
    at = max(bisect_right(begins, _exact(beat)) - 1, 0)
    offset = _exact(beat) - (begins[at] if begins else 0)
    return Heard(at, numbers[at] if numbers else "", _exact(offset), _exact(length), pitch)


def _exact(value: Any) -> Fraction:
    return Fraction(value).limit_denominator(10_000)


@dataclass
class Judged:
    """How far two readings agree."""

    notes: int  # that music21 has
    same: int
    kinds: list[str]
    first: str = ""  # an example of what differs


def judged(ours: Reading, theirs: Reading) -> Judged:
    """Compare two readings."""
    kinds = []
    if not theirs.is_unfolded:
        kinds.append(FOLDED)
    elif ours.bars != theirs.bars and not _same_runs(ours, theirs):
        kinds.append(ORDER)
    if kinds:  # each bar once, by its number
        own = Counter({(each.number, each.offset, each.pitch) for each in ours.notes})
        other = Counter({(each.number, each.offset, each.pitch) for each in theirs.notes})
        longer: Counter[Any] = Counter()
    else:
        own = Counter((str(each.bar), each.offset, each.pitch) for each in ours.notes)
        other = Counter((str(each.bar), each.offset, each.pitch) for each in theirs.notes)
        longer = Counter((each.bar, each.offset, each.pitch, each.length) for each in ours.notes)
        longer.subtract((each.bar, each.offset, each.pitch, each.length) for each in theirs.notes)
    if not theirs.is_together:
        kinds.append(APART)
    more, less = own - other, other - own
    first = ""
    if more or less:
        kinds.append(NOTES)
        first = f"ours {_shown(more)}; music21 {_shown(less)}"
    elif any(longer.values()):
        kinds.append(LENGTHS)
    return Judged(other.total(), (own & other).total(), kinds, first)


def _same_runs(ours: Reading, theirs: Reading) -> bool:
    """Whether bars repeat at the same places, however they are numbered."""

    def back(numbers: list[str]) -> list[int]:
        seen: dict[str, int] = {}
        return [seen.setdefault(number, at) for at, number in enumerate(numbers)]

    return back(ours.bars) == back(theirs.bars)


def _shown(notes: Counter[Any]) -> str:
    some = sorted(notes, key=lambda each: (str(each[0]).zfill(6), *each[1:]))[:2]
    return f"{notes.total()} {[' '.join(map(str, each)) for each in some]}"


def kept(part: Part) -> tuple[int, int, int, bool]:
    """Intervals of a part: all, those kept one by one, and as a whole; whether one shift fits."""
    before = [note.pitch for note in part.notes]
    alone = [RangePolicy.TRANSPOSE.fit(pitch) for pitch in before]
    moved, _ = moved_part(part)
    whole = [RangePolicy.TRANSPOSE.fit(note.pitch) for note in moved.notes]
    fits = any(all(LOWEST <= pitch + 12 * by <= HIGHEST for pitch in before) for by in range(-5, 6))
    return len(before) - 1, _same(before, alone), _same(before, whole), fits


def _same(before: list[float], after: Any) -> int:
    pairs = zip(pairwise(before), pairwise(after), strict=True)
    return sum(abs((b - a) - (d - c)) < 1e-6 for (a, b), (c, d) in pairs)


def files_of(folder: Path, most: int) -> Iterator[Path]:
    """Scores below a folder, spread over all of them where they are more."""
    found = sorted(path for path in folder.rglob("*") if path.suffix.lower() in ENDINGS)
    step = max(len(found) // most, 1)
    return iter(found[::step][:most])


class Comparison:
    """Compares file after file, and counts."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()
        self.kinds: Counter[str] = Counter()
        self.intervals = {"first parts": [0, 0, 0], "those that fit": [0, 0, 0]}
        self.differences: list[str] = []

    def add(self, path: Path, *, asks: bool) -> None:
        """Compare a file; without `asks`, count its intervals alone."""
        self.counts["files"] += 1
        try:
            written = read_written(path)
        except YehuError as error:
            self.counts["refused by us"] += 1
            self.differences.append(str(error))
            return
        self._count_intervals(written)
        if asks:
            self._ask(path, read_by_us(written))

    def _count_intervals(self, written: Written) -> None:
        first = next((part for part in written.parts if part.notes), None)
        if first is not None:
            *values, fits = kept(first)
            for name in ["first parts", *["those that fit"] * fits]:
                pairs = zip(self.intervals[name], values, strict=True)
                self.intervals[name] = [a + b for a, b in pairs]

    def _ask(self, path: Path, ours: Reading) -> None:
        try:
            signal.alarm(LIMIT_S)
            theirs = read_by_music21(path)
        except Exception as error:  # noqa: BLE001 - another program may fail in any way
            self.counts["not read by music21"] += 1
            self.differences.append(f"{path}: music21: {type(error).__name__}")
            return
        finally:
            signal.alarm(0)
        found = judged(ours, theirs)
        self.counts["compared"] += 1
        self.counts["notes"] += found.notes
        self.counts["notes that agree"] += found.same
        self.kinds.update([", ".join(found.kinds) or "the same"])
        if found.kinds:
            share = 100.0 * found.same / found.notes if found.notes else 100.0
            kinds = ", ".join(found.kinds)
            self.differences.append(f"{path}: {share:.1f} % of notes; {kinds}; {found.first}")

    def tell(self) -> None:
        """Print what was counted."""
        for name, count in self.counts.items():
            print(f"{name}: {count}")
        if self.counts["notes"]:
            share = 100.0 * self.counts["notes that agree"] / self.counts["notes"]
            print(f"agreement: {share:.2f} % of notes")
        for name, count in self.kinds.most_common():
            print(f"files, {name}: {count}")
        for name, (total, alone, whole) in self.intervals.items():
            if total > 0:
                shares = f"{100 * alone / total:.2f} % note by note, {100 * whole / total:.2f} %"
                print(f"intervals of {name}: {total}; kept: {shares} now")


def main() -> None:
    """Compare and print."""
    words = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    words.add_argument("folder", type=Path)
    words.add_argument("--most", type=int, default=100_000)
    words.add_argument("--list", type=Path)
    words.add_argument("--intervals", action="store_true", help="do not ask music21")
    asked = words.parse_args()
    warnings.simplefilter("ignore")
    signal.signal(signal.SIGALRM, _too_slow)
    comparison = Comparison()
    for path in files_of(asked.folder, asked.most):
        comparison.add(path, asks=not asked.intervals)
    comparison.tell()
    if asked.list:
        asked.list.write_text("\n".join(comparison.differences) + "\n", encoding="utf-8")


def _too_slow(*_: object) -> None:
    raise TimeoutError


if __name__ == "__main__":
    main()
