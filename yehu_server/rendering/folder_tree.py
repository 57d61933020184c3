"""Which scores a folder has, and the file that each is rendered to.

The tree is kept: ``songs/a.mid`` becomes ``songs/a.wav``.
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from yehu_server.errors import ScoreError
from yehu_server.scores.reading import MIDI, WRITTEN
from yehu_server.util.files import is_same, why

MOST_SCORES = 100_000
MOST_FOLDERS = 100_000
MOST_DEPTH = 64
# The first is preferred for a plain name. A text may be anything, such as about the others.
ENDINGS = tuple(ending for ending in (*MIDI, *WRITTEN) if ending != ".txt")


@dataclass(frozen=True)
class Entry:
    """A score: its name within the folder, and the files that are read and written."""

    name: str
    source: Path
    target: Path


@dataclass(frozen=True)
class Tree:
    """The scores of a folder in order, and by name what is not looked at, and why."""

    entries: tuple[Entry, ...]
    problems: tuple[tuple[str, str], ...]  # what should have been rendered
    skipped: tuple[tuple[str, str], ...] = ()  # links that lead round in a circle


def is_score(name: str) -> bool:
    """Whether a file is a score, by the ending of its name."""
    lower = name.lower()
    return os.path.splitext(lower)[1] in ENDINGS or lower.endswith(".jianpu.txt")  # noqa: PTH122 - a name is no path


def tree_of(folder: Path, output: Path, ending: str) -> Tree:
    """Find all scores below a folder.

    Hidden files and folders are left out, and the output's own folder where that is within. Links
    are followed, unless they lead back to a folder they are in. `ending` is that of the files to
    write, such as ".wav". Raises ScoreError where the folder cannot be read, or has more than
    `MOST_SCORES`.
    """
    problems: list[tuple[str, str]] = []
    skipped: list[tuple[str, str]] = []
    try:
        walk = _walk(folder, output, problems, skipped)
        names = sorted(itertools.islice(walk, MOST_SCORES + 1))
    except OSError as error:
        raise ScoreError(f"{folder}: cannot be read: {why(error)}") from error
    if len(names) > MOST_SCORES:
        raise ScoreError(f"{folder}: has more than {MOST_SCORES} scores")
    targets = _targets(names, ending)
    taken = "another score is rendered to a file of this name"
    problems += [(name, taken) for name in names if name not in targets]
    entries = (
        Entry(name, folder / name, output / targets[name]) for name in names if name in targets
    )
    return Tree(tuple(entries), tuple(sorted(problems)), tuple(sorted(skipped)))


def _walk(
    folder: Path, output: Path, problems: list[tuple[str, str]], skipped: list[tuple[str, str]]
) -> Iterator[str]:
    """Yield the names of scores, relative to the folder; tell what is not looked at."""
    is_apart = not is_same(folder, output)
    waiting: list[tuple[str, tuple[tuple[int, int], ...]]] = [("", (_identity(folder),))]
    seen = 0
    while waiting:
        place, above = waiting.pop()
        seen += 1
        if seen > MOST_FOLDERS:
            raise ScoreError(f"{folder}: has more than {MOST_FOLDERS} folders")
        try:
            with os.scandir(folder / place) as entries:
                found = [(entry.name, _is_folder(entry)) for entry in entries]
        except OSError as error:
            if not place:
                raise
            problems.append((place, f"cannot be read: {why(error)}"))
            continue
        for name, is_folder in found:
            path = f"{place}/{name}" if place else name
            if name.startswith("."):
                continue
            if not is_folder:
                if is_score(name):
                    yield path
                continue
            if is_apart and is_same(folder / path, output):
                continue
            own = _identity(folder / path)
            if own in above:
                skipped.append((path, "a link back to a folder it is in"))
            elif len(above) >= MOST_DEPTH:
                problems.append((path, f"more than {MOST_DEPTH} folders deep"))
            else:
                waiting.append((path, (*above, own)))


def _is_folder(entry: os.DirEntry[str]) -> bool:
    try:
        return entry.is_dir()
    except OSError:  # such as a link to itself
        return False


def _identity(path: Path) -> tuple[int, int]:
    status = os.stat(path)  # noqa: PTH116 - as scandir, without a Path's own errors
    return status.st_dev, status.st_ino


def _targets(names: list[str], ending: str) -> dict[str, str]:
    """What each score is rendered to, by its name; none where that is taken.

    Of several that differ in nothing but their endings, or in capitals, which some disks do not
    tell apart, one has the plain name, and others keep their own ending before the new one.
    """
    taken: set[str] = set()
    targets: dict[str, str] = {}
    rank = {ending: number for number, ending in enumerate(ENDINGS)}
    split = [(name, *os.path.splitext(name)) for name in names]  # noqa: PTH122 - no Path
    split.sort(key=lambda each: (rank.get(each[2], len(rank)), each[0]))
    stems = [(name, stem) for name, stem, _ in split]
    for name, stem in (*stems, *((name, name) for name, _ in stems)):
        target = stem + ending
        if name not in targets and target.casefold() not in taken:
            taken.add(target.casefold())
            targets[name] = target
    return targets
