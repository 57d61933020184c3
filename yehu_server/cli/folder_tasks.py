"""One score of a folder to render, in whatever process, and what became of it."""

from __future__ import annotations

import argparse
import contextlib
import errno
import io
import logging
import math
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import replaceable
from yehu_server.errors import OutputError, ScoreError, YehuError
from yehu_server.rendering import build_records
from yehu_server.rendering.build_records import checked_line, hash_of, keep, make_folder_for
from yehu_server.util.files import (
    check_distinct,
    check_free,
    check_target,
    make_folder,
    shipped_folder,
    why,
)

if TYPE_CHECKING:
    from yehu_server.rendering.folder_tree import Entry
    from yehu_server.rendering.workers import ProgressCallback

log = logging.getLogger(__name__)

Line = dict[str, Any]

FULL = (errno.ENOSPC, errno.EDQUOT)
BLOCK = 1 << 16  # frames of a file that are read again at a time


@dataclass(frozen=True)
class Task:
    """A score to render, for another process."""

    arguments: argparse.Namespace  # those of the command
    entry: Entry
    picture: Path | None  # where the picture of it goes
    key: str  # of all that the result depends on, beside files of settings
    seconds: float = 0.0  # how long it lasts, as far as that is known from an earlier run; else 0
    # For a worker of a cluster: a file in the output, which is found where that is seen.
    mark: Path = Path()
    # For such a worker that does not see the folders; None where it cannot be read, and the worker
    # tells why.
    score: bytes | None = None

    @property
    def results(self) -> tuple[Path, ...]:
        """The files to make."""
        return (self.entry.target, *(() if self.picture is None else (self.picture,)))


@dataclass(frozen=True)
class Done:
    """What became of a task: its line of the manifest, and whether the disk was full."""

    line: Line
    is_full: bool = False
    read: tuple[Path, ...] = ()  # the files of settings that the sound was made from
    made: tuple[bytes, ...] = ()  # the results, where they have to travel

    def as_plain(self) -> dict[str, Any]:
        """It as what a cluster's worker may answer."""
        return {**vars(self), "read": [str(path) for path in self.read]}

    @classmethod
    def of_plain(cls, task: Task, told: Any) -> Done:
        """What a worker answered, or anybody on the cluster; raises OutputError if no result."""
        try:
            line = checked_line(told["line"], file=task.entry.name)
            read = tuple(Path(path) for path in told["read"])
            made = tuple(told["made"])
            is_whole = "error" in line or isinstance(line["duration_s"], float)
            if not is_whole or any(type(data) is not bytes for data in made):
                raise TypeError  # noqa: TRY301 - as where entries are missing
            if len(made) not in (0, len(task.results)):
                raise ValueError  # noqa: TRY301
        except (KeyError, TypeError, ValueError, RecursionError) as error:
            raise OutputError("a worker answered with what is no result") from error
        return cls(line, told.get("is_full") is True, read, made)


def perform(task: Task, report_progress: ProgressCallback) -> Done:
    """Render a score to its place; return what became of it."""
    entry = task.entry
    try:
        return _made(task, report_progress)
    except YehuError as error:
        is_full = any(isinstance(each, OSError) and each.errno in FULL for each in _causes(error))
        line = {"file": entry.name, "error": _without_path(str(error), entry)}
        if isinstance(error, ScoreError):
            _keep_failure(task, line)
        return Done(line, is_full=is_full)
    except MemoryError:
        return Done({"file": entry.name, "error": "not enough memory"})
    except Exception as error:  # the others have to be rendered
        log.debug("%s", entry.name, exc_info=True)
        why = f"cannot be rendered ({type(error).__name__}: {error})"
        return Done({"file": entry.name, "error": why})


def _keep_failure(task: Task, line: Line) -> None:
    """Keep that a score cannot be played: another try would end alike, unless it is another."""
    found = hash_of(task.entry.source)
    if not found or not task.key.endswith(found):
        return
    with contextlib.suppress(OutputError):
        make_folder_for(task.entry.target)
        keep(task.entry.target, task.key, (), (), line)


def _made(task: Task, report_progress: ProgressCallback) -> Done:
    from yehu_server.cli.render_one import rendered
    from yehu_server.plot.png import check_picture

    entry, options = task.entry, task.arguments
    may_replace = replaceable(options)
    build_records.make_folder_for(entry.target)
    check_target(entry.target)
    check_free(entry.target, may_replace)
    check_distinct({"-o": entry.target}, [entry.source])
    work = build_records.temporary_of(entry.target)
    if task.picture is not None:
        make_folder(task.picture.parent)
        check_picture(task.picture, "--plot", overwrite=options.overwrite)
    own = argparse.Namespace(**vars(options))
    own.midi, own.output, own.plot = [entry.source], work, task.picture
    own.overwrite, own.quiet, own.json, own.jobs = True, True, False, 1
    own.format = options.format or "wav"
    told = io.StringIO()
    try:
        with contextlib.redirect_stderr(told):
            done = rendered(own, report_progress)
        summary = done.summary
        loudness = _loudness(work)
        line = {
            "file": entry.name,
            "output": os.path.relpath(entry.target, options.output),
            "hash": build_records.hash_of(work),
            "duration_s": summary.duration_s,
            "notes": summary.notes_played,
            "out_of_range": summary.notes_out_of_range,
            "peak": summary.peak,
            "loudness_lufs": loudness if math.isfinite(loudness) else None,
            "warnings": [
                each.removeprefix("yehu-server: ") for each in told.getvalue().splitlines()
            ],
        }
        check_free(entry.target, may_replace)
        work.replace(entry.target)
        read = [path for path in done.read if path != entry.source]
        read += _programs(options)
        build_records.keep(entry.target, task.key, read, task.results, line)
    except YehuError as error:
        for shown in (str(work), ascii(str(work))):
            if str(error).startswith(shown):
                error.args = (str(error).replace(shown, str(entry.target), 1),)
        raise
    except OSError as error:
        raise OutputError(f"{entry.target}: cannot write: {why(error)}") from error
    finally:
        with contextlib.suppress(OSError):
            work.unlink(missing_ok=True)
    return Done(line, read=tuple(read))


def _programs(arguments: argparse.Namespace) -> list[Path]:
    """The presets that programs may select."""
    if not arguments.programs:
        return []
    folders = [shipped_folder("presets"), *filter(None, (arguments.presets,))]
    return sorted(path for each in folders for path in each.glob("*.toml"))


def _loudness(path: Path) -> float:
    import soundfile

    from yehu_server.rendering.loudness import loudness_lufs

    try:
        with path.open("rb") as data, soundfile.SoundFile(data) as file:  # of any name
            return loudness_lufs(file.blocks(BLOCK), file.samplerate)
    except soundfile.LibsndfileError as error:
        raise OutputError(f"{path}: cannot be read again") from error


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = error.__cause__


def _without_path(why: str, entry: Entry) -> str:
    """An error without the name of the file, which is told beside it."""
    for path in map(str, (entry.source, entry.target)):
        for shown in (path, ascii(path)):
            why = why.removeprefix(f"{shown}: ")
    return why
