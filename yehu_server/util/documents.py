"""Parse TOML and JSON of users, refusing values that are not safe to process and print."""

from __future__ import annotations

import json
import re
import tomllib
from typing import Any

MOST_DEPTH = 32
MOST_INTEGER_BITS = 8192  # Python prints no integers of more than 4,300 digits
# tomllib takes time by the square of a key's parts: 20 s for one of 64 kB.
MOST_KEY_PARTS = 16
_LONG_KEY = re.compile(
    r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+)"""
    f"{{{MOST_KEY_PARTS}}}",
    re.ASCII,
)


def parse_toml(text: str) -> dict[str, Any]:
    """Parse a TOML text.

    Raises
    ------
    ValueError
        With the line where that is known.
    """
    if _LONG_KEY.search(text):
        raise ValueError(f"a key has more than {MOST_KEY_PARTS} parts")
    try:
        return dict(_checked(tomllib.loads(text)))
    except RecursionError:
        raise ValueError("nested too deeply") from None


def parse_json(text: str) -> Any:
    """Parse a JSON text.

    Raises
    ------
    ValueError
        Where it is not JSON, or refused.
    """
    try:
        return _checked(json.loads(text))
    except RecursionError:
        raise ValueError("nested too deeply") from None


def _checked(value: Any) -> Any:
    """Refuse what Python parses but cannot print: deep nesting, and integers of many digits."""
    level = [value]
    for _ in range(MOST_DEPTH):
        inner: list[Any] = []
        for entry in level:
            if isinstance(entry, dict):
                inner += entry.values()
            elif isinstance(entry, list):
                inner += entry
            elif isinstance(entry, int) and entry.bit_length() > MOST_INTEGER_BITS:
                raise ValueError("a number has too many digits")
        if not inner:
            return value
        level = inner
    raise ValueError("nested too deeply")
