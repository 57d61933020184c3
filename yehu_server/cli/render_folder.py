"""``yehu-server render FOLDER -o FOLDER``: all scores of a folder, on all cores or a cluster."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import cluster_of, instrument_of
from yehu_server.cli.folder_tasks import Line, Task
from yehu_server.cli.render_pipe import is_piped
from yehu_server.cli.terminal import print_result, warn
from yehu_server.errors import OutputError, ParameterError, ScoreError
from yehu_server.rendering import build_records
from yehu_server.rendering.build_records import hash_of, previous_line, up_to_date
from yehu_server.util.source_key import key_of

if TYPE_CHECKING:
    from yehu_server.rendering.folder_tree import Tree

SOUNDS = (".wav", ".wave", ".flac", ".raw")  # which no folder is to be called


def is_for_folder(arguments: argparse.Namespace) -> bool:
    """Whether a folder is to be rendered.

    Raises ParameterError where a folder is named among others, or a cluster is wanted for less.
    """
    folders = [path for path in arguments.midi if path != "-" and os.path.isdir(path)]  # noqa: PTH112 - any name
    if folders and len(arguments.midi) > 1:
        raise ParameterError(f"{folders[0]}: is a folder; name it alone")
    if arguments.dask is not None and not folders:
        raise ParameterError("--dask is for a folder of scores")
    return bool(folders)


def run(arguments: argparse.Namespace) -> int:
    """Render a folder; return the exit code: 1 where some of its scores failed."""
    from yehu_server.cli.folder_cluster import absolute
    from yehu_server.cli.folder_runs import prepare, render_all
    from yehu_server.rendering.folder_tree import tree_of

    [folder] = arguments.midi
    form = _check(arguments)
    tree = tree_of(folder, arguments.output, f".{form}")
    if not tree.entries and not tree.problems:
        raise ScoreError(f"{folder}: has no scores")
    for name, why in tree.skipped:
        warn(f"{name}: {why}")
    places = {entry.target.parent for entry in tree.entries}
    setup = partial(prepare, absolute(arguments))
    with cluster_of(arguments, setup) as cluster, build_records.alone_in(arguments.output):
        build_records.check_manifest(arguments.output)
        build_records.clear_work(places)
        lines: list[Line] = [{"file": name, "error": why} for name, why in tree.problems]
        tasks, current = split_up_to_date(arguments, tree)
        lines += current
        for line in lines * arguments.json:
            print(json.dumps(line))
        try:
            if tasks:
                render_all(arguments, tasks, len(tree.entries), lines, cluster)
        except KeyboardInterrupt:
            made = sum("error" not in line for line in lines)
            raise KeyboardInterrupt(
                f"{made} of {len(tree.entries)} scores are in {arguments.output}; "
                "the same command goes on"
            ) from None
        finally:
            build_records.clear_work(places)
            build_records.write_manifest(arguments.output, lines)
    return _report(arguments, lines, current)


def _check(arguments: argparse.Namespace) -> str:
    """Check the options before any file is looked at; return the format to write."""
    from yehu_server.cli.playing_options import playing_options_of
    from yehu_server.cli.sound_options import check_stage
    from yehu_server.core.physics.grid import check_rate
    from yehu_server.util.sound_file import check_format

    form = arguments.format or "wav"
    if is_piped(arguments.output):
        raise OutputError("a folder is rendered to a folder, not to standard output")
    if not arguments.output.is_dir() and arguments.output.suffix.lower() in SOUNDS:
        raise OutputError(
            f"{arguments.midi[0]}: is a folder, which is rendered to a folder, "
            f"not to {arguments.output.name}"
        )
    if arguments.stems is not None:
        raise ParameterError("--stems is for one score, not for a folder")
    if form == "raw":
        raise ParameterError("--format raw is for -o -, not for a folder")
    if arguments.output.exists() and not arguments.output.is_dir():
        raise OutputError(f"{arguments.output}: is a file; name a folder")
    if not os.path.isdir(arguments.output.parent):  # noqa: PTH112 - as it is named
        raise OutputError(
            f"{arguments.output}: the folder {arguments.output.parent} does not exist"
        )
    if arguments.dask is not None and arguments.jobs is not None:
        raise ParameterError("--jobs is for this machine: a cluster uses all of its workers")
    check_rate(arguments.rate)
    check_stage(arguments)
    check_format(form, arguments.subtype or "24", 1 if arguments.mono else 2)
    instrument_of(arguments)
    playing_options_of(arguments)
    if arguments.plot is not None:
        from yehu_server.util.extras import need

        need("matplotlib", "--plot", "plots")
    return str(form)


def _report(arguments: argparse.Namespace, lines: Sequence[Line], current: Sequence[Line]) -> int:
    """Tell of all files at the end; return the exit code.

    `current`: the lines of those that were up to date, or had failed before.
    """
    failed = sorted((line for line in lines if "error" in line), key=lambda line: line["file"])
    for line in failed:
        warn(f"{line['file']}: {line['error']}")
    if not arguments.json and not arguments.quiet:
        before = sum("error" in line for line in current)
        up_to_date = len(current) - before
        made = len(lines) - len(failed) - up_to_date
        counts = f"{made} rendered, {up_to_date} up to date, {len(failed)} failed"
        if before:
            counts += f" ({before} as before; --overwrite tries again)"
        print_result(f"{arguments.output}: {counts}")
    return 1 if failed else 0


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

    code = [path for name in SOUNDING for path in sorted((PACKAGE / name).rglob("*.py"))]
    options = sorted(
        (name, str(value.absolute()) if isinstance(value, Path) else value)
        for name, value in vars(arguments).items()
        if name not in NEUTRAL and not callable(value)
    )
    return key_of(code, __version__, source_hash(), repr(options))
