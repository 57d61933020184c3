"""Render scores of a folder on machines that may not see the folder: then they travel.

A worker that sees input and output, as on a shared disk, reads and writes there. One that does not
renders the score that it was sent, and sends the sound back.
"""

from __future__ import annotations

import argparse
import contextlib
import secrets
import tempfile
from collections.abc import Generator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import replaceable
from yehu_server.cli.folder_tasks import Done, Task, perform
from yehu_server.errors import OutputError, ParameterError
from yehu_server.rendering import build_records
from yehu_server.rendering.build_records import HIDDEN, hash_of
from yehu_server.util.files import anything, make_folder, replacing, shipped_folder

if TYPE_CHECKING:
    from yehu_server.rendering.cluster import Cluster
    from yehu_server.rendering.workers import Event, ProgressCallback


def perform_on_worker(task: Task, tell: ProgressCallback) -> dict[str, Any]:
    """Render a score on a worker, in its place or to a result that travels: a `Done` as plain."""
    if task.score is None or (task.mark.is_file() and task.entry.source.is_file()):
        return perform(task, tell).as_plain()
    with tempfile.TemporaryDirectory(prefix="yehu-server-") as name:
        folder = Path(name)
        source = folder / "in" / task.entry.source.name
        output = folder / "out"
        source.parent.mkdir()
        source.write_bytes(task.score)
        asked = argparse.Namespace(**vars(task.arguments))
        target = output / task.entry.target.relative_to(asked.output)
        asked.output = output
        picture = None if task.picture is None else folder / "picture.png"
        here = replace(
            task,
            arguments=asked,
            entry=replace(task.entry, source=source, target=target),
            picture=picture,
        )
        done = perform(here, tell)
        made = () if "error" in done.line else tuple(path.read_bytes() for path in here.results)
    return replace(done, made=made).as_plain()


def absolute(arguments: argparse.Namespace) -> argparse.Namespace:
    """Options whose paths hold in any folder; names of what is shipped stay names."""
    values = {
        name: value.absolute() if isinstance(value, Path) and value.is_file() else value
        for name, value in vars(arguments).items()
    }
    values["midi"] = [Path(path).absolute() for path in arguments.midi]
    for name in ("output", "plot", "presets"):
        values[name] = None if values[name] is None else values[name].absolute()
    for name in ("mapping", "preset"):
        text = vars(arguments)[name] or ""
        name_or_path = text.removeprefix("mine/")
        if Path(name_or_path).name != name_or_path or Path(name_or_path).suffix:  # a path
            values[name] = str(Path(text).absolute())
    return argparse.Namespace(**values)


def render_on_cluster(tasks: Sequence[Task], cluster: Cluster) -> Generator[Event]:
    """Yield what becomes of tasks on a cluster; the result of each is its `Done`."""
    arguments = absolute(tasks[0].arguments)
    mark = arguments.output / HIDDEN / f"seen-{secrets.token_hex(8)}"
    mark.touch()
    try:
        _check_settings(arguments, cluster)
        sent = (_sent(task, arguments, mark) for task in tasks)
        with contextlib.closing(cluster.perform_all(perform_on_worker, sent)) as events:
            for event in events:
                done = None
                if event.is_end and not event.died:
                    done = _received(tasks[event.job], event.result)
                yield replace(event, result=done)
    finally:
        with contextlib.suppress(OSError):
            mark.unlink()


def _check_settings(arguments: argparse.Namespace, cluster: Cluster) -> None:
    """Refuse files of settings that the workers do not have: only scores travel."""
    files = hashes_of([str(path) for path in _settings(arguments)])
    for worker, found in cluster.ask(hashes_of, tuple(files)).items():
        for path, known in files.items():
            if not isinstance(found, dict) or found.get(str(path)) != known:
                raise ParameterError(
                    f"{path}: the worker {worker} does not have this file; "
                    "keep it where all workers see it"
                )


def _settings(arguments: argparse.Namespace) -> list[Path]:
    """Files of settings that options name, beside those that are shipped."""
    from yehu_server.cli.playing_options import playing_options_of

    named = [arguments.instrument, arguments.ensemble, *playing_options_of(arguments).files]
    files = [path.absolute() for path in named if isinstance(path, Path)]
    shipped = shipped_folder("mappings").parent
    return [path for path in files if not path.is_relative_to(shipped)]


def hashes_of(paths: Sequence[str]) -> dict[str, str]:
    """The hashes of files; workers are asked for theirs."""
    return {path: hash_of(Path(path)) for path in paths}


def _sent(task: Task, arguments: argparse.Namespace, mark: Path) -> Task:
    try:
        score = task.entry.source.read_bytes()
    except OSError:
        score = None
    entry = task.entry
    entry = replace(entry, source=entry.source.absolute(), target=entry.target.absolute())
    picture = None if task.picture is None else task.picture.absolute()
    return replace(task, arguments=arguments, entry=entry, picture=picture, mark=mark, score=score)


def _received(task: Task, told: Any) -> Done:
    """Check what a worker told, and put what has travelled in its place."""
    try:
        done = Done.of_plain(task, told)
        if not done.made:
            return done
        _put(task, done)
    except OutputError as error:
        return Done({"file": task.entry.name, "error": str(error)})
    return replace(done, made=())


def _put(task: Task, done: Done) -> None:
    build_records.make_folder_for(task.entry.target)
    may_replace = replaceable(task.arguments)
    for path, data in zip(task.results, done.made, strict=True):
        make_folder(path.parent)
        is_sound = path == task.entry.target
        with replacing(path, may_replace if is_sound else anything) as partial:
            partial.write_bytes(data)
    build_records.keep(task.entry.target, task.key, done.read, task.results, done.line)
