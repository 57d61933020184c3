"""Writing mapping files in their canonical form, with the comments that were there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT

from yehu_server.errors import MappingError
from yehu_server.params.table import find
from yehu_server.playing.binds import Bind, Table
from yehu_server.playing.mapping_file import Sheet, sheet_of, toml_of


def entries_of(bind: Bind) -> dict[str, Any]:
    """The entries of a bind; those that go without saying are left out."""
    is_usual_curve = bind.curve is find(bind.target).curve
    entries: dict[str, Any] = {
        "source": bind.source,
        "target": bind.target,
        "input": None if bind.reach == (0.0, 1.0) else list(map(_number, bind.reach)),
        "span": None if bind.span is None else list(map(_number, bind.span)),
        "curve": None if is_usual_curve else _curve(bind),
        "invert": bind.invert or None,
        "smoothing": _number(bind.smoothing_ms) or None,
        "channel": _channels(bind),
        "soft": bind.is_soft or None,
        "alone": bind.is_alone or None,
        "global": bind.is_global or None,
    }
    return {name: value for name, value in entries.items() if value is not None}


def as_toml(sheet: Sheet) -> str:
    """A file that says this and nothing else."""
    document = tomlkit.document()
    document["name"] = sheet.name
    says_mpe = sheet.mpe or (sheet.base is not None and sheet.mpe is not None)
    for name, value in (("about", sheet.about or None), ("base", sheet.base)):
        if value is not None:
            document[name] = value
    if says_mpe:
        document["mpe"] = sheet.mpe
    if sheet.start:
        document.add(tomlkit.nl())
        document["start"] = {address: _number(value) for address, value in sheet.start}
    if sheet.binds:
        binds = tomlkit.aot()
        for bind in sheet.binds:
            table = tomlkit.table()
            table.update(entries_of(bind))
            binds.append(table)
        if not sheet.start:
            document.add(tomlkit.nl())
        document["bind"] = binds
    return tomlkit.dumps(document).rstrip("\n") + "\n"


def tidied(sheet: Sheet, text: str) -> str:
    """The text of a file, so changed that it says this in canonical form.

    Comments and order stay; where they cannot, the file is written anew.
    """
    try:
        document = tomlkit.parse(text)
        binds = document.get("bind", [])
        if (binds and not isinstance(binds, AoT)) or len(binds) != len(sheet.binds):
            return as_toml(sheet)
        if "name" not in document or document["name"] != sheet.name:
            _set_name(document, sheet.name)
        for table, bind in zip(binds, sheet.binds, strict=True):
            for name, value in entries_of(bind).items():
                if name in table and table[name] != value:
                    table[name] = value
        changed = tomlkit.dumps(document)
        path = Path(sheet.name)
        if sheet_of(path, toml_of(path, changed)) == sheet:
            return changed
    except (TOMLKitError, MappingError, ValueError, RecursionError):
        pass
    return as_toml(sheet)


def rebound(sheet: Sheet, text: str, dropped: Sequence[Bind], added: Sequence[Bind]) -> str:
    """The text of a file without some of its binds, and with others at its end.

    Comments and order stay; where they cannot, the file is written anew.
    """
    kept = tuple(bind for bind in sheet.binds if bind not in dropped)
    wanted = replace(sheet, binds=(*kept, *added))
    try:
        document = tomlkit.parse(text)
        if "bind" not in document:
            document.add(tomlkit.nl())
            document["bind"] = tomlkit.aot()
        binds = document["bind"]
        for place in reversed(range(len(sheet.binds))):
            if sheet.binds[place] in dropped:
                del binds[place]
        for bind in added:
            table = tomlkit.table()
            table.update(entries_of(bind))
            binds.append(table)
        if not binds:
            del document["bind"]
        changed = tomlkit.dumps(document)
        path = Path(sheet.name)
        if sheet_of(path, toml_of(path, changed)) == wanted:
            return changed
    except (TOMLKitError, MappingError, ValueError, TypeError, RecursionError):
        pass
    return as_toml(wanted)


def _set_name(document: tomlkit.TOMLDocument, name: str) -> None:
    if "name" in document:
        document["name"] = name
        return
    # Before everything but the comment that a file begins with.
    body = document.body
    place = next((at for at, (key, _) in enumerate(body) if key is not None), len(body))
    document._insert_at(place, "name", name)  # noqa: SLF001 - no other way to begin with it


def _number(value: float) -> int | float:
    return int(value) if value.is_integer() else value


def _curve(bind: Bind) -> Any:
    if isinstance(bind.curve, Table):
        return [list(map(_number, point)) for point in bind.curve.value]
    return bind.curve.value


def _channels(bind: Bind) -> int | list[int] | None:
    if not bind.channels:
        return None
    return bind.channels[0] if len(bind.channels) == 1 else list(bind.channels)
