"""Compare the reader of written scores with music21, over a folder: pitch, beat and length.

    PYTHONPATH=. PYTHON scripts/compare_scores.py FOLDER [--most 1000] [--list differences.txt]

PYTHON has this package's dependencies and music21 (developed with 10.5), which is too large for
every install. A part agrees where each of its notes has the beat, length and pitch that music21
reads, repeats unfolded; of chords the highest note counts. It also tells how many intervals of the
parts are kept when they are moved into range as a whole, and note by note, as in live playing.
"""

from __future__ import annotations

import argparse
import signal
import warnings
from collections import Counter
from collections.abc import Iterator
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
LIMIT_S = 60  # for music21 to read a file
LOWEST, HIGHEST = 65, 89

Notes = list[tuple[Fraction, Fraction, float]]


def read_by_music21(path: Path) -> Notes:
    """All notes that sound, of all parts, in order."""
    import music21  # type: ignore[import-not-found, unused-ignore]

    parsed: Any = music21.converter.parse(path)
    found: set[tuple[Fraction, Fraction, float]] = set()
    for part in parsed.toSoundingPitch().parts:
        try:
            unfolded = part.expandRepeats()
        except music21.repeat.ExpanderException:
            unfolded = part
        for each in unfolded.stripTies().flatten().notes:
            if each.duration.isGrace or isinstance(each, music21.harmony.ChordSymbol):
                continue
            pitches = getattr(each, "pitches", ())
            if pitches:
                found.add((_exact(each.offset), _exact(each.quarterLength), _highest(pitches)))
    return sorted(found)


def _exact(value: Any) -> Fraction:
    return Fraction(value).limit_denominator(10_000)


def _highest(pitches: Any) -> float:
    return max(float(pitch.ps) for pitch in pitches)


def read_by_us(written: Written) -> Notes:
    """The same by our own reader."""
    return sorted(
        {
            (_exact(note.beat), _exact(note.length), note.pitch)
            for part in written.parts
            for note in part.notes
        }
    )


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


def main() -> None:  # noqa: PLR0915 - one pass over the files
    """Compare and print."""
    words = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    words.add_argument("folder", type=Path)
    words.add_argument("--most", type=int, default=100_000)
    words.add_argument("--list", type=Path)
    words.add_argument("--intervals", action="store_true", help="do not ask music21")
    asked = words.parse_args()
    warnings.simplefilter("ignore")
    counts: Counter[str] = Counter()
    intervals = [0, 0, 0]
    fitting = [0, 0, 0]
    differences = []
    signal.signal(signal.SIGALRM, _too_slow)
    for path in files_of(asked.folder, asked.most):
        counts["files"] += 1
        try:
            written = read_written(path)
        except YehuError as error:
            counts["refused by us"] += 1
            differences.append(f"{path}: {error}")
            continue
        first = next((part for part in written.parts if part.notes), None)
        if first is not None:
            *values, fits = kept(first)
            intervals = [a + b for a, b in zip(intervals, values, strict=True)]
            if fits:
                fitting = [a + b for a, b in zip(fitting, values, strict=True)]
        if asked.intervals:
            continue
        try:
            signal.alarm(LIMIT_S)
            other = read_by_music21(path)
        except Exception as error:  # noqa: BLE001 - another program may fail in any way
            counts["not read by music21"] += 1
            differences.append(f"{path}: music21: {type(error).__name__}")
            continue
        finally:
            signal.alarm(0)
        own = read_by_us(written)
        counts["compared"] += 1
        same = {(a, c) for a, _, c in own} & {(a, c) for a, _, c in other}
        counts["notes"] += len(other)
        counts["notes that agree"] += len(same)
        counts["the same notes"] += own == other
        counts["the same pitches and beats"] += [x[::2] for x in own] == [x[::2] for x in other]
        if own != other:
            first_bad = next((x for x in zip(own, other, strict=False) if x[0] != x[1]), None)
            told = (
                ""
                if first_bad is None
                else f"{[*map(str, first_bad[0])]} {[*map(str, first_bad[1])]}"
            )
            differences.append(f"{path}: {len(own)}, music21 {len(other)}; {told}")
    _tell(counts, {"first parts": intervals, "those that fit": fitting})
    if asked.list:
        asked.list.write_text("\n".join(differences) + "\n", encoding="utf-8")


def _tell(counts: Counter[str], intervals: dict[str, list[int]]) -> None:
    for name, count in counts.items():
        print(f"{name}: {count}")
    for name, (total, alone, whole) in intervals.items():
        if total > 0:
            shares = f"{100 * alone / total:.2f} % note by note, {100 * whole / total:.2f} % now"
            print(f"intervals of {name}: {total}; kept: {shares}")


def _too_slow(*_: object) -> None:
    raise TimeoutError


if __name__ == "__main__":
    main()
