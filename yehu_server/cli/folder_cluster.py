"""Render scores of a folder on machines that may not see the folder: then they travel.

A worker that sees input and output, as on a shared disk, reads and writes there. One that does not
is sent the score, and sends the sound back.
"""

from __future__ import annotations

import argparse
import contextlib
import secrets
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from yehu_server.cli.folder_tasks import Done, Task, perform, replaceable
from yehu_server.errors import OutputError, ParameterError

if TYPE_CHECKING:
    from yehu_server.rendering.cluster import Cluster
    from yehu_server.rendering.workers import ProgressCallback

MARK = "seen-{}"  # in the hidden folder: who finds it sees the output


@dataclass(frozen=True)
class ClusterTask:
    """A task for a worker: with the score, or with marks that tell whether the worker sees it.

    Attributes
    ----------
    marks : tuple of Path
        Files that are there where the folders of input and output are seen.
    score : bytes, optional
        What is rendered far from the folders.
    """

    task: Task
    marks: tuple[Path, ...] = ()
    score: bytes | None = None


@dataclass(frozen=True)
class ClusterResult:
    """The result of a task: None if the worker cannot see the folders, else as in a local process.

    Attributes
    ----------
    made : tuple of bytes
        The results, where they have to travel.
    """

    done: Done | None
    made: tuple[bytes, ...] = ()


def perform_on_worker(far: ClusterTask, tell: ProgressCallback) -> ClusterResult:
    """Render a score on a worker."""
    if far.score is None:
        is_seen = all(mark.is_file() for mark in far.marks)
        return ClusterResult(perform(far.task, tell) if is_seen else None)
    task = far.task
    with tempfile.TemporaryDirectory(prefix="yehu-server-") as name:
        folder = Path(name)
        source = folder / "in" / task.entry.source.name
        output = folder / "out"
        source.parent.mkdir()
        source.write_bytes(far.score)
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
    return ClusterResult(done, made)


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
        text = vars(arguments)[name]
        if text is not None and _is_path(text.removeprefix("mine/")):
            values[name] = str(Path(text).absolute())
    return argparse.Namespace(**values)


def _is_path(name: str) -> bool:
    """Whether what names a mapping or a preset is a path, and not a name."""
    return Path(name).name != name or bool(Path(name).suffix)


class ClusterTransfer:
    """Sends a folder's tasks to a cluster and stores the results.

    Parameters
    ----------
    arguments : Namespace
        With absolute paths.
    """

    def __init__(self, arguments: argparse.Namespace, cluster: Cluster) -> None:
        self._arguments, self._cluster = arguments, cluster
        self._marks: tuple[Path, ...] = ()

    @contextlib.contextmanager
    def marked(self) -> Iterator[None]:
        """Mark the output, so that workers know whether they see it, for the time of a block."""
        from yehu_server.rendering.build_records import HIDDEN

        mark = self._arguments.output / HIDDEN / MARK.format(secrets.token_hex(8))
        mark.touch()
        try:
            self._check_settings()
            seen = self._cluster.ask(are_there, (mark, *self._arguments.midi))
            if all(seen.values()):
                self._marks = (mark,)
            yield
        finally:
            with contextlib.suppress(OSError):
                mark.unlink()

    def _check_settings(self) -> None:
        """Refuse files of settings that the workers do not have: only scores travel."""
        from yehu_server.rendering.build_records import hash_of

        files = {path: hash_of(path) for path in _settings(self._arguments)}
        for worker, found in sorted(self._cluster.ask(hashes_of, tuple(files)).items()):
            for path, known in files.items():
                if found[path] != known:
                    raise ParameterError(
                        f"{path}: the worker {worker} does not have this file; "
                        "keep it where all workers see it"
                    )

    def tasks(self, tasks: Sequence[Task], *, travel: bool = False) -> Iterator[ClusterTask]:
        """Tasks for workers; with the scores where they do not see the folders."""
        is_sent = travel or not self._marks
        for task in tasks:
            entry = task.entry
            entry = replace(entry, source=entry.source.absolute(), target=entry.target.absolute())
            picture = None if task.picture is None else task.picture.absolute()
            own = replace(task, arguments=self._arguments, entry=entry, picture=picture)
            yield ClusterTask(own, self._marks, self._score(task) if is_sent else None)

    def _score(self, task: Task) -> bytes | None:
        try:
            return task.entry.source.read_bytes()
        except OSError:  # the worker tells why, as one here would
            return None

    def received(self, task: Task, far: ClusterResult) -> Done:
        """Put what has travelled in its place."""
        done = far.done or Done({})
        if not far.made:
            return done
        try:
            self._put(task, done, far.made)
        except OutputError as error:
            return Done({"file": task.entry.name, "error": str(error)})
        return done

    def _put(self, task: Task, done: Done, made: Sequence[bytes]) -> None:
        from yehu_server.rendering import build_records
        from yehu_server.util.files import anything, make_folder, replacing

        build_records.make_folder_for(task.entry.target)
        may_replace = replaceable(task.arguments)
        for path, data in zip(task.results, made, strict=True):
            make_folder(path.parent)
            is_sound = path == task.entry.target
            with replacing(path, may_replace if is_sound else anything) as partial:
                partial.write_bytes(data)
        build_records.keep(task.entry.target, task.key, done.read, task.results, done.line)


def _settings(arguments: argparse.Namespace) -> list[Path]:
    """Files of settings that options name, beside those that are shipped."""
    from yehu_server.cli.style_options import style_of
    from yehu_server.util.files import shipped_folder

    named = [arguments.instrument, arguments.ensemble, *style_of(arguments).files]
    files = [path.absolute() for path in named if isinstance(path, Path)]
    shipped = shipped_folder("mappings").parent
    return [path for path in files if not path.is_relative_to(shipped)]


# ---------------------------------------------------------------- asked of workers


def are_there(paths: Sequence[Path]) -> bool:
    """Whether all of some files and folders are there."""
    return all(path.exists() for path in paths)


def hashes_of(paths: Sequence[Path]) -> dict[Path, str]:
    """The hashes of files."""
    from yehu_server.rendering.build_records import hash_of

    return {path: hash_of(path) for path in paths}
