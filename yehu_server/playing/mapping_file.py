"""Read one mapping file: its contents, or all errors in it with their lines.

The format is described in mappings/README.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from yehu_server.core.midi.tables import MOST_BINDS
from yehu_server.core.player.fingering import LOWEST_NOTE
from yehu_server.errors import MappingError
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.spec import Curve, Param
from yehu_server.playing import mapping_values as entries
from yehu_server.playing import sources
from yehu_server.playing.bind import Bind, Breakpoints
from yehu_server.util.documents import MOST_ERRORS, Document, Fields
from yehu_server.util.values import flag, line, number, whole

MOST_BYTES = 1 << 17  # one that is watched is parsed beside the playing


@dataclass(frozen=True)
class MappingFile:
    """The contents of one file, without its base; `mpe` is None where it is not given."""

    name: str
    binds: tuple[Bind, ...] = ()
    start: tuple[tuple[str, float], ...] = ()
    base: str | None = None
    mpe: bool | None = None
    key_switches: int | None = None
    about: str = ""


def document_of(path: Path, text: str = "") -> Document:
    """A mapping file, whose text is known or will be read."""
    return Document(path, "a mapping file", MappingError, text=text, most_errors=MOST_ERRORS)


def text_of(path: Path) -> str:
    """The text of a file; raises MappingError where it cannot be read or is not UTF-8."""
    return document_of(path).read(path, MOST_BYTES).text


def read_mapping_file(path: Path, text: str | None = None) -> MappingFile:
    """Read a TOML file, or the text of one; raises MappingError, naming file and line."""
    return mapping_file_from(document_of(path, text_of(path) if text is None else text).toml())


def mapping_file_of_json(path: Path, text: str) -> MappingFile:
    """Read what ``yehu-server mappings show --json`` prints.

    Raises MappingError where it is wrong.
    """
    table = document_of(path, text).json()
    data = _without_null(table.data)
    binds = data.get("bind", [])
    if isinstance(binds, list):
        data["bind"] = _binds_of_json(binds)
        for bind in data["bind"]:
            if isinstance(bind, dict) and isinstance(bind.get("replaces"), list):
                bind["replaces"] = _binds_of_json(bind["replaces"])
    return mapping_file_from(Fields(data, table.document))


def _binds_of_json(binds: list[Any]) -> list[Any]:
    return [_of_json(bind) if isinstance(bind, dict) else bind for bind in binds]


def _of_json(entry: dict[str, Any]) -> dict[str, Any]:
    ends = [entry.pop(name, None) for name in ("from", "to")]
    # Older versions printed no span beside them; both are null for the bend range.
    if "span" not in entry and ends != [None, None]:
        entry["span"] = ends
    return _without_null(entry)


def _without_null(table: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in table.items() if value is not None}


# ---------------------------------------------------------------- entries


def mapping_file_from(table: Fields) -> MappingFile:
    """Check and convert the entries of a file; raises MappingError, naming file and line."""
    mapping_file = MappingFile(
        name=table.read("name", line, Path(table.document.name).stem),
        about=table.read("about", line, ""),
        base=table.read("base", line, None),
        mpe=table.read("mpe", flag, None),
        key_switches=table.read("key_switches", _switches, None),
        start=entries.settings(table.table("start")),
        binds=tuple(filter(None, map(_bind, table.tables("bind", 0, MOST_BINDS)))),
    )
    table.only()
    table.document.finish()
    return mapping_file


def _switches(value: Any) -> int:
    """The lowest key switch: all of them lie below the notes that are played as they are."""
    return whole(value, 0, LOWEST_NOTE - len(ARTICULATIONS))


def _bind(table: Fields, *, may_replace: bool = True) -> Bind | None:
    source = table.read("source", lambda value: sources.canonical(line(value)), None)
    param: Param | None = table.read(
        "target", lambda value: entries.settable_param(line(value), "map to one"), None
    )
    curve: Curve | Breakpoints | None = table.read("curve", entries.curve, None)
    span = table.read("span", entries.span, None, param)
    bind = Bind(
        source or "",
        param.address if param else "",
        span=span if param else None,
        curve=curve or (param.curve if param else Curve.LIN),
        invert=table.read("invert", flag, False),
        smoothing_ms=table.read("smoothing", number, 0.0, 0.0, entries.LONGEST_SMOOTHING_MS, "ms"),
        channels=table.read("channel", entries.channels, ()),
        is_soft=table.read("soft", flag, False),
        input_range=table.read("input", entries.input_range, (0.0, 1.0)),
        is_exclusive=table.read("alone", flag, False),
        is_global=table.read("global", flag, False),
        replaces=_replaced(table) if may_replace else (),
    )
    table.only()
    if not {"source", "target"} <= table.data.keys():
        table.wrong("", "needs a source and a target")
    if source is None or param is None:
        return None
    for name, reason in _conflicts(bind, table.data):
        table.wrong(name, reason)
    return bind


def _replaced(table: Fields) -> tuple[Bind, ...]:
    found = (_bind(each, may_replace=False) for each in table.tables("replaces"))
    return tuple(bind for bind in found if bind)


def _conflicts(bind: Bind, entry: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Entries of a bind that exclude each other, and why."""
    found = []
    if bind.curve is Curve.EXP and min(bind.ends) <= 0.0:
        found.append(("curve", "an exp curve needs a span above zero"))
    if sources.is_address(bind.source):
        if "channel" in entry:
            found.append(("channel", "an OSC address has no channel"))
        if bind.is_global:
            found.append(("global", "an OSC address always is global"))
    elif "input" in entry:
        found.append(("input", "only OSC addresses have an input range"))
    if bind.is_soft and (bind.source in sources.OF_ONE_NOTE or bind.is_by_range):
        what = "the bend by the bend range" if bind.is_by_range else bind.source
        found.append(("soft", f"{what} cannot wait for the target"))
    if bind.is_global and bind.source in sources.OF_ONE_NOTE:
        found.append(("global", f"{bind.source} belongs to one note"))
    return found
