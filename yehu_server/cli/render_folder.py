"""``yehu-server render FOLDER -o FOLDER``: all scores of a folder, on all cores or a cluster."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import secrets
import sys
from collections.abc import Generator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from yehu_server.cli.arguments import cluster_of
from yehu_server.cli.folder_tasks import Line, Task, perform
from yehu_server.cli.playing_options import playing_options_of
from yehu_server.cli.terminal import (
    calibrating,
    compile_all,
    print_json,
    print_result,
    progress_bar,
    warn,
)
from yehu_server.errors import OutputError, ParameterError, ScoreError, one_line
from yehu_server.rendering import PIPE, build_records
from yehu_server.rendering.build_records import HIDDEN, checked_line, hash_of, up_to_date
from yehu_server.util.source_key import key_of

if TYPE_CHECKING:
    from yehu_server.rendering.cluster import Cluster
    from yehu_server.rendering.folder_tree import Tree
    from yehu_server.rendering.workers import Event

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
    from yehu_server.core.engine.warming import warm_up
    from yehu_server.rendering.folder_tree import tree_of

    [folder] = arguments.midi
    form = _check(arguments)
    tree = tree_of(folder, arguments.output, f".{form}")
    if not tree.entries and not tree.problems:
        raise ScoreError(f"{folder}: has no scores")
    places = {entry.target.parent for entry in tree.entries}
    with cluster_of(arguments, warm_up) as cluster, build_records.alone_in(arguments.output):
        build_records.check_manifest(arguments.output)
        build_records.clear_work(places)
        lines: list[Line] = [{"file": name, "error": why} for name, why in tree.problems]
        tasks, current = split_up_to_date(arguments, tree)
        lines += current
        for line in lines * arguments.json:
            print_json(line)
        try:
            if tasks:
                _render_all(arguments, tasks, len(tree.entries), lines, cluster)
        except KeyboardInterrupt:
            made = sum("error" not in line for line in lines)
            raise KeyboardInterrupt(
                f"{made} of {len(tree.entries)} scores are in {arguments.output}; "
                "the same command goes on"
            ) from None
        finally:
            build_records.clear_work(places)
            build_records.write_manifest(arguments.output, lines)
    failed = sorted((line for line in lines if "error" in line), key=lambda line: line["file"])
    for line in failed:
        warn(f"{line['file']}: {line['error']}")
    if not arguments.json and not arguments.quiet:
        made = len(lines) - len(failed) - len(current)
        counts = f"{made} rendered, {len(current)} up to date, {len(failed)} failed"
        if remarked := sum(bool(line.get("warnings")) for line in lines):
            counts += f"; {build_records.NAME} says what was chosen or moved in {remarked}"
        print_result(f"{arguments.output}: {counts}")
    return 1 if failed else 0


def _render_all(
    arguments: argparse.Namespace,
    tasks: Sequence[Task],
    total: int,
    lines: list[Line],
    cluster: Cluster | None,
) -> None:
    """Render all tasks; append what becomes of each to the lines of the manifest.

    `total`: number of scores in the folder, those that are up to date included.
    """
    from yehu_server.rendering.workers import perform_all

    if cluster is not None:
        ended = _on_cluster(arguments, tasks, cluster)
    else:
        compile_all(arguments)
        with calibrating(arguments, arguments.rate) as progress:  # before all need it
            playing_options_of(arguments).calibration(float(arguments.rate), progress)
        cores = arguments.jobs or os.cpu_count() or 1
        ended = perform_all(perform, tasks, min(cores, len(tasks)))
    before = total - len(tasks)
    with progress_bar(arguments, "rendering", "scores") as progress, contextlib.closing(ended):
        for done, event in enumerate(ended, start=1):
            progress(done, len(tasks))
            lines.append(_line_of(tasks[event.job], event))
            _report(arguments, lines[-1], before + done, total)


def _on_cluster(
    arguments: argparse.Namespace, tasks: Sequence[Task], cluster: Cluster
) -> Generator[Event]:
    """Yield what becomes of tasks on workers, which see all files under the same names."""
    mark = arguments.output.absolute() / HIDDEN / f"seen-{secrets.token_hex(8)}"
    mark.touch()
    try:
        sent = (replace(task, folder=Path.cwd(), mark=mark) for task in tasks)
        yield from cluster.perform_all(perform, sent)
    finally:
        with contextlib.suppress(OSError):
            mark.unlink()


def _line_of(task: Task, event: Event) -> Line:
    """The line of a task that is over, checked: anybody on a cluster may have sent it."""
    name = task.entry.name
    if event.died:
        return {"file": name, "error": f"the process that rendered it was {event.died}"}
    try:
        line = checked_line(event.result, file=name)
        if "error" not in line and not isinstance(line["duration_s"], float):
            raise TypeError  # noqa: TRY301 - as where it is missing
        json.dumps(line, allow_nan=False)
    except (KeyError, TypeError, ValueError, RecursionError):
        return {"file": name, "error": "a worker's answer is not a result"}
    return line


def _report(arguments: argparse.Namespace, line: Line, number: int, total: int) -> None:
    """Report a file: as JSON, or as a line where there is no progress bar."""
    if arguments.json:
        print_json(line)
    elif not arguments.quiet and not sys.stderr.isatty():
        what = "failed" if "error" in line else f"{line['duration_s']:.1f} s"
        print_result(f"{number} of {total}: {one_line(line['file'])}: {what}", flush=True)


def _check(arguments: argparse.Namespace) -> str:
    """Check the options before any file is read; return the format to write."""
    from yehu_server.cli.sound_options import check_stage, sound_options_of

    form = arguments.format or "wav"
    if arguments.output is PIPE:
        raise OutputError("a folder is rendered to a folder, not to standard output")
    if not arguments.output.is_dir() and arguments.output.suffix.lower() in SOUNDS:
        raise OutputError(
            f"{arguments.midi[0]}: is a folder, which is rendered to a folder, "
            f"not to {arguments.output.name}"
        )
    for option in ("stems", "plot"):
        if getattr(arguments, option) is not None:
            raise ParameterError(f"--{option} is for one score, not for a folder")
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
    check_stage(arguments)
    sound_options_of(arguments, form)
    playing_options_of(arguments)
    return str(form)


# What does not change the sound of a file. All other options do, also ones yet to be invented.
NEUTRAL = ("command", "config", "dask", "jobs", "json", "midi", "output", "overwrite", "quiet")
SOUNDING = ("playing", "scores", "rendering", "util")  # folders of code, beside what is compiled


def split_up_to_date(arguments: argparse.Namespace, tree: Tree) -> tuple[list[Task], list[Line]]:
    """What is to be rendered; and the lines of what is up to date."""
    base = base_key(arguments)
    hashing = cache(hash_of)
    tasks, lines = [], []
    for entry in tree.entries:
        key = f"{base}-{hash_of(entry.source)}"
        line = up_to_date(entry.target, key, [entry.target], hashing)
        if line is None:
            tasks.append(Task(arguments, entry, key))
        else:
            lines.append({**line, "file": entry.name})
    return tasks, lines


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
