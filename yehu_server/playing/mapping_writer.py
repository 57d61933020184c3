"""Write mapping files in canonical form, keeping the comments of an older text."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT

from yehu_server.errors import MappingError
from yehu_server.params.table import find
from yehu_server.playing.bind import Bind, Breakpoints
from yehu_server.playing.mapping_file import MappingFile, read_mapping_file


def entries_of(bind: Bind) -> dict[str, Any]:
    """The entries of a bind, without those at their defaults."""
    is_default_curve = bind.curve is find(bind.target).curve
    entries: dict[str, Any] = {
        "source": bind.source,
        "target": bind.target,
        "input": None if bind.input_range == (0.0, 1.0) else list(map(_number, bind.input_range)),
        "span": None if bind.span is None else list(map(_number, bind.span)),
        "curve": None if is_default_curve else _curve(bind),
        "invert": bind.invert or None,
        "smoothing": _number(bind.smoothing_ms) or None,
        "channel": _channels(bind),
        "part": bind.part or None,
        "soft": bind.is_soft or None,
        "alone": bind.is_exclusive or None,
        "global": bind.is_global or None,
        "learned": bind.is_learned or None,
        "replaces": [entries_of(each) for each in bind.replaces] or None,
    }
    return {name: value for name, value in entries.items() if value is not None}


def as_toml(contents: MappingFile) -> str:
    """The text of a file with these contents, in canonical form."""
    document = tomlkit.document()
    has_mpe = contents.mpe or (contents.base is not None and contents.mpe is not None)
    entries = {
        "name": contents.name,
        "about": contents.about or None,
        "base": contents.base,
        "mpe": contents.mpe if has_mpe else None,
        "key_switches": contents.key_switches,
    }
    document.update({name: value for name, value in entries.items() if value is not None})
    if contents.start:
        document.add(tomlkit.nl())
        document["start"] = {address: _number(value) for address, value in contents.start}
    if contents.binds:
        binds = tomlkit.aot()
        binds.extend(map(_table, contents.binds))
        if not contents.start:
            document.add(tomlkit.nl())
        document["bind"] = binds
    return tomlkit.dumps(document).rstrip("\n") + "\n"


def canonical(contents: MappingFile, text: str) -> str:
    """Change the text of a file so that it has these contents in canonical form.

    Comments and order stay where possible; else the text is written from scratch.
    """
    try:
        document = tomlkit.parse(text)
        binds = document.get("bind", [])
        if (binds and not isinstance(binds, AoT)) or len(binds) != len(contents.binds):
            return as_toml(contents)
        if "name" not in document or document["name"] != contents.name:
            _set_name(document, contents.name)
        for table, bind in zip(binds, contents.binds, strict=True):
            for name, value in entries_of(bind).items():
                if name in table and table[name] != value:
                    table[name] = value
        changed = tomlkit.dumps(document)
        if read_mapping_file(Path(contents.name), changed) == contents:
            return changed
    except (TOMLKitError, MappingError, ValueError, RecursionError):
        pass
    return as_toml(contents)


def edited(contents: MappingFile, text: str, dropped: Sequence[Bind], added: Sequence[Bind]) -> str:
    """Remove some binds from the text of a file and append others.

    Comments and order stay where possible; else the text is written from scratch.
    """
    remaining = tuple(bind for bind in contents.binds if bind not in dropped)
    wanted = replace(contents, binds=(*remaining, *added))
    try:
        document = tomlkit.parse(text)
        if "bind" not in document:
            document.add(tomlkit.nl())
            document["bind"] = tomlkit.aot()
        binds = document["bind"]
        for index in reversed(range(len(contents.binds))):
            if contents.binds[index] in dropped:
                del binds[index]
        binds.extend(map(_table, added))
        if not binds:
            del document["bind"]
        changed = tomlkit.dumps(document)
        if read_mapping_file(Path(contents.name), changed) == wanted:
            return changed
    except (TOMLKitError, MappingError, ValueError, TypeError, RecursionError):
        pass
    return as_toml(wanted)


def _table(bind: Bind) -> Any:
    table = tomlkit.table()
    table.update(entries_of(bind))
    return table


def _set_name(document: tomlkit.TOMLDocument, name: str) -> None:
    if "name" in document:
        document["name"] = name
        return
    # First of all entries, after the comment at the head of the file.
    body = document.body
    index = next((at for at, (key, _) in enumerate(body) if key is not None), len(body))
    document._insert_at(index, "name", name)  # noqa: SLF001 - tomlkit has no public way to do it


def _number(value: float) -> int | float:
    return int(value) if value.is_integer() else value


def _curve(bind: Bind) -> Any:
    if isinstance(bind.curve, Breakpoints):
        return [list(map(_number, point)) for point in bind.curve.value]
    return bind.curve.value


def _channels(bind: Bind) -> int | list[int] | None:
    if not bind.channels:
        return None
    return bind.channels[0] if len(bind.channels) == 1 else list(bind.channels)
