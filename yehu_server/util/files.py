"""Read files of bounded size; write results atomically, and replace only what may be replaced."""

import contextlib
import errno
import io
import itertools
import os
import re
import secrets
import stat
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import BinaryIO

from yehu_server.errors import OutputError
from yehu_server.system.files import is_own, open_at_once
from yehu_server.util import PACKAGE

MAX_TEXT_BYTES = 64 * 2**20
PIECE_BYTES = 2**20
MAX_LINE_BYTES = 1 << 20  # the first line of a capture has the bowing tables of all players
MAX_SETTINGS_BYTES = 2**20  # for files that are read while the instrument plays
# Names that come over the network, of letters of any script: no path, no hidden file.
_PLAIN_NAME = re.compile(r"[^\W_][\w .-]{0,99}")
MAX_NAME_BYTES = 200  # of the 255 that file systems have, with room for an ending
MAX_SHOWN = 40  # characters of other names in errors
LEFTOVER = re.compile(r"\.yehu-server-[0-9a-f]{16}\.part")
LEFTOVER_AFTER_S = 24 * 3600.0  # without a write; a process may be stopped for hours


def open_regular(path: Path, most_bytes: int | None = None) -> BinaryIO:
    """Open a regular file to read, whose size may be bounded; at once, whatever it is.

    Raises OSError also where it is a device or a pipe, which may never begin or end, or is too
    large.
    """
    try:
        file = open(path, "rb", opener=open_at_once)  # noqa: SIM115 - the caller closes it
    except ValueError:  # a NUL in the name
        raise OSError(errno.ENOENT, "No such file") from None
    status = os.fstat(file.fileno())
    if not stat.S_ISREG(status.st_mode):
        file.close()
        raise OSError(errno.EINVAL, "Not a regular file")
    if most_bytes is not None and status.st_size > most_bytes:
        file.close()
        raise _too_large(most_bytes)
    return file


def _too_large(most_bytes: int) -> OSError:
    size = f"{most_bytes >> 10} KiB" if most_bytes % 2**20 else f"{most_bytes >> 20} MiB"
    return OSError(errno.EFBIG, f"Larger than {size}")


def read_bytes(path: Path, most_bytes: int = MAX_TEXT_BYTES) -> bytes:
    """Read a regular file; raises OSError also for another, or one above `most_bytes`."""
    pieces, left = [], most_bytes + 1
    with open_regular(path, most_bytes) as file:
        # In pieces: a read sets aside all the memory that it may need.
        while piece := file.read(min(left, PIECE_BYTES)):
            pieces.append(piece)
            left -= len(piece)
    if left <= 0:  # it has grown, or its file system reports no sizes
        raise _too_large(most_bytes)
    return b"".join(pieces)


def read_lines(path: Path, most_bytes: int) -> Iterator[str]:
    """Read a text file line by line, each with its line end.

    Raises OSError as `read_bytes`, or where a line is too long; UnicodeDecodeError where it is not
    UTF-8.
    """
    with open_regular(path, most_bytes) as file:
        while line := file.readline(MAX_LINE_BYTES + 1):
            if len(line) > MAX_LINE_BYTES:
                raise OSError(errno.EFBIG, f"A line is longer than {MAX_LINE_BYTES // 1024} KiB")
            yield line.decode("utf-8")


def read_text(path: Path, most_bytes: int = MAX_TEXT_BYTES) -> str:
    """Read a text file; raises OSError as `read_bytes`, UnicodeDecodeError if it is not UTF-8."""
    return read_bytes(path, most_bytes).decode("utf-8")


_REASONS = {  # not in the words of systems, which differ
    errno.ENOENT: "no such file",
    errno.EISDIR: "is a folder",
    errno.EADDRINUSE: "address already in use",
}


def error_reason(error: BaseException) -> str:
    """The reason of an error, for a message: its own, or the system's where it has one."""
    if isinstance(error, OSError) and error.strerror:
        # `socket.create_server` adds an address, which our message has already.
        reason = error.strerror.partition(" (while attempting to bind")[0]
        return _REASONS.get(error.errno or 0, f"{reason[:1].lower()}{reason[1:]}")
    return str(error) or type(error).__name__


def make_folder(folder: Path) -> None:
    """Make a folder, and those it is in; raises OutputError where it cannot be made."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be made: {error_reason(error)}") from error


def is_plain_name(name: str) -> bool:
    """Whether a name is safe as that of a file, with any ending."""
    return _PLAIN_NAME.fullmatch(name) is not None and len(name.encode()) <= MAX_NAME_BYTES


def path_inside(folder: Path, name: str, ending: str = "") -> Path:
    """A plain name's path in a folder; OutputError for other names, and links that lead out."""
    if not is_plain_name(name):
        shown = name if len(name) <= MAX_SHOWN else f"{name[:MAX_SHOWN]}..."
        raise OutputError(f"{shown!r} is not a plain name of letters, digits, . _ - and spaces")
    path = folder / f"{name}{ending}"
    # A dangling link too: writing through it would create the file it names.
    is_inside = Path(os.path.realpath(path)).is_relative_to(os.path.realpath(folder))
    if os.path.islink(path) and not is_inside:  # noqa: PTH114 - Path's raises
        raise OutputError(f"{path.name} is a link that leads out of {folder}")
    return path


def check_target(target: Path) -> None:
    """Check that a target can be written.

    Raises OutputError where the folder is missing or not writable, or the target is not a regular
    file.
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
        raise OutputError(f"{target}: cannot write: {error_reason(error)}") from error
    if not os.access(folder, os.W_OK):
        raise OutputError(f"{target}: the folder {folder} is not writable")


def check_distinct(outputs: Mapping[str, Path], inputs: Iterable[Path] = ()) -> None:
    """Raise OutputError where outputs, by their options, or inputs are one file, also by links."""
    read = list(inputs)
    for (name, target), (other, another) in itertools.combinations(outputs.items(), 2):
        if is_same(target, another):
            raise OutputError(f"{target}: {name} and {other} would write to the same file")
    for name, target in outputs.items():
        if any(is_same(target, path) for path in read):
            raise OutputError(f"{target}: {name} would overwrite an input")


def is_same(one: Path, other: Path) -> bool:
    """Whether two paths are the same file, or will be once created."""
    try:
        return one.samefile(other)
    except OSError:  # one of them is not there yet
        return os.path.realpath(one) == os.path.realpath(other)


def replace_any(_target: Path) -> bool:
    """Allow to replace any file; see `replacing`."""
    return True


def replace_none(_target: Path) -> bool:
    """Allow to replace no file; see `replacing`."""
    return False


def check_free(target: Path, may_replace: Callable[[Path], bool] = replace_none) -> None:
    """Check that a target is not there, or may be replaced; raises OutputError where it may not."""
    if os.path.lexists(target) and not may_replace(target):
        raise OutputError(f"{target}: exists; --overwrite, in Python overwrite=True, replaces it")


def create(target: Path, *, overwrite: bool = False, room_bytes: int = 0) -> io.FileIO:
    """Open a new file that is written piece by piece.

    Raises OutputError as `check_target`, where there is an older file, or on a full disk; an older
    file is not changed then.

    `overwrite`: whether the new file replaces an older one, at once. Other hard links to that keep
    its contents.
    `room_bytes`: free space that the disk must have.
    """
    check_target(target)
    path = partial_beside(end_of(target)) if overwrite else target
    try:
        file = io.FileIO(path, "x")
        try:
            write_all(file, bytes(room_bytes))
            file.seek(0)
            file.truncate()
        except OSError:
            discard(file, path)
            raise
        if overwrite:
            file.close()  # Windows moves no open file
            try:
                path.replace(end_of(target))
            except OSError:
                path.unlink()
                raise
            file = io.FileIO(end_of(target), "r+")
    except FileExistsError:
        raise OutputError(f"{target}: exists") from None
    except OSError as error:
        raise OutputError(f"{target}: cannot write: {error_reason(error)}") from error
    return file


def discard(file: io.FileIO, path: Path) -> None:
    """Close and remove a file, unless another file has replaced it."""
    with file, contextlib.suppress(OSError):
        is_there = os.path.samestat(os.fstat(file.fileno()), path.stat())
        file.close()  # Windows removes no open file
        if is_there:
            path.unlink()


def is_removed(file: io.FileIO, target: Path) -> bool:
    """Whether an open file is no longer where it was made: removed, replaced or moved away."""
    try:
        there = target.stat()
    except FileNotFoundError:
        return True
    except OSError:  # a folder that cannot be read now
        return False
    # Some file systems number files anew while they are open, so a link that is left counts too.
    own = os.fstat(file.fileno())
    return own.st_nlink == 0 and not os.path.samestat(own, there)


def write_all(file: io.FileIO, data: bytes) -> None:
    """Write all data to an unbuffered file; where OSError is raised, some of it may be written."""
    rest = memoryview(data)
    while rest:
        rest = rest[file.write(rest) :]


@contextlib.contextmanager
def replacing(target: Path, may_replace: Callable[[Path], bool] = replace_any) -> Iterator[Path]:
    """Yield a path beside `target` to write to; move it there when the block succeeds.

    An error or interrupt within the block removes the partial file and leaves an older `target`
    unchanged. Raises OutputError as `check_target` and `check_free`, or where writing fails, as on
    a full disk.

    `may_replace`: called with an older target, at the beginning and at the end; returns whether it
    may be replaced.
    """
    check_target(target)
    check_free(target, may_replace)
    partial = partial_beside(end_of(target))
    try:
        partial.touch(exist_ok=False)
        yield partial
        _move(partial, target, may_replace)
    except OSError as error:
        raise OutputError(f"{target}: cannot write: {error_reason(error)}") from error
    finally:
        with contextlib.suppress(OSError):
            partial.unlink(missing_ok=True)


def _move(partial: Path, target: Path, may_replace: Callable[[Path], bool]) -> None:
    """Move a file to its target, whole at each moment, without a race with other writers."""
    destination = end_of(target)
    try:
        destination.hardlink_to(partial)  # only where nothing is there yet; `partial` goes next
    except OSError:  # it is there, or the disk has no links
        check_free(target, may_replace)
        partial.replace(destination)


def end_of(target: Path) -> Path:
    """The file that links lead to; of a ring of links, one of them (where Path's raises)."""
    return Path(os.path.realpath(target))


def partial_beside(target: Path) -> Path:
    """A new hidden name in the same folder, on the same disk, for what is moved to `target`.

    The first for a folder removes what this user's killed processes left there.
    """
    _remove_leftovers(target.parent)
    return target.parent / f".yehu-server-{secrets.token_hex(8)}.part"


@lru_cache(maxsize=1024)
def _remove_leftovers(folder: Path) -> None:
    """Remove partial files that nobody has written to for a day."""
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if LEFTOVER.fullmatch(entry.name) and _is_old(entry.stat(follow_symlinks=False)):
                with contextlib.suppress(OSError):
                    os.unlink(entry.path)  # noqa: PTH108 - of scandir


def _is_old(status: os.stat_result) -> bool:
    return (
        is_own(status)
        and stat.S_ISREG(status.st_mode)
        and time.time() - status.st_mtime > LEFTOVER_AFTER_S
    )


def write_bytes(target: Path, data: bytes, *, overwrite: bool = True) -> Path:
    """Write a file as `replacing` does; return its path."""
    with replacing(target, replace_any if overwrite else replace_none) as partial:
        partial.write_bytes(data)
    return target


def write_text(target: Path, text: str) -> None:
    """Write a text file atomically, also where power is cut; raises OutputError as `replacing`."""
    with replacing(target) as partial, partial.open("w", encoding="utf-8", newline="") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())


def shipped_folder(name: str) -> Path:
    """The folder of shipped files: in the package, or beside it in a checkout."""
    path_inside = PACKAGE / name
    return path_inside if path_inside.is_dir() else PACKAGE.parent / name
