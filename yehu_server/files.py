"""Writing results: whole or not at all."""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from yehu_server.errors import OutputError


@contextlib.contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Yield a path beside `target` to write to; move it there when the block succeeds.

    Whatever ends the block early (an error, an interrupt) removes the partial file and
    leaves an older `target` as it was.
    Errors: OutputError where the folder is missing or not writable, the target is not a
    regular file, or writing fails (a full disk).
    """
    folder = target.parent
    if not folder.exists():
        raise OutputError(f"{target}: the folder {folder} does not exist")
    if not folder.is_dir():
        raise OutputError(f"{target}: {folder} is not a folder")
    if target.is_dir():
        raise OutputError(f"{target}: is a folder; name a file")
    if target.exists() and not stat.S_ISREG(target.stat().st_mode):
        raise OutputError(f"{target}: is not a regular file")
    partial = folder / f".{target.name}.{os.getpid()}.part"
    try:
        partial.touch()
        yield partial
        partial.replace(target)
    except OSError as error:
        raise OutputError(f"{target}: cannot write: {error.strerror or error}") from error
    finally:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)
