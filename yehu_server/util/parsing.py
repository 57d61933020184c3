"""Parse TOML and JSON, and refuse what is not safe to process or print."""

import json
import re
import tomllib
from collections.abc import Iterator
from typing import Any

from yehu_server.util.values import brief

MAX_DEPTH = 32
MAX_INTEGER_BITS = 8192  # Python prints no integers of more than 4,300 digits
# tomllib takes time by the square of a key's parts: 20 s for one of 64 kB.
MAX_KEY_PARTS = 16
_LONG_KEY = re.compile(
    r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)"""
    f"{{{MAX_KEY_PARTS}}}",
    re.ASCII,
)

# From the root table down: names, and indices in arrays of tables, from 0.
KeyPath = tuple[str | int, ...]

_PIECE = re.compile(
    r'"""(?:[^\\]|\\.)*?"{3,5}'
    r"|'''.*?'{3,5}"
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'[^'\n]*'"
    r"|\#[^\n]*"
    r"|[\[{]|[\]}]|\n|=|[^\"'\#\[\]{}\n=]+",
    re.DOTALL,
)


# What tomllib complains of, by words of it that all Pythons have, in our words.
_TOML_ERRORS = {
    r"Invalid (statement|initial)": "expected NAME = VALUE or [TABLE]; names with / are quoted",
    r"Expected '='": "expected = after the name",
    r"Invalid (value|date)": "expected a value; text is quoted",
    r"Invalid|Unescaped|Escaped": r"a backslash in text is written \\",
    r"Expected newline": "expected the end of the line after the value",
    r"Cannot|Duplicate": "this name is there already",
    r"Unclosed array": "expected , or ]",
    r"Unclosed inline": "expected , or }",
    r"Expected '\]": "expected ] after the name of a table",
    r"(Illegal|Found invalid) character '(?!\\n)": "expected no control character",
    r"": "text without its closing quotation mark",
}
_LINE = re.compile(r"\bline ([0-9]+)")


class ParsingError(ValueError):
    """What is wrong with a text, and in which line (from 1)."""

    def __init__(self, reason: str, line: int) -> None:
        super().__init__(reason)
        self.line = line


def parse_toml(text: str) -> dict[str, Any]:
    """Parse a TOML text; raises ValueError, ParsingError where the line is known."""
    if _LONG_KEY.search(text):
        raise ValueError(f"a key has more than {MAX_KEY_PARTS} parts")
    try:
        return dict(_checked(tomllib.loads(text)))
    except tomllib.TOMLDecodeError as error:
        found = _LINE.search(str(error))
        lines = text.rstrip().split("\n")
        line = min(int(found[1]) if found else len(lines), len(lines))
        reason = next(ours for theirs, ours in _TOML_ERRORS.items() if re.match(theirs, str(error)))
        raise ParsingError(f"{reason}, got {brief(lines[line - 1].strip())}", line) from None
    except RecursionError:
        raise ValueError("nested too deeply") from None


def parse_json(text: str) -> Any:
    """Parse a JSON text; raises ParsingError where it is not JSON, ValueError where refused."""
    try:
        return _checked(json.loads(text))
    except json.JSONDecodeError as error:  # its words are of Python
        raise ParsingError(f"no JSON from column {error.colno} on", error.lineno) from None
    except RecursionError:
        raise ValueError("nested too deeply") from None


def _checked(value: Any) -> Any:
    """Refuse what Python parses but cannot print: deep nesting, and integers of many digits."""
    level = [value]
    for _ in range(MAX_DEPTH):
        inner: list[Any] = []
        for entry in level:
            if isinstance(entry, dict):
                inner += entry.values()
            elif isinstance(entry, list):
                inner += entry
            elif isinstance(entry, int) and entry.bit_length() > MAX_INTEGER_BITS:
                raise ValueError("a number has too many digits")
        if not inner:
            return value
        level = inner
    raise ValueError("nested too deeply")


# ---------------------------------------------------------------- lines


def lines_of(text: str) -> dict[KeyPath, int]:
    """The line, from 1, of each entry and each table of a text that tomllib parses.

    The text is cut into statements: headers and ``key = value``, each up to the first end of line
    that is in no string and no bracket. tomllib, which gives no lines, parses their keys.

    Entries within inline tables and arrays have no line of their own.
    """
    lines: dict[KeyPath, int] = {}
    counts: dict[KeyPath, int] = {}
    table: KeyPath = ()
    for line, left, has_value in _statements(text):
        try:
            inner = tomllib.loads(f"{left} = 0" if has_value else left)
        except (ValueError, RecursionError):
            return {}  # rather no line than a wrong one
        names, is_array = _names(inner)
        path = _resolved(names[:-1], counts) if not has_value else ()
        if has_value:
            path = (*table, *names)
        elif is_array:
            array = (*path, names[-1])
            counts[array] = counts.get(array, -1) + 1
            table = path = (*array, counts[array])
        else:
            table = path = (*path, names[-1])
        for depth in range(len(path), 0, -1):
            lines.setdefault(path[:depth], line)
    return lines


def line_at(lines: dict[KeyPath, int], path: KeyPath) -> int | None:
    """The line of an entry, or of the innermost table around it that has one."""
    for depth in range(len(path), 0, -1):
        if path[:depth] in lines:
            return lines[path[:depth]]
    return None


def _statements(text: str) -> Iterator[tuple[int, str, bool]]:
    """Yield the line of each statement, its key or header, and whether a value follows."""
    line = first_line = 1
    left, depth, has_value = "", 0, False
    for found in _PIECE.finditer(text + "\n"):
        piece = found[0]
        if piece == "\n" and (depth == 0 or not has_value):
            if left.strip():
                yield first_line, left.strip(), has_value
            left, depth, has_value = "", 0, False
        elif piece == "=" and not has_value:
            has_value = True
        elif not has_value and not piece.startswith("#"):
            if not left.strip():
                first_line = line
            left += piece
        elif piece in "[{":
            depth += 1
        elif piece in "]}":
            depth -= 1
        line += piece.count("\n")


def _names(inner: dict[str, Any]) -> tuple[tuple[str, ...], bool]:
    """The names of a key or header, and whether it begins an element of an array of tables."""
    names: tuple[str, ...] = ()
    value: Any = inner
    while isinstance(value, dict) and value:
        ((name, value),) = value.items()
        names = (*names, name)
    return names, isinstance(value, list)


def _resolved(names: tuple[str, ...], counts: dict[KeyPath, int]) -> KeyPath:
    """The key path of a table named in a header: of an array, its latest element."""
    path: KeyPath = ()
    for name in names:
        path = (*path, name)
        if path in counts:
            path = (*path, counts[path])
    return path
