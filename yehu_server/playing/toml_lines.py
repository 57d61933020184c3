"""On which line of a TOML file each entry stands, which tomllib does not tell.

The text is cut into statements: headers and ``key = value``, each up to the first end of
line that is in no string and no bracket. Their keys are read by tomllib itself.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from typing import Any

# From the top table down: names, and places in arrays of tables counted from 0.
Way = tuple[str | int, ...]

_PIECE = re.compile(
    r'"""(?:[^\\]|\\.)*?"{3,5}'
    r"|'''.*?'{3,5}"
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'[^'\n]*'"
    r"|\#[^\n]*"
    r"|[\[{]|[\]}]|\n|=|[^\"'\#\[\]{}\n=]+",
    re.DOTALL,
)


def lines_of(text: str) -> dict[Way, int]:
    """The line of each entry and each table of a text that tomllib reads, counted from 1.

    Entries within inline tables and arrays are not told apart from what holds them.
    """
    lines: dict[Way, int] = {}
    counts: dict[Way, int] = {}
    table: Way = ()
    for line, left, has_value in _statements(text):
        try:
            inner = tomllib.loads(f"{left} = 0" if has_value else left)
        except (ValueError, RecursionError):
            return {}  # rather no line than a wrong one
        names, is_array = _names(inner)
        way = _within(names[:-1], counts) if not has_value else ()
        if has_value:
            way = (*table, *names)
        elif is_array:
            place = (*way, names[-1])
            counts[place] = counts.get(place, -1) + 1
            table = way = (*place, counts[place])
        else:
            table = way = (*way, names[-1])
        for depth in range(len(way), 0, -1):
            lines.setdefault(way[:depth], line)
    return lines


def line_at(lines: dict[Way, int], way: Way) -> int | None:
    """The line of an entry, or of the nearest table around it that has one."""
    for depth in range(len(way), 0, -1):
        if way[:depth] in lines:
            return lines[way[:depth]]
    return None


def _statements(text: str) -> Iterator[tuple[int, str, bool]]:
    """Line, key or header, and whether a value follows, of each statement."""
    line = began = 1
    left, depth, has_value = "", 0, False
    for found in _PIECE.finditer(text + "\n"):
        piece = found[0]
        if piece == "\n" and (depth == 0 or not has_value):
            if left.strip():
                yield began, left.strip(), has_value
            left, depth, has_value = "", 0, False
        elif piece == "=" and not has_value:
            has_value = True
        elif not has_value and not piece.startswith("#"):
            if not left.strip():
                began = line
            left += piece
        elif piece in "[{":
            depth += 1
        elif piece in "]}":
            depth -= 1
        line += piece.count("\n")


def _names(inner: dict[str, Any]) -> tuple[tuple[str, ...], bool]:
    """The names of a key or header, and whether it is one of an array of tables."""
    names: tuple[str, ...] = ()
    value: Any = inner
    while isinstance(value, dict) and value:
        ((name, value),) = value.items()
        names = (*names, name)
    return names, isinstance(value, list)


def _within(names: tuple[str, ...], counts: dict[Way, int]) -> Way:
    """The way to a table by the names of its header: of an array it is the latest one."""
    way: Way = ()
    for name in names:
        way = (*way, name)
        if way in counts:
            way = (*way, counts[way])
    return way
