"""A mapping that is taken up anew when one of its files changes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from yehu_server.errors import MappingError
from yehu_server.playing.mapping import Mapping

# Of each file, what a change of it changes; None where there is none.
Marks = dict[Path, tuple[int, int, int] | None]


class MappingWatch:
    """Looks at the files of a mapping whenever it is told to.

    A change counts once the files have stood still from one look to the next, so that none
    is read half written.

    Parameters
    ----------
    mapping : Mapping
        The one in use.
    read : callable
        Reads it anew. Errors: MappingError.
    """

    def __init__(self, mapping: Mapping, read: Callable[[], Mapping]) -> None:
        self._mapping = mapping
        self._read = read
        self._known = self._seen = _marks(mapping.files)
        self._refused: str | None = None

    def look(self) -> Mapping | None:
        """The mapping as it now is, if it has changed.

        Errors: MappingError, once, where it is wrong; it is tried again at each look, as what
        is missing may be in files that are not known yet.
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
    """Errors: MappingError for a pipe or a device: who reads it might wait for ever."""
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
