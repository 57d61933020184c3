"""Which scores a folder has, and where each is rendered to: songs/a.mid to songs/a.wav."""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from yehu_server.errors import ScoreError
from yehu_server.scores.reading import MIDI, WRITTEN
from yehu_server.util.files import error_reason

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
    """The scores of a folder in order, and by name what cannot be rendered, and why."""

    entries: tuple[Entry, ...]
    problems: tuple[tuple[str, str], ...]


def is_score(name: str) -> bool:
    """Whether a file is a score, by the ending of its name."""
    lower = name.lower()
    return os.path.splitext(lower)[1] in ENDINGS or lower.endswith(".jianpu.txt")  # noqa: PTH122 - a name is no path


def tree_of(folder: Path, output: Path, ending: str) -> Tree:
    """Find all scores below a folder.

    Hidden files and folders are left out, and the output's own folder where that is within. Links
    are followed, but no folder is read twice. `ending` is that of the files to write, such
    as ".wav". Raises ScoreError where the folder cannot be read.
    """
    problems: list[tuple[str, str]] = []
    names = sorted(_names(folder, output, problems))
    targets = _targets(names, ending)
    taken = "another score is rendered to a file of this name"
    problems += [(name, taken) for name in names if name not in targets]
    entries = (
        Entry(name, folder / name, output / targets[name]) for name in names if name in targets
    )
    return Tree(tuple(entries), tuple(sorted(problems)))


def _names(folder: Path, output: Path, problems: list[tuple[str, str]]) -> Iterator[str]:
    """Yield the names of scores, relative to the folder; warn of folders that cannot be read."""

    def is_unreadable(error: OSError) -> None:
        place = os.path.relpath(error.filename, folder)
        if place == ".":
            raise ScoreError(f"{folder}: {error_reason(error)}") from error
        problems.append((place, error_reason(error)))

    seen = {os.path.realpath(folder), os.path.realpath(output)}
    for place, folders, files in os.walk(folder, onerror=is_unreadable, followlinks=True):
        inner = {name: os.path.realpath(os.path.join(place, name)) for name in sorted(folders)}  # noqa: PTH118 - any name
        folders.clear()
        for name, real in inner.items():
            if not name.startswith(".") and real not in seen:
                seen.add(real)
                folders.append(name)
        for name in files:
            if not name.startswith(".") and is_score(name):
                yield os.path.relpath(os.path.join(place, name), folder)  # noqa: PTH118


def _targets(names: list[str], ending: str) -> dict[str, str]:
    """What each score is rendered to, by its name; none where that is taken.

    Of several that differ in nothing but their endings, or in capitals, which some disks do not
    distinguish, one has the plain name, and others keep their own ending before the new one.
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
