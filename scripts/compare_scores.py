"""Compare the reader of written scores with another program, over a folder: pitch, beat, length.

    PYTHONPATH=. PYTHON scripts/compare_scores.py FOLDER [--most 1000] [--list differences.txt]
    PYTHONPATH=. .venv/bin/python scripts/compare_scores.py FOLDER --midi MIDI_FOLDER

The first compares with music21: PYTHON has this package's dependencies and music21 (developed with
10.5), which is too large for every install. The second compares with the MIDI files that another
program wrote of the scores, in MIDI_FOLDER and named as they are; those that are missing are made
by MuseScore, where it is installed.

A note agrees where the other program has one at the same beat of the same bar, as bars are played,
at the same pitch; of chords the highest counts. Bars are compared and not beats from the beginning,
since music21 leaves parts of a score apart from each other after a bar that one of them does not
fill, and MuseScore makes such bars longer. Where music21 cannot unfold the repeats, or has the bars
in another order, each bar counts once. It also tells how many intervals of the parts are kept when
they are moved into range as a whole, and note by note, as in live playing.
"""

from __future__ import annotations

import argparse
import signal
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from score_readings import Reading, read_by_midi, read_by_music21, read_by_us

from yehu_server.errors import YehuError
from yehu_server.playing.tuning import RangePolicy
from yehu_server.scores.musicxml.musescore import export
from yehu_server.scores.reading import read_written
from yehu_server.scores.written.in_range import moved_part
from yehu_server.scores.written.notated import Part, Written

ENDINGS = (".musicxml", ".xml", ".mxl", ".abc")
OF_MIDI = (*ENDINGS, ".jianpu")  # of which LilyPond makes MIDI files, after jianpu-ly
LOWEST, HIGHEST = 65, 89
# What files may differ in.
APART = "music21 has the parts apart"
FOLDED = "music21 does not unfold the repeats"
ORDER = "another order of bars"
LENGTHS = "lengths alone"
NOTES = "other notes"
MOVED = "bars of other lengths"
MORE = "bars that the other program alone plays"


@dataclass
class Judged:
    """How far two readings agree."""

    notes: int  # that the other program has
    alone: int  # that we alone have
    same: int
    same_lengths: int  # of these
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
        own_lengths = other_lengths = own & other  # are not compared
    else:
        own = Counter((str(each.bar), each.offset, each.pitch) for each in ours.notes)
        other = Counter((str(each.bar), each.offset, each.pitch) for each in theirs.notes)
        own_lengths = _with_lengths(ours)
        other_lengths = _with_lengths(theirs)
    if not theirs.is_together:
        kinds.append(APART)
    if theirs.moved:
        kinds.append(MOVED)
    if theirs.beside:
        kinds.append(MORE)
    more, less = own - other, other - own
    first = ""
    if more or less:
        kinds.append(NOTES)
        first = f"ours {_shown(more)}; theirs {_shown(less)}"
    elif own_lengths != other_lengths:
        kinds.append(LENGTHS)
        longer, shorter = own_lengths - other_lengths, other_lengths - own_lengths
        first = f"ours {_shown(longer)}; theirs {_shown(shorter)}"
    same_lengths = (own_lengths & other_lengths).total()
    same = (own & other).total()
    return Judged(other.total(), more.total(), same, same_lengths, kinds, first)


def _with_lengths(reading: Reading) -> Counter[Any]:
    return Counter((str(each.bar), each.offset, each.pitch, each.length) for each in reading.notes)


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


def files_of(folder: Path, most: int, endings: tuple[str, ...]) -> Iterator[Path]:
    """Scores below a folder, spread over all of them where they are more."""
    found = sorted(path for path in folder.rglob("*") if path.suffix.lower() in endings)
    step = max(len(found) // most, 1)
    return iter(found[::step][:most])


class Comparison:
    """Compares file after file, and counts.

    With music21, `limit_s` (s) for a file; or with the MIDI files of a folder.
    """

    def __init__(self, folder: Path, limit_s: int, midi: Path | None = None) -> None:
        self._folder, self._limit_s, self._midi = folder, limit_s, midi
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
            self._ask(path, written)

    def _count_intervals(self, written: Written) -> None:
        first = next((part for part in written.parts if part.notes), None)
        if first is not None:
            *values, fits = kept(first)
            for name in ["first parts", *["those that fit"] * fits]:
                pairs = zip(self.intervals[name], values, strict=True)
                self.intervals[name] = [a + b for a, b in pairs]

    def _ask(self, path: Path, written: Written) -> None:
        try:
            signal.alarm(self._limit_s)
            ours, theirs = self._readings(path, written)
        except Exception as error:  # noqa: BLE001 - another program may fail in any way
            self.counts["not read by the other program"] += 1
            self.differences.append(f"{path}: not compared: {type(error).__name__}: {error}")
            return
        finally:
            signal.alarm(0)
        found = judged(ours, theirs)
        self.counts["compared"] += 1
        self.counts["notes"] += found.notes
        self.counts["notes that agree"] += found.same
        self.counts["of these, of the same length"] += found.same_lengths
        self.counts["notes that only ours has"] += found.alone
        self.counts["notes with ornaments, not compared"] += theirs.left_out
        self.counts["notes in bars that the other program alone plays"] += theirs.beside
        self.kinds.update([", ".join(found.kinds) or "the same"])
        if found.kinds:
            share = 100.0 * found.same / found.notes if found.notes else 100.0
            kinds = ", ".join(found.kinds)
            self.differences.append(f"{path}: {share:.1f} % of notes; {kinds}; {found.first}")

    def _readings(self, path: Path, written: Written) -> tuple[Reading, Reading]:
        if self._midi is None:
            return read_by_us(written), read_by_music21(path)
        file = self._midi / path.relative_to(self._folder).with_suffix(".mid")
        if not file.exists():
            file.parent.mkdir(parents=True, exist_ok=True)
            export(path, file)
        return read_by_midi(file, written)

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
    words.add_argument("--intervals", action="store_true", help="compare with no other program")
    words.add_argument("--limit", type=int, default=600, help="seconds for music21 to read a file")
    words.add_argument("--midi", type=Path, help="MIDI files of another program to compare with")
    asked = words.parse_args()
    warnings.simplefilter("ignore")
    signal.signal(signal.SIGALRM, _too_slow)
    comparison = Comparison(asked.folder, asked.limit, asked.midi)
    for path in files_of(asked.folder, asked.most, OF_MIDI if asked.midi else ENDINGS):
        comparison.add(path, asks=not asked.intervals)
    comparison.tell()
    if asked.list:
        asked.list.write_text("\n".join(comparison.differences) + "\n", encoding="utf-8")


def _too_slow(*_: object) -> None:
    raise TimeoutError


if __name__ == "__main__":
    main()
