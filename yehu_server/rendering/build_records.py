"""Records of what was built, which show what is up to date, and the manifest of a folder.

Each folder of results has a hidden folder: a record for each result, and what is being made.
A record holds a key of all that the result depends on, hashes of the files it was made from, and
what may be reported of it again.
"""

import contextlib
import hashlib
import json
import os
import secrets
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from yehu_server.errors import OutputError
from yehu_server.system.files import open_at_once
from yehu_server.system.locks import lock
from yehu_server.util import files

NAME = "manifest.jsonl"
MAX_BYTES = 2**30
HIDDEN = ".yehu-server"
MAX_RECORD_BYTES = 16 * 2**20
LONGEST_NAME = 255  # bytes
CHUNK = 1 << 20
Record = dict[str, Any]
LOCK = "lock"


def checked_line(line: Any, **wanted: object) -> dict[str, Any]:
    """A line of a manifest that came from elsewhere.

    The entries `wanted` are known beforehand, such as ``file``. Raises ValueError, TypeError where
    it is none: not of texts and numbers, about something else, an error without text, too long.
    """
    if not isinstance(line, dict) or any(line.get(name) != known for name, known in wanted.items()):
        raise ValueError("a line about something else")
    if not isinstance(line.get("error", ""), str):
        raise TypeError("an error without text")
    if len(json.dumps(line)) >= files.MAX_LINE_BYTES:  # nor of bytes
        raise ValueError("a line that no manifest may have")
    return line


def write_manifest(folder: Path, lines: Iterable[Mapping[str, Any]], order: str = "file") -> None:
    """Write the manifest, in the order of the names or another entry; raises OutputError."""
    ordered = sorted(lines, key=lambda line: line[order])
    files.write_text(folder / NAME, "".join(f"{json.dumps(line)}\n" for line in ordered))


def check_manifest(folder: Path) -> None:
    """Check that the manifest may be written. Raises OutputError where the file is another's."""
    path = folder / NAME
    try:
        first = next(files.read_lines(path, MAX_BYTES), "")
        fields = json.loads(first) if first else {"file": ""}
        if "file" in fields and isinstance(fields, dict):
            return
    except FileNotFoundError:
        return
    except (OSError, ValueError, RecursionError, TypeError):
        pass
    raise OutputError(f"{path}: is not a manifest of yehu-server; move it away")


def hash_of(path: Path) -> str:
    """Hash of a file's bytes (SHA-256, hexadecimal); empty where it cannot be read."""
    digest = hashlib.sha256()
    try:
        with files.open_regular(path) as file:
            while data := file.read(CHUNK):
                digest.update(data)
    except OSError:
        return ""
    return digest.hexdigest()


def temporary_of(target: Path) -> Path:
    """Where a result is made, on the same disk, before it is moved to its target.

    Each time it is another place: a worker that was given up may still be making it.
    """
    return target.parent / HIDDEN / f"{secrets.token_hex(8)}.part"


def record_of(target: Path) -> Path:
    """The file of the record of a result."""
    name = f"{target.name}.json"
    encoded = os.fsencode(name)
    if len(encoded) > LONGEST_NAME - 8:
        name = f"{hashlib.sha256(encoded).hexdigest()}.json"
    return target.parent / HIDDEN / name


def make_folder_for(target: Path) -> None:
    """Make the folders of a result. Raises OutputError where they cannot be made."""
    files.make_folder(target.parent / HIDDEN)


def keep(
    target: Path, key: str, read: Iterable[Path], results: Iterable[Path], line: Record
) -> None:
    """Write the record of results that are in their places.

    The key is of all that they depend on beside the files they were made from, `read`. The results
    are the target, and what was made beside it. The line is what may be reported of them again.
    """
    made = {}
    for path in results:
        status = path.stat()
        facts = {"size": status.st_size, "mtime_ns": status.st_mtime_ns, "hash": hash_of(path)}
        made[_beside(target, path)] = facts
    inputs = {str(path.absolute()): hash_of(path) for path in read}
    record = {"key": key, "read": inputs, "results": made, "line": line}
    files.write_text(record_of(target), json.dumps(record) + "\n")


def up_to_date(
    target: Path, key: str, results: Iterable[Path], hashing: Callable[[Path], str] = hash_of
) -> Record | None:
    """The manifest line of a target whose results are up to date; None where there is none."""
    try:
        record = json.loads(files.read_text(record_of(target), MAX_RECORD_BYTES))
        line: Record = record["line"]
        made = record["results"]
        wanted = {_beside(target, path): path for path in results}
        is_current = (
            record["key"] == key
            and made.keys() == wanted.keys()
            and all(hashing(Path(path)) == old for path, old in record["read"].items())
            and all(_is_whole(path, made[name]) for name, path in wanted.items())
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None
    return line if is_current and isinstance(line, dict) else None


def _is_whole(path: Path, made: Record) -> bool:
    """Whether a result is as it was made: by size and time, or else by its bytes."""
    status = path.stat()
    if status.st_size != made["size"]:
        return False
    return bool(status.st_mtime_ns == made["mtime_ns"] or hash_of(path) == made["hash"])


def _beside(target: Path, path: Path) -> str:
    """The name of a result, which holds wherever the folders are moved."""
    return os.path.relpath(path, target.parent)


def clear_work(folders: Iterable[Path]) -> None:
    """Remove what processes that were killed left half made; nobody may be making any."""
    for folder in folders:
        with contextlib.suppress(OSError):
            for file in list((folder / HIDDEN).iterdir()):
                if file.suffix != ".json" and file.name != LOCK:
                    with contextlib.suppress(OSError):
                        file.unlink()


@contextlib.contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Keep other processes from writing to a folder. Raises OutputError where one does."""
    path = folder / HIDDEN / LOCK
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = open(path, "w", opener=open_at_once)  # noqa: SIM115 - closed below
    except OSError as error:
        raise OutputError(f"{folder}: cannot write: {files.error_reason(error)}") from error
    with file:
        try:
            lock(file.fileno())
        except BlockingIOError:
            raise OutputError(f"{folder}: another command writes to it") from None
        except OSError:  # a disk without locks
            pass
        yield
