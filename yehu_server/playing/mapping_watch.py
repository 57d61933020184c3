"""Reload a mapping when one of its files changes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from yehu_server.errors import MappingError
from yehu_server.playing.mapping import Mapping

# Modification time, size and inode of each file; None where there is no file.
Marks = dict[Path, tuple[int, int, int] | None]


class MappingWatch:
    """Polls the files of a mapping.

    A change counts once the files were the same at two polls in a row, so that none is read
    half written.

    `mapping`: the mapping in use.
    `read`: reads it again; raises MappingError where it is wrong.
    """

    def __init__(self, mapping: Mapping, read: Callable[[], Mapping]) -> None:
        self._mapping = mapping
        self._read = read
        self._known = self._seen = _marks(mapping.files)
        self._refused: str | None = None

    def look(self) -> Mapping | None:
        """Poll the files; return the mapping if it has changed.

        A wrong mapping is read again at each poll, as the cause may lie in a file not known yet.
        Raises MappingError where it is wrong; once for each reason.
        """
        before, self._seen = self._seen, _marks(self._mapping.files)
        if self._seen != before or (self._seen == self._known and self._refused is None):
            return None
        self._known = self._seen
        try:
            _check(self._mapping.files)
            changed = self._read()
        except MappingError as error:
            if str(error) == self._refused:
                return None
            self._refused = str(error)
            raise
        was, self._mapping, self._refused = self._mapping, changed, None
        self._known = self._seen = _marks(changed.files)
        return None if changed == was else changed


def _check(files: tuple[Path, ...]) -> None:
    """Refuse pipes and devices, whose reading might never end."""
    for file in files:
        if file.exists() and not file.is_file():
            raise MappingError(f"{file}: is not a regular file")


def _marks(files: tuple[Path, ...]) -> Marks:
    return {file: _mark(file) for file in files}


def _mark(file: Path) -> tuple[int, int, int] | None:
    try:
        status = file.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
