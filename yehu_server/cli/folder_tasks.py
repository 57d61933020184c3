"""One score of a folder to render, in whatever process, and what became of it."""

from __future__ import annotations

import argparse
import contextlib
import io
import logging
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import replaceable
from yehu_server.errors import OutputError, YehuError
from yehu_server.rendering import build_records
from yehu_server.util import files

if TYPE_CHECKING:
    from yehu_server.rendering.folder_tree import Entry

log = logging.getLogger(__name__)

Line = dict[str, Any]


@dataclass(frozen=True)
class Task:
    """A score to render, for another process."""

    arguments: argparse.Namespace  # those of the command
    entry: Entry
    key: str  # of all that the result depends on, beside files of settings
    folder: Path = Path()  # where paths that are relative begin
    # For a worker of a cluster: a file in the output, which is found where that is seen.
    mark: Path | None = None


def perform(task: Task) -> Line:
    """Render a score to its place; return its line of the manifest."""
    entry = task.entry
    work = build_records.temporary_of(entry.target)
    try:
        return _made(task, work)
    except YehuError as error:
        reason = str(error)
        for path in map(str, (entry.source, entry.target, work)):  # they are named beside it
            for shown in (path, ascii(path)):
                reason = reason.removeprefix(f"{shown}: ")
    except OSError as error:
        reason = f"cannot write: {files.error_reason(error)}"
    except MemoryError:
        reason = "not enough memory"
    except Exception as error:  # the others have to be rendered
        log.debug("%s", entry.name, exc_info=True)
        reason = f"cannot be rendered ({type(error).__name__}: {error})"
    finally:
        with contextlib.suppress(OSError):
            work.unlink(missing_ok=True)
    return {"file": entry.name, "error": reason}


def _made(task: Task, work: Path) -> Line:
    from yehu_server.cli.render_one import rendered

    entry, options = task.entry, task.arguments
    if task.mark is not None:
        if not task.mark.is_file():
            raise OutputError("a worker does not see the output; keep it where all see it")
        os.chdir(task.folder)
    may_replace = replaceable(options)
    build_records.make_folder_for(entry.target)
    files.check_target(entry.target)
    files.check_free(entry.target, may_replace)
    files.check_distinct({"-o": entry.target}, [entry.source])
    own = argparse.Namespace(**vars(options))
    own.midi, own.output = [entry.source], work
    own.overwrite, own.quiet, own.json, own.jobs = True, False, False, 1
    own.format = options.format or "wav"
    printed = io.StringIO()
    with contextlib.redirect_stderr(printed):
        done = rendered(own)
    summary = done.summary
    line = {
        "file": entry.name,
        "output": os.path.relpath(entry.target, options.output),
        "hash": build_records.hash_of(work),
        "duration_s": summary.duration_s,
        "notes": summary.notes_played,
        "out_of_range": summary.notes_out_of_range,
        "peak": summary.peak,
        "loudness_lufs": summary.loudness_lufs,
        "warnings": [
            each.removeprefix("yehu-server: ") for each in printed.getvalue().splitlines()
        ],
    }
    files.check_free(entry.target, may_replace)
    work.replace(entry.target)
    read = [path for path in done.read if path != entry.source]
    if options.programs:  # the presets that they may select
        folders = [files.shipped_folder("presets"), *filter(None, (options.presets,))]
        read += sorted(path for each in folders for path in each.glob("*.toml"))
    build_records.keep(entry.target, task.key, read, [entry.target], line)
    return line
