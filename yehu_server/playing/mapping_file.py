"""Reading one mapping file: what it says, or all that is wrong with it, by line.

The format is described in mappings/README.md.
"""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from yehu_server.errors import MappingError, ParameterError
from yehu_server.files import read_text
from yehu_server.params.spec import Curve, Param, Place
from yehu_server.params.table import find
from yehu_server.playing import sources
from yehu_server.playing.binds import Bind, Table
from yehu_server.playing.toml_lines import Way, line_at, lines_of

ENTRIES = ("name", "about", "base", "mpe", "start", "bind")
BIND_ENTRIES = (
    "source", "target", "input", "span", "curve", "invert", "smoothing", "channel", "soft",
)  # fmt: skip
LONGEST_SMOOTHING_MS = 5000.0
MOST_POINTS = 1024
_LINE = re.compile(r"\(at line ([0-9]+)")

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
        """Keep what is wrong with an entry."""
        if self._lines is None:
            self._lines = lines_of(self._text)
        line = line_at(self._lines, way)
        where = f"{self._path}: " if line is None else f"{self._path}:{line}: "
        self._said.append((line or 0, where + what))

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
        return read_text(path)
    except OSError as error:
        raise MappingError(f"{path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise MappingError(f"{path}: not a mapping file ({error})") from error


def toml_of(path: Path, text: str) -> dict[str, Any]:
    """The entries of a TOML text. Errors: MappingError."""
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # ValueError: also a number of many digits
        found = _LINE.search(str(error))
        line = f":{found[1]}" if found else ""
        raise MappingError(f"{path}{line}: not a mapping file ({error})") from error


def json_of(path: Path, text: str) -> dict[str, Any]:
    """The entries of what ``yehu-server mappings show --json`` prints. Errors: MappingError."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise MappingError(f"{path}: not a mapping ({error})") from error
    if not isinstance(data, dict):
        raise MappingError(f"{path}: not a mapping")
    entries = data.get("bind", [])
    if isinstance(entries, list):
        data["bind"] = [_of_json(entry) if isinstance(entry, dict) else entry for entry in entries]
    return _present(data)


def _of_json(entry: dict[str, Any]) -> dict[str, Any]:
    ends = [entry.pop(name, None) for name in ("from", "to")]
    # Once there was no span beside them, and both are null for the bend range.
    if "span" not in entry and ends != [None, None]:
        entry["span"] = ends
    return _present(entry)


def _present(entries: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in entries.items() if value is not None}


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
        name=read("name", _words("name"), path.stem),
        binds=_binds(data.get("bind", []), wrong),
        start=_start(data.get("start", {}), wrong),
        base=read("base", _words("base"), None),
        mpe=read("mpe", _flag("mpe"), None),
        about=read("about", _words("about"), ""),
    )
    wrong.end()
    return sheet


def _start(entries: Any, wrong: Complaints) -> tuple[tuple[str, float], ...]:
    if not isinstance(entries, dict):
        wrong.add(("start",), "start: expected a table of addresses and values")
        return ()
    start = []
    for address, value in entries.items():
        try:
            param = _of_player(address, "set one")
            if param.accept(value) != value:
                raise ParameterError(f"{address}: {value} is not within {param.range_text}")
            start.append((address, float(value)))
        except ParameterError as error:
            wrong.add(("start", address), f"start: {error}")
    return tuple(start)


def _binds(entries: Any, wrong: Complaints) -> tuple[Bind, ...]:
    if not isinstance(entries, list):
        wrong.add(("bind",), "write each bind as [[bind]]")
        return ()
    binds = []
    for place, entry in enumerate(entries):

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

    for name in ("source", "target"):
        if not isinstance(entry.get(name), str):
            wrong(name, "needs a source and a target")
            return None
    source = read("source", sources.canonical, "")
    param = read("target", lambda text: _of_player(text, "map to one"), None)
    if not source or param is None:
        return None
    bind = Bind(
        source,
        param.address,
        span=read("span", lambda value: _span(value, param), None),
        curve=read("curve", _curve, param.curve),
        invert=read("invert", _flag("invert"), False),
        smoothing_ms=read("smoothing", _smoothing, 0.0),
        channels=read("channel", _channels, ()),
        is_soft=read("soft", _flag("soft"), False),
        reach=read("input", _reach, (0.0, 1.0)),
    )
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
    elif "input" in entry:
        found.append(("input", "input: only what an OSC address sends has a range of its own"))
    if bind.is_soft and (bind.source in sources.OF_ONE_NOTE or bind.is_by_range):
        what = "the bend by its range" if bind.is_by_range else bind.source
        found.append(("soft", f"soft: {what} cannot wait for the target"))
    return found


# ---------------------------------------------------------------- what an entry says


def _read(
    entries: dict[str, Any],
    name: str,
    reader: Callable[[Any], T],
    default: T,
    wrong: Callable[[str], None],
) -> T:
    if name not in entries:
        return default
    try:
        return reader(entries[name])
    except ParameterError as error:
        wrong(str(error))
        return default


def _words(name: str) -> Callable[[Any], Any]:
    def read(value: Any) -> str:
        if not isinstance(value, str):
            raise ParameterError(f"{name}: expected a line of text, got {value!r}")
        return value

    return read


def _flag(name: str) -> Callable[[Any], Any]:
    def read(value: Any) -> bool:
        if not isinstance(value, bool):
            raise ParameterError(f"{name}: expected true or false, got {value!r}")
        return value

    return read


def _of_player(address: str, instead: str) -> Param:
    param = find(address)
    if param.place is not Place.PLAYER:
        raise ParameterError(f"{address} is moved by the player; {instead} under /playing")
    return param


def _number(value: Any) -> float | None:
    """A finite number of a file; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def _span(value: Any, param: Param) -> tuple[float, float]:
    ends = _two(value, "span: expected [from, to]")
    for end in ends:
        if not param.lo <= end <= param.hi:  # also refuses NaN
            raise ParameterError(f"span: {end} is not within {param.lo:g} to {param.hi:g}")
    return float(ends[0]), float(ends[1])


def _reach(value: Any) -> tuple[float, float]:
    numbers = [_number(end) for end in _two(value, "input: expected [from, to]")]
    lo, hi = numbers
    if lo is None or hi is None or not 0.0 < abs(hi - lo) < math.inf:
        raise ParameterError(f"input: expected two different numbers, got {_brief(value)}")
    return lo, hi


def _two(value: Any, expected: str) -> list[Any]:
    is_numbers = isinstance(value, list) and all(
        isinstance(end, int | float) and not isinstance(end, bool) for end in value
    )
    if not is_numbers or len(value) != 2:
        raise ParameterError(f"{expected}, got {_brief(value)}")
    return list(value)


def _curve(value: Any) -> Curve | Table:
    if isinstance(value, list):
        return _table(value)
    try:
        return Curve(value)
    except ValueError:
        names = ", ".join(curve.value for curve in Curve)
        raise ParameterError(
            f"unknown curve {_brief(value)} (known: {names}, or a table of points)"
        ) from None


def _table(value: list[Any]) -> Table:
    points: list[tuple[float, float]] = []
    for point in value:
        pair = [_number(part) for part in point] if isinstance(point, list) else []
        if len(pair) != 2 or pair[0] is None or pair[1] is None:
            raise ParameterError(f"curve: expected points [from, to], got {_brief(point)}")
        if not 0.0 <= min(pair[0], pair[1]) <= max(pair[0], pair[1]) <= 1.0:
            raise ParameterError(f"curve: {_brief(point)} is not within 0 to 1")
        points.append((pair[0], pair[1]))
    ways = [way for way, _ in points]
    if len(ways) < 2 or (ways[0], ways[-1]) != (0.0, 1.0):
        raise ParameterError("curve: the points have to begin at 0 and end at 1")
    if any(later <= way for way, later in zip(ways, ways[1:], strict=False)):
        raise ParameterError("curve: each point has to lie beyond the one before it")
    if len(points) > MOST_POINTS:
        raise ParameterError(f"curve: {len(points)} points are more than {MOST_POINTS}")
    return Table(tuple(points))


def _smoothing(value: Any) -> float:
    number = _number(value)
    if number is None or not 0.0 <= number <= LONGEST_SMOOTHING_MS:
        raise ParameterError(
            f"smoothing: expected 0 to {LONGEST_SMOOTHING_MS:g} ms, got {_brief(value)}"
        )
    return number


def _channels(value: Any) -> tuple[int, ...]:
    numbers = value if isinstance(value, list) else [value]
    is_right = bool(numbers) and all(
        isinstance(number, int) and not isinstance(number, bool) and 1 <= number <= 16
        for number in numbers
    )
    if not is_right:
        raise ParameterError(f"channel: expected 1 to 16, or a list of such, got {_brief(value)}")
    return tuple(sorted(set(numbers)))


def _brief(value: Any) -> str:
    try:
        text = repr(value)
    except ValueError:  # a number of more digits than Python likes to print
        return "a very large number"
    return text if len(text) <= 80 else f"{text[:77]}..."
