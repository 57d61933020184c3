"""Which scores of a folder have to be rendered, and which are up to date."""

from __future__ import annotations

import argparse
import os
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.folder_tasks import Line, Task

if TYPE_CHECKING:
    from yehu_server.rendering.folder_tree import Tree

# What does not change the sound of a file. All other options do, also ones yet to be invented.
NEUTRAL = (
    "command",
    "config",
    "dask",
    "jobs",
    "json",
    "midi",
    "output",
    "overwrite",
    "plot",
    "quiet",
)
SOUNDING = ("playing", "scores", "rendering", "util")  # folders of code, beside what is compiled


def split_up_to_date(arguments: argparse.Namespace, tree: Tree) -> tuple[list[Task], list[Line]]:
    """What is to be rendered; and the lines of what is up to date.

    A score that failed is up to date too, as long as nothing has changed; ``--overwrite`` tries
    it again.
    """
    from yehu_server.rendering.build_records import hash_of, previous_line, up_to_date

    base = base_key(arguments)
    hashing = cache(hash_of)
    tasks, lines = [], []
    for entry in tree.entries:
        picture = None
        if arguments.plot is not None:
            beside = os.path.relpath(entry.target.with_suffix(".png"), arguments.output)
            picture = arguments.plot / beside
        key = f"{base}-{hash_of(entry.source)}"
        task = Task(arguments, entry, picture, key, _seconds(previous_line(entry.target)))
        line = up_to_date(entry.target, key, task.results, hashing)
        if line is None or ("error" in line and arguments.overwrite):
            tasks.append(task)
        else:
            lines.append({**line, "file": entry.name})
    return tasks, lines


def _seconds(line: Line) -> float:
    """How long a score was when it was rendered before, in seconds; 0 where it was not."""
    seconds: Any = line.get("duration_s", 0.0)
    return float(seconds) if isinstance(seconds, int | float) else 0.0


def base_key(arguments: argparse.Namespace) -> str:
    """Key of version and options."""
    from yehu_server.compile.cache_folder import source_hash
    from yehu_server.util import PACKAGE, __version__
    from yehu_server.util.source_key import key_of

    code = [path for name in SOUNDING for path in sorted((PACKAGE / name).rglob("*.py"))]
    options = sorted(
        (name, str(value.absolute()) if isinstance(value, Path) else value)
        for name, value in vars(arguments).items()
        if name not in NEUTRAL and not callable(value)
    )
    return key_of(code, __version__, source_hash(), repr(options))
