"""Reading what is small; writing results whole or not at all, and never over what is kept."""

from __future__ import annotations

import contextlib
import errno
import io
import itertools
import os
import re
import secrets
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import BinaryIO

from yehu_server.errors import OutputError

MAX_TEXT_BYTES = 64 * 2**20
MAX_LINE_BYTES = 64 * 1024
MAX_SETTINGS_BYTES = 2**20  # of files that are read while the instrument plays
# What a name that comes over the network must look like: no path, nothing hidden.
PLAIN_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 ._-]{0,99}")
MOST_SHOWN = 40  # characters of what is none


def _open_at_once(path: str, flags: int) -> int:
    """Open without waiting, as a pipe would for who writes to it."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _open_regular(path: Path, most_bytes: int) -> BinaryIO:
    """Open a regular file of reasonable size: devices and pipes may never end. Errors: OSError."""
    file = open(path, "rb", opener=_open_at_once)  # noqa: SIM115 - for who asks to close
    status = os.fstat(file.fileno())
    if stat.S_ISREG(status.st_mode) and status.st_size <= most_bytes:
        return file
    file.close()
    if stat.S_ISREG(status.st_mode):
        raise _too_large(most_bytes)
    raise OSError(errno.EINVAL, "Not a regular file")


def _too_large(most_bytes: int) -> OSError:
    return OSError(errno.EFBIG, f"File too large, above {most_bytes >> 10} KiB")


def read_bytes(path: Path, most_bytes: int = MAX_TEXT_BYTES) -> bytes:
    """Read a regular file of reasonable size. Errors: OSError."""
    with _open_regular(path, most_bytes) as file:
        data = file.read(most_bytes + 1)
    if len(data) > most_bytes:  # it has grown, or its file system tells no sizes
        raise _too_large(most_bytes)
    return data


def read_lines(path: Path, most_bytes: int) -> Iterator[str]:
    """Read a text file line by line, each with its end. Errors: OSError, UnicodeDecodeError."""
    with _open_regular(path, most_bytes) as file:
        while line := file.readline(MAX_LINE_BYTES + 1):
            if len(line) > MAX_LINE_BYTES:
                raise OSError(errno.EFBIG, f"A line is longer than {MAX_LINE_BYTES // 1024} KiB")
            yield line.decode("utf-8")


def read_text(path: Path, most_bytes: int = MAX_TEXT_BYTES) -> str:
    """Read a text file of reasonable size. Errors: OSError, UnicodeDecodeError."""
    return read_bytes(path, most_bytes).decode("utf-8")


def why(error: OSError) -> str:
    """Why the system refused, in words."""
    return error.strerror or str(error)


def inside(folder: Path, name: str, ending: str = "") -> Path:
    """The file of a name that came over the network: one of this folder, wherever its links lead.

    Errors: OutputError for what is no plain name, or a symbolic link that leads out of the folder.
    """
    if not PLAIN_NAME.fullmatch(name):
        shown = name if len(name) <= MOST_SHOWN else f"{name[:MOST_SHOWN]}..."
        raise OutputError(f"{shown!r} is not a plain name of letters, digits, . _ - and spaces")
    path = folder / f"{name}{ending}"
    # Of a link to nowhere, too: writing through it would make the file it names.
    if os.path.islink(path) and not _is_within(path, folder):  # noqa: PTH114 - Path's raises
        raise OutputError(f"{path.name} is a link that leads out of {folder}")
    return path


def _is_within(path: Path, folder: Path) -> bool:
    return Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))


def check_target(target: Path) -> None:
    """Refuse a target that could not be written.

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
    except OSError as error:
        raise OutputError(f"{target}: cannot write: {error.strerror}") from error
    if not os.access(folder, os.W_OK):
        raise OutputError(f"{target}: the folder {folder} is not writable")


def check_apart(outputs: Mapping[str, Path], inputs: Iterable[Path] = ()) -> None:
    """Refuse outputs that would be one file, or be one that is read; also by links to it.

    Parameters
    ----------
    outputs : dict
        The files to be written, by the options that name them.
    inputs : iterable of Path

    Errors: OutputError.
    """
    read = list(inputs)
    for (name, target), (other, another) in itertools.combinations(outputs.items(), 2):
        if is_same(target, another):
            raise OutputError(f"{target}: {name} and {other} would write to one file")
    for name, target in outputs.items():
        if any(is_same(target, path) for path in read):
            raise OutputError(f"{target}: {name} would overwrite what is read")


def is_same(one: Path, other: Path) -> bool:
    """Whether two paths are one file, or would be."""
    try:
        return one.samefile(other)
    except OSError:  # one of them is not there yet
        return os.path.realpath(one) == os.path.realpath(other)


def anything(_target: Path) -> bool:
    """Let any file be replaced; see `replacing`."""
    return True


def nothing(_target: Path) -> bool:
    """Let no file be replaced; see `replacing`."""
    return False


def check_free(target: Path, may_replace: Callable[[Path], bool] = nothing) -> None:
    """Refuse a target that is there, unless it may be replaced. Errors: OutputError."""
    if os.path.lexists(target) and not may_replace(target):
        raise OutputError(f"{target}: exists; --overwrite replaces it")


def create(target: Path, *, overwrite: bool = False, room_bytes: int = 0) -> io.FileIO:
    """Open a new file, to be written as things happen.

    Parameters
    ----------
    overwrite : bool
        Whether the new file may take the place of an older one, at once. Other links to that
        keep what they have.
    room_bytes : int
        What must fit on the disk.

    Errors: OutputError, as of `check_target`, where there is an older one, or on a full disk;
    an older one is as it was then.
    """
    check_target(target)
    path = _beside(target.resolve()) if overwrite else target
    try:
        file = io.FileIO(path, "x")
        try:
            write_all(file, bytes(room_bytes))
            file.seek(0)
            file.truncate()
            if overwrite:
                path.replace(target.resolve())
        except OSError:
            discard(file, path)
            file.close()
            raise
    except FileExistsError:
        raise OutputError(f"{target}: exists") from None
    except OSError as error:
        raise OutputError(f"{target}: cannot write: {why(error)}") from error
    return file


def discard(file: io.FileIO, path: Path) -> None:
    """Remove an open file, unless another has taken its place."""
    with contextlib.suppress(OSError):
        if os.path.samestat(os.fstat(file.fileno()), path.stat()):
            path.unlink()


def write_all(file: io.FileIO, data: bytes) -> None:
    """Write to an unbuffered file, all of it. Errors: OSError, where some of it may be written."""
    rest = memoryview(data)
    while rest:
        rest = rest[file.write(rest) :]


@contextlib.contextmanager
def replacing(target: Path, may_replace: Callable[[Path], bool] = anything) -> Iterator[Path]:
    """Yield a path beside `target` to write to; move it there when the block succeeds.

    Whatever ends the block early (an error, an interrupt) removes the partial file and
    leaves an older `target` as it was.

    Parameters
    ----------
    may_replace : callable
        Told an older target, at the beginning and at the end; whether it may be replaced.

    Errors: OutputError as `check_target` and `check_free`, or where writing fails (a full disk).
    """
    check_target(target)
    check_free(target, may_replace)
    partial = _beside(target.resolve())
    try:
        partial.touch(exist_ok=False)
        yield partial
        _move(partial, target, may_replace)
    except OSError as error:
        raise OutputError(f"{target}: cannot write: {why(error)}") from error
    finally:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)


def _move(partial: Path, target: Path, may_replace: Callable[[Path], bool]) -> None:
    """Move a file to its place; what another has put there meanwhile cannot come between."""
    place = target.resolve()
    try:
        place.touch(exist_ok=False)
    except FileExistsError:
        check_free(target, may_replace)
        partial.replace(place)
        return
    try:
        partial.replace(place)
    except OSError:
        place.unlink(missing_ok=True)
        raise


def _beside(target: Path) -> Path:
    """A hidden name in the same folder, on the same disk."""
    return target.parent / f".yehu-server-{secrets.token_hex(8)}.part"


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
