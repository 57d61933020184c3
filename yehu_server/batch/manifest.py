"""The manifest of a folder of results: a line of JSON for each of its scores, or sounds."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from yehu_server.errors import OutputError
from yehu_server.files import read_lines, write_text

NAME = "manifest.jsonl"
MOST_BYTES = 2**30


def line_of(fields: Mapping[str, Any]) -> str:
    """A line of the manifest, without its end."""
    return json.dumps(fields)


def write_manifest(folder: Path, lines: Iterable[Mapping[str, Any]], order: str = "file") -> None:
    """Write the manifest, in the order of the names, or of another entry.

    Raises
    ------
    OutputError
        Where it cannot be written.
    """
    ordered = sorted(lines, key=lambda line: line[order])
    write_text(folder / NAME, "".join(f"{line_of(line)}\n" for line in ordered))


def check_manifest(folder: Path) -> None:
    """Check that the manifest may be written.

    Raises
    ------
    OutputError
        Where a file of its name is none.
    """
    path = folder / NAME
    try:
        first = next(read_lines(path, MOST_BYTES), "")
        fields = json.loads(first) if first else {"file": ""}
        if "file" in fields and isinstance(fields, dict):
            return
    except FileNotFoundError:
        return
    except (OSError, ValueError, RecursionError, TypeError):
        pass
    raise OutputError(f"{path}: is no manifest of yehu-server; move it away")
