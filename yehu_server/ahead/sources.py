"""The hash of all that a build is made from, which tells whether it is of the present sources."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from yehu_server.code_key import key_of
from yehu_server.jit import source_hash


@cache
def sources_hash() -> str:
    """Hash of the sources, calibrations and practice that builds are made from (16 hex digits)."""
    package = Path(__file__).parents[1]
    learnt = [
        (package / "playing" / name).read_text(encoding="utf-8")
        for name in ("calibrations.json", "practices.json")
    ]
    return key_of(sorted(Path(__file__).parent.glob("*.py")), source_hash(), *learnt)
