"""Reading what is small; writing results whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import secrets
import stat
from collections.abc import Iterable, Iterator
from pathlib import Path

from yehu_server.errors import OutputError

MAX_TEXT_BYTES = 64 * 2**20
MAX_SETTINGS_BYTES = 2**20  # of files that are read while the instrument plays
# What a name that comes over the network must look like: no path, nothing hidden.
PLAIN_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 ._-]{0,99}")


def read_text(path: Path, most_bytes: int = MAX_TEXT_BYTES) -> str:
    """Read a text file of reasonable size. Errors: OSError, UnicodeDecodeError."""
    with path.open("rb") as file:
        data = file.read(most_bytes + 1)  # bounded, as some devices never end
    if len(data) > most_bytes:
        raise OSError(errno.EFBIG, os.strerror(errno.EFBIG))
    return data.decode("utf-8")


def check_target(target: Path, inputs: Iterable[Path] = ()) -> None:
    """Refuse a target that could not be written, or would overwrite one of the inputs.

    Errors: OutputError where the folder is missing or not writable, or the target is not a
    regular file.
    """
    folder = target.parent
    try:
        if not folder.exists():
            raise OutputError(f"{target}: the folder {folder} does not exist")
        if not folder.is_dir():
            raise OutputError(f"{target}: {folder} is not a folder")
        if target.is_dir():
            raise OutputError(f"{target}: is a folder; name a file")
        if target.exists() and not stat.S_ISREG(target.stat().st_mode):
            raise OutputError(f"{target}: is not a regular file")
        if any(path.exists() and target.exists() and path.samefile(target) for path in inputs):
            raise OutputError(f"{target}: would overwrite what is read")
    except OSError as error:
        raise OutputError(f"{target}: cannot write: {error.strerror}") from error
    if not os.access(folder, os.W_OK):
        raise OutputError(f"{target}: the folder {folder} is not writable")


@contextlib.contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Yield a path beside `target` to write to; move it there when the block succeeds.

    Whatever ends the block early (an error, an interrupt) removes the partial file and
    leaves an older `target` as it was.
    Errors: OutputError as `check_target`, or where writing fails (a full disk).
    """
    check_target(target)
    partial = target.resolve().parent / f".yehu-server-{secrets.token_hex(8)}.part"
    try:
        partial.touch(exist_ok=False)
        yield partial
        partial.replace(target.resolve())
    except OSError as error:
        raise OutputError(f"{target}: cannot write: {error.strerror or error}") from error
    finally:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)


def write_text(target: Path, text: str) -> None:
    """Write a text file: after a crash or a power cut it is the new one or the old one, whole.

    Errors: OutputError, as of `replacing`.
    """
    with replacing(target) as partial, partial.open("w", encoding="utf-8", newline="") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())


def shipped_folder(name: str) -> Path:
    """Where files that come along are: in the package, or beside it in a checkout."""
    package = Path(__file__).parent
    inside = package / name
    return inside if inside.is_dir() else package.parent / name
