"""Read one mapping file: its contents, or all errors in it with their lines.

The format is described in mappings/README.md.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from yehu_server.errors import MappingError, ParameterError, SettingsError
from yehu_server.params.spec import Curve
from yehu_server.playing import mapping_entries as entries
from yehu_server.playing import sources
from yehu_server.playing.binds import Bind, Breakpoints
from yehu_server.playing.toml_lines import KeyPath, line_at, lines_of
from yehu_server.util.documents import parse_json, parse_toml
from yehu_server.util.files import MAX_SETTINGS_BYTES, read_text

ENTRIES = ("name", "about", "base", "mpe", "start", "bind")
BIND_ENTRIES = (
    "source", "target", "input", "span", "curve", "invert", "smoothing", "channel", "soft", "alone",
    "global",
)  # fmt: skip
_LINE = re.compile(r"\(at line ([0-9]+)")

MOST_ERRORS = 50  # a hint at a similar name takes milliseconds each

T = TypeVar("T")


@dataclass(frozen=True)
class MappingFile:
    """The contents of one file, without its base; `mpe` is None where it is not given."""

    name: str
    binds: tuple[Bind, ...] = ()
    start: tuple[tuple[str, float], ...] = ()
    base: str | None = None
    mpe: bool | None = None
    about: str = ""


class FileErrors:
    """Collects the errors in a file, to raise them all at once, as errors of a kind."""

    def __init__(self, path: Path, text: str, kind: type[SettingsError] = MappingError) -> None:
        self._path = path
        self._kind = kind
        self._text = text
        self._lines: dict[KeyPath, int] | None = None
        self._found: list[tuple[int, str]] = []

    def add(self, key: KeyPath, reason: str) -> None:
        """Add an error in an entry.

        Raises
        ------
        SettingsError
            As `raise_all`, where there are MOST_ERRORS.
        """
        self._found.append((self._line(key) or 0, f"{self.where(key)}: {reason}"))
        if len(self._found) == MOST_ERRORS:
            self.raise_all()

    def where(self, key: KeyPath) -> str:
        """The file, and the line of an entry if it has one."""
        line = self._line(key)
        return str(self._path) if line is None else f"{self._path}:{line}"

    def _line(self, key: KeyPath) -> int | None:
        if self._lines is None:
            self._lines = lines_of(self._text)
        return line_at(self._lines, key)

    def raise_all(self) -> None:
        """Raise what was added, by line; return if nothing was.

        Raises
        ------
        SettingsError
            Of the kind: the first error; its `more` are the others.
        """
        if self._found:
            raise self._kind(*(what for _, what in sorted(self._found, key=lambda one: one[0])))


def read_mapping_file(path: Path) -> MappingFile:
    """Read a TOML file.

    Raises
    ------
    MappingError
        Naming file and line.
    """
    text = text_of(path)
    return mapping_file_from(path, toml_of(path, text), text)


def text_of(path: Path) -> str:
    """The text of a file.

    Raises
    ------
    MappingError
        Where it cannot be read or is not UTF-8.
    """
    try:
        return read_text(path, MAX_SETTINGS_BYTES)
    except OSError as error:
        raise MappingError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise MappingError(f"{path}: not a mapping file ({error})") from error


def toml_of(path: Path, text: str) -> dict[str, Any]:
    """The entries of a TOML text.

    Raises
    ------
    MappingError
        Where it is not TOML.
    """
    try:
        return parse_toml(text)
    except ValueError as error:
        found = _LINE.search(str(error))
        line = f":{found[1]}" if found else ""
        raise MappingError(f"{path}{line}: not a mapping file ({error})") from error


def json_of(path: Path, text: str) -> dict[str, Any]:
    """The entries of what ``yehu-server mappings show --json`` prints.

    Raises
    ------
    MappingError
        Where it is not a JSON object.
    """
    try:
        data = parse_json(text)
    except ValueError as error:
        raise MappingError(f"{path}: not a mapping ({error})") from error
    if not isinstance(data, dict):
        raise MappingError(f"{path}: not a mapping")
    binds = data.get("bind", [])
    if isinstance(binds, list):
        data["bind"] = [_of_json(bind) if isinstance(bind, dict) else bind for bind in binds]
    return _without_null(data)


def _of_json(entry: dict[str, Any]) -> dict[str, Any]:
    ends = [entry.pop(name, None) for name in ("from", "to")]
    # Older versions printed no span beside them; both are null for the bend range.
    if "span" not in entry and ends != [None, None]:
        entry["span"] = ends
    return _without_null(entry)


def _without_null(table: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in table.items() if value is not None}


# ---------------------------------------------------------------- entries


def mapping_file_from(path: Path, data: dict[str, Any], text: str = "") -> MappingFile:
    """Check and convert the entries of a file; its text gives the lines for errors.

    Raises
    ------
    MappingError
        Naming file and line.
    """
    errors = FileErrors(path, text)
    for name in data:
        if name not in ENTRIES:
            errors.add((name,), f"unknown entry {name!r} (known: {', '.join(ENTRIES)})")

    def read(name: str, reader: Callable[[Any], T], default: T) -> T:
        return _read(data, name, reader, default, lambda reason: errors.add((name,), reason))

    mapping_file = MappingFile(
        name=read("name", entries.line_of_text("name"), path.stem),
        binds=_binds(data.get("bind", []), errors),
        start=_start(data.get("start", {}), errors),
        base=read("base", entries.line_of_text("base"), None),
        mpe=read("mpe", entries.boolean("mpe"), None),
        about=read("about", entries.line_of_text("about"), ""),
    )
    errors.raise_all()
    return mapping_file


def _start(values: Any, errors: FileErrors) -> tuple[tuple[str, float], ...]:
    if not isinstance(values, dict):
        errors.add(("start",), "start: expected a table of addresses and values")
        return ()
    start = []
    for address, value in values.items():
        try:
            start.append((address, entries.start(address, value)))
        except ParameterError as error:
            errors.add(("start", address), f"start: {error}")
    return tuple(start)


def _binds(tables: Any, errors: FileErrors) -> tuple[Bind, ...]:
    if not isinstance(tables, list):
        errors.add(("bind",), "write each bind as [[bind]]")
        return ()
    binds = []
    for index, entry in enumerate(tables):

        def add_error(name: str, reason: str, index: int = index) -> None:
            errors.add(("bind", index, name), f"bind {index + 1}: {reason}")

        bind = _bind(entry, add_error)
        if bind is not None:
            binds.append(bind)
    return tuple(binds)


def _bind(entry: Any, add_error: Callable[[str, str], None]) -> Bind | None:
    if not isinstance(entry, dict):
        add_error("", "expected a table")
        return None
    for name in entry:
        if name not in BIND_ENTRIES:
            add_error(name, f"unknown entry {name!r} (known: {', '.join(BIND_ENTRIES)})")

    def read(name: str, reader: Callable[[Any], T], default: T) -> T:
        return _read(entry, name, reader, default, lambda reason: add_error(name, reason))

    missing = [name for name in ("source", "target") if not isinstance(entry.get(name), str)]
    source, param = None, None
    if missing:
        add_error(missing[0], "needs a source and a target")
    else:
        source = read("source", sources.canonical, None)
        param = read("target", lambda text: entries.settable_param(text, "map to one"), None)
    curve: Curve | Breakpoints | None = read("curve", entries.curve, None)
    bind = Bind(
        source or "",
        param.address if param else "",
        span=read("span", lambda value: entries.span(value, param), None),
        curve=curve or (param.curve if param else Curve.LIN),
        invert=read("invert", entries.boolean("invert"), False),
        smoothing_ms=read("smoothing", entries.smoothing, 0.0),
        channels=read("channel", entries.channels, ()),
        is_soft=read("soft", entries.boolean("soft"), False),
        input_range=read("input", entries.input_range, (0.0, 1.0)),
        is_exclusive=read("alone", entries.boolean("alone"), False),
        is_global=read("global", entries.boolean("global"), False),
    )
    if source is None or param is None:
        return None
    for name, reason in _conflicts(bind, entry):
        add_error(name, reason)
    return bind


def _conflicts(bind: Bind, entry: dict[str, Any]) -> list[tuple[str, str]]:
    """Entries of a bind that exclude each other, and why."""
    found = []
    if bind.curve is Curve.EXP and min(bind.ends) <= 0.0:
        found.append(("curve", "an exp curve needs a span above zero"))
    if sources.is_address(bind.source):
        if "channel" in entry:
            found.append(("channel", "channel: an OSC address has no channel"))
        if bind.is_global:
            found.append(("global", "global: an OSC address always is global"))
    elif "input" in entry:
        found.append(("input", "input: only OSC addresses have an input range"))
    if bind.is_soft and (bind.source in sources.OF_ONE_NOTE or bind.is_by_range):
        what = "the bend by the bend range" if bind.is_by_range else bind.source
        found.append(("soft", f"soft: {what} cannot wait for the target"))
    if bind.is_global and bind.source in sources.OF_ONE_NOTE:
        found.append(("global", f"global: {bind.source} belongs to one note"))
    return found


def _read(
    table: dict[str, Any],
    name: str,
    reader: Callable[[Any], T],
    default: T,
    add_error: Callable[[str], None],
) -> T:
    if name not in table:
        return default
    try:
        return reader(table[name])
    except ParameterError as error:
        add_error(str(error))
        return default
