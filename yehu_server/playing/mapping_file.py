"""Reading one mapping file: what it says, or all that is wrong with it, by line.

The format is described in mappings/README.md.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from yehu_server.documents import parse_json, parse_toml
from yehu_server.errors import MappingError, ParameterError
from yehu_server.files import MAX_SETTINGS_BYTES, read_text
from yehu_server.params.spec import Curve
from yehu_server.playing import mapping_entries as entries
from yehu_server.playing import sources
from yehu_server.playing.binds import Bind, Table
from yehu_server.playing.toml_lines import Way, line_at, lines_of

ENTRIES = ("name", "about", "base", "mpe", "start", "bind")
BIND_ENTRIES = (
    "source", "target", "input", "span", "curve", "invert", "smoothing", "channel", "soft", "alone",
    "global",
)  # fmt: skip
_LINE = re.compile(r"\(at line ([0-9]+)")

MOST_COMPLAINTS = 50

T = TypeVar("T")


@dataclass(frozen=True)
class Sheet:
    """What one file says, without its base; `mpe` is None where it says nothing of it."""

    name: str
    binds: tuple[Bind, ...] = ()
    start: tuple[tuple[str, float], ...] = ()
    base: str | None = None
    mpe: bool | None = None
    about: str = ""


class Complaints:
    """What is wrong with a file, until all of it is known."""

    def __init__(self, path: Path, text: str) -> None:
        self._path = path
        self._text = text
        self._lines: dict[Way, int] | None = None
        self._said: list[tuple[int, str]] = []

    def add(self, way: Way, what: str) -> None:
        """Keep what is wrong with an entry. Errors: as of `end`, where it is too much to go on."""
        if self._lines is None:
            self._lines = lines_of(self._text)
        line = line_at(self._lines, way)
        where = f"{self._path}: " if line is None else f"{self._path}:{line}: "
        self._said.append((line or 0, where + what))
        if len(self._said) == MOST_COMPLAINTS:  # each takes milliseconds to find a near name for
            self.end()

    def end(self) -> None:
        """Errors: MappingError, where something was wrong; its `more` are the others."""
        if self._said:
            raise MappingError(*(what for _, what in sorted(self._said, key=lambda one: one[0])))


def read_sheet(path: Path) -> Sheet:
    """Read a TOML file. Errors: MappingError, naming file and line."""
    text = text_of(path)
    return sheet_of(path, toml_of(path, text), text)


def text_of(path: Path) -> str:
    """The text of a file. Errors: MappingError."""
    try:
        return read_text(path, MAX_SETTINGS_BYTES)
    except OSError as error:
        raise MappingError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise MappingError(f"{path}: not a mapping file ({error})") from error


def toml_of(path: Path, text: str) -> dict[str, Any]:
    """The entries of a TOML text. Errors: MappingError."""
    try:
        return parse_toml(text)
    except ValueError as error:
        found = _LINE.search(str(error))
        line = f":{found[1]}" if found else ""
        raise MappingError(f"{path}{line}: not a mapping file ({error})") from error


def json_of(path: Path, text: str) -> dict[str, Any]:
    """The entries of what ``yehu-server mappings show --json`` prints. Errors: MappingError."""
    try:
        data = parse_json(text)
    except ValueError as error:
        raise MappingError(f"{path}: not a mapping ({error})") from error
    if not isinstance(data, dict):
        raise MappingError(f"{path}: not a mapping")
    binds = data.get("bind", [])
    if isinstance(binds, list):
        data["bind"] = [_of_json(bind) if isinstance(bind, dict) else bind for bind in binds]
    return _present(data)


def _of_json(entry: dict[str, Any]) -> dict[str, Any]:
    ends = [entry.pop(name, None) for name in ("from", "to")]
    # Once there was no span beside them, and both are null for the bend range.
    if "span" not in entry and ends != [None, None]:
        entry["span"] = ends
    return _present(entry)


def _present(table: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in table.items() if value is not None}


# ---------------------------------------------------------------- what a file says


def sheet_of(path: Path, data: dict[str, Any], text: str = "") -> Sheet:
    """Read the entries of a file, whose text tells their lines. Errors: MappingError."""
    wrong = Complaints(path, text)
    for name in data:
        if name not in ENTRIES:
            wrong.add((name,), f"unknown entry {name!r} (known: {', '.join(ENTRIES)})")

    def read(name: str, reader: Callable[[Any], T], default: T) -> T:
        return _read(data, name, reader, default, lambda what: wrong.add((name,), what))

    sheet = Sheet(
        name=read("name", entries.words("name"), path.stem),
        binds=_binds(data.get("bind", []), wrong),
        start=_start(data.get("start", {}), wrong),
        base=read("base", entries.words("base"), None),
        mpe=read("mpe", entries.flag("mpe"), None),
        about=read("about", entries.words("about"), ""),
    )
    wrong.end()
    return sheet


def _start(values: Any, wrong: Complaints) -> tuple[tuple[str, float], ...]:
    if not isinstance(values, dict):
        wrong.add(("start",), "start: expected a table of addresses and values")
        return ()
    start = []
    for address, value in values.items():
        try:
            start.append((address, entries.start(address, value)))
        except ParameterError as error:
            wrong.add(("start", address), f"start: {error}")
    return tuple(start)


def _binds(tables: Any, wrong: Complaints) -> tuple[Bind, ...]:
    if not isinstance(tables, list):
        wrong.add(("bind",), "write each bind as [[bind]]")
        return ()
    binds = []
    for place, entry in enumerate(tables):

        def complain(name: str, what: str, place: int = place) -> None:
            wrong.add(("bind", place, name), f"bind {place + 1}: {what}")

        bind = _bind(entry, complain)
        if bind is not None:
            binds.append(bind)
    return tuple(binds)


def _bind(entry: Any, wrong: Callable[[str, str], None]) -> Bind | None:
    if not isinstance(entry, dict):
        wrong("", "expected a table")
        return None
    for name in entry:
        if name not in BIND_ENTRIES:
            wrong(name, f"unknown entry {name!r} (known: {', '.join(BIND_ENTRIES)})")

    def read(name: str, reader: Callable[[Any], T], default: T) -> T:
        return _read(entry, name, reader, default, lambda what: wrong(name, what))

    missing = [name for name in ("source", "target") if not isinstance(entry.get(name), str)]
    source, param = None, None
    if missing:
        wrong(missing[0], "needs a source and a target")
    else:
        source = read("source", sources.canonical, None)
        param = read("target", lambda text: entries.free(text, "map to one"), None)
    curve: Curve | Table | None = read("curve", entries.curve, None)
    bind = Bind(
        source or "",
        param.address if param else "",
        span=read("span", lambda value: entries.span(value, param), None),
        curve=curve or (param.curve if param else Curve.LIN),
        invert=read("invert", entries.flag("invert"), False),
        smoothing_ms=read("smoothing", entries.smoothing, 0.0),
        channels=read("channel", entries.channels, ()),
        is_soft=read("soft", entries.flag("soft"), False),
        reach=read("input", entries.reach, (0.0, 1.0)),
        is_alone=read("alone", entries.flag("alone"), False),
        is_global=read("global", entries.flag("global"), False),
    )
    if source is None or param is None:
        return None
    for name, what in _disagreements(bind, entry):
        wrong(name, what)
    return bind


def _disagreements(bind: Bind, entry: dict[str, Any]) -> list[tuple[str, str]]:
    """Which entries of a bind do not go together, and why."""
    found = []
    if bind.curve is Curve.EXP and min(bind.ends) <= 0.0:
        found.append(("curve", "an exp curve needs a span above zero"))
    if sources.is_address(bind.source):
        if "channel" in entry:
            found.append(("channel", "channel: an OSC address has none"))
        if bind.is_global:
            found.append(("global", "global: an OSC address always is"))
    elif "input" in entry:
        found.append(("input", "input: only what an OSC address sends has a range of its own"))
    if bind.is_soft and (bind.source in sources.OF_ONE_NOTE or bind.is_by_range):
        what = "the bend by its range" if bind.is_by_range else bind.source
        found.append(("soft", f"soft: {what} cannot wait for the target"))
    if bind.is_global and bind.source in sources.OF_ONE_NOTE:
        found.append(("global", f"global: {bind.source} is of one note"))
    return found


def _read(
    table: dict[str, Any],
    name: str,
    reader: Callable[[Any], T],
    default: T,
    wrong: Callable[[str], None],
) -> T:
    if name not in table:
        return default
    try:
        return reader(table[name])
    except ParameterError as error:
        wrong(str(error))
        return default
