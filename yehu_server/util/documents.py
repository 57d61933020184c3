"""Read TOML and JSON of users, with all errors in one form: ``FILE:LINE: PLACE: REASON``.

For example ``mine.toml:7: bind 1: span: expected ...``. The line is that of an entry in TOML; data
from a program have no file.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Concatenate, ParamSpec, TypeVar, cast

from yehu_server.errors import ParameterError, SettingsError, YehuError, did_you_mean
from yehu_server.util.files import MAX_SETTINGS_BYTES, error_reason, read_text
from yehu_server.util.parsing import (
    KeyPath,
    ParsingError,
    line_at,
    lines_of,
    parse_json,
    parse_toml,
)
from yehu_server.util.values import brief

MAX_ERRORS = 50  # searching for a similar name takes milliseconds each
MANY = sys.maxsize
_DOTTED = re.compile(r"[\w.-]+")

# What only one kind of file has at its top, to tell of one that was taken for another.
_KINDS = {
    "bind": "a mapping",
    "drop": "a mapping",
    "start": "a mapping",
    "values": "a preset",
    "part": "an ensemble file",
    "vary": "a study",
    "draw": "a description of a data set",
    "controls": "a gesture file",
    "bridge_modes": "a body file",
    "string_1": "an instrument file",
    "string_2": "an instrument file",
}

T = TypeVar("T")
D = TypeVar("D")
P = ParamSpec("P")


def looks_like(data: Mapping[str, Any], what: str) -> str:
    """The kind of file that data are of, if it is another, for the end of an error; else nothing.

    `what`: what the file should be.
    """
    kind = next((_KINDS[name] for name in data if name in _KINDS), what)
    return "" if what.startswith(kind) else f"; it looks like {kind}"


@dataclass(eq=False)
class Document:
    """The text of a file, and the errors found in it."""

    name: Path | str = ""  # what errors begin with
    what: str = "a document"  # what it should be, such as "a mapping file"
    # Of errors in entries; all of them are raised as one, up to `most_errors`.
    error: type[YehuError] = ParameterError
    # Of errors in what is no such document at all, if that is another.
    unreadable: type[YehuError] | None = None
    text: str = ""
    most_errors: int = 1
    raised: YehuError | None = None
    _found: list[tuple[int, str]] = field(default_factory=list)
    _lines: dict[KeyPath, int] | None = field(default_factory=dict)

    def read(self, path: Path, most_bytes: int = MAX_SETTINGS_BYTES) -> Document:
        """Read the text of a file; raises the error of the document where that cannot be."""
        try:
            self.text = read_text(path, most_bytes)
        except OSError as error:
            raise self._unreadable(f"{self.name}: {error_reason(error)}") from error
        except ValueError as error:  # not UTF-8, or a path with a NUL
            raise self._not(error) from error
        return self

    def toml(self) -> Fields:
        """Parse the text as TOML; raises the error of the document where it is none."""
        try:
            data = parse_toml(self.text)
        except ValueError as error:
            raise self._not(error) from error
        self._lines = None
        return Fields(data, self)

    def json(self) -> Fields:
        """Parse the text as a JSON object; raises the error of the document where it is none."""
        try:
            return Fields(parse_json(self.text), self)
        except ValueError as error:
            raise self._not(error) from error

    @property
    def _unreadable(self) -> type[YehuError]:
        return self.unreadable or self.error

    def _not(self, error: ValueError) -> YehuError:
        line = f":{error.line}" if isinstance(error, ParsingError) else ""
        reason = "it is not text in UTF-8" if isinstance(error, UnicodeDecodeError) else error
        return self._unreadable(f"{self.name}{line}: not {self.what} ({reason})")

    def _line(self, key: KeyPath) -> int | None:
        if self._lines is None:
            self._lines = lines_of(self.text)
        return line_at(self._lines, key)

    def where(self, key: KeyPath) -> str:
        """The document, and the line of an entry if it has one."""
        line = self._line(key)
        return str(self.name) if line is None else f"{self.name}:{line}"

    def add(self, key: KeyPath, reason: str) -> None:
        """Add an error in an entry; raises all of them once there are `most_errors`."""
        where = self.where(key)
        self._found.append((self._line(key) or 0, f"{where}: {reason}" if where else reason))
        if len(self._found) >= self.most_errors:
            self.raise_errors()

    def raise_errors(self) -> None:
        """Raise the errors that were added, by line, as one; return where there are none."""
        if self._found:
            first, *others = [what for _, what in sorted(self._found, key=lambda one: one[0])]
            self._found = []
            self.raised = self.error(first)
            for other in others:
                self.raised.add_note(other)
            raise self.raised


class Fields:
    """A table of a document.

    Wrong entries become errors of the document. So a reader goes on with its default, unless the
    document raises errors at once.

    `data`: its entries.
    `document`: by default one without a name, that raises ParameterError.
    `place`: where in the document it is, for errors.
    `key`: the same, for its line.
    """

    def __init__(
        self, data: Any, document: Document | None = None, place: str = "", key: KeyPath = ()
    ) -> None:
        self.document = document or Document()
        self.place = place
        self.key = key
        self._known: dict[str, None] = {}
        self.is_table = isinstance(data, Mapping)
        self.data: Mapping[str, Any] = data if self.is_table else {}
        if not self.is_table:
            self.add_error("", f"expected a table of names and values, got {brief(data)}")

    @staticmethod
    def of(data: Any, place: str = "") -> Fields:
        """A table that is one already, or of data that come from no file."""
        return data if isinstance(data, Fields) else Fields(data, place=place)

    def add_error(self, name: str, reason: str) -> None:
        """Add an error in an entry, or in all of the table where the name is empty."""
        place = self._place(name)
        key = (*self.key, name) if name else self.key
        self.document.add(key, f"{place}: {reason}" if place else reason)

    def _place(self, name: str) -> str:
        shown = brief(name, str if str(name).isprintable() else repr)
        if not self.place or not name:
            return self.place or shown
        dotted = f"{self.place}.{shown}"
        return dotted if _DOTTED.fullmatch(dotted) else f"{self.place}: {shown}"

    def where(self) -> str:
        """The document, and the line of the table if it has one."""
        return self.document.where(self.key)

    @contextmanager
    def at(self, name: str = "") -> Iterator[None]:
        """Give errors of values, or of a file that is named, an entry's place; see `add_error`."""
        try:
            yield
        except (ParameterError, SettingsError) as error:
            if error is self.document.raised:
                raise
            for line in error.lines:
                self.add_error(name, line)

    def read(
        self,
        name: str,
        reader: Callable[Concatenate[Any, P], T],
        default: D,
        *args: P.args,
        **kwargs: P.kwargs,
    ) -> T | D:
        """Convert an entry by a reader, which raises ParameterError."""
        self._known[name] = None
        if name in self.data:
            with self.at(name):
                return reader(self.data[name], *args, **kwargs)
        return default

    def need(
        self, name: str, reader: Callable[Concatenate[Any, P], T], *args: P.args, **kwargs: P.kwargs
    ) -> T:
        """`read` an entry that has to be there, of a document that raises errors at once."""
        if name not in self.data:
            self.add_error(name, "missing")
        return cast("T", self.read(name, reader, None, *args, **kwargs))

    def each(self, reader: Callable[[str, Any], T]) -> dict[str, T]:
        """Convert all entries of a table of any names by a reader."""
        found: dict[str, T] = {}
        for name, value in self.data.items():
            with self.at(name):
                found[name] = reader(name, value)
        return found

    def table(self, name: str) -> Fields:
        """A table within this one, empty where there is none."""
        self._known[name] = None
        return Fields(self.data.get(name, {}), self.document, self._place(name), (*self.key, name))

    def tables(self, name: str, least: int = 0, most: int = MANY) -> list[Fields]:
        """The tables of an array, `least` to `most`, each written as ``[[name]]``."""
        self._known[name] = None
        found = self.data.get(name, [])
        place, key = self._place(name), (*self.key, name)
        if not isinstance(found, list):
            self.add_error(name, f"write each as [[{name}]]")
        elif not least <= len(found) <= most:
            upto = "or more" if most == MANY else f"to {most}"
            reason = f"{place}: expected {least} {upto} of [[{name}]], got {len(found)}"
            self.document.add((*key, most), reason)
        else:
            tables = [
                Fields(each, self.document, f"{place} {number + 1}", (*key, number))
                for number, each in enumerate(found)
            ]
            return [table for table in tables if table.is_table]
        return []

    def refuse_others(self, *others: str) -> None:
        """Refuse all entries but those that were read, and `others`."""
        for name in self.data:
            if name not in self._known and name not in others:
                known = (*self._known, *others)
                hint = did_you_mean(name, known)
                kind = "" if self.place or self.key else looks_like(self.data, self.document.what)
                self.add_error(name, f"unknown entry{hint}{kind} (known: {', '.join(known)})")
