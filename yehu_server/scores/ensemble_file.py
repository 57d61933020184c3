"""Read an ensemble file: who plays which part of a score, on what, and where on the stage.

The format is described in docs/ensemble.md.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from yehu_server.core.engine.rig import MOST_PARTS
from yehu_server.errors import EnsembleError, ParameterError
from yehu_server.playing import mapping_entries as entries
from yehu_server.playing.mapping_file import FileErrors
from yehu_server.util.documents import parse_toml
from yehu_server.util.files import MAX_SETTINGS_BYTES, read_text

ENTRIES = ("about", "room", "part")
ROOM_ENTRIES = ("size", "decay", "damping", "level")
PART_ENTRIES = (
    "name", "channel", "track", "preset", "mapping", "instrument", "section", "seed", "pan",
    "distance", "gain", "set",
)  # fmt: skip
CHANNELS = 16
_LINE = re.compile(r"\(at line ([0-9]+)")

T = TypeVar("T")
Values = tuple[tuple[str, float], ...]  # addresses and values


@dataclass(frozen=True)
class PartEntry:
    """One ``[[part]]``; what it leaves out is None.

    Attributes
    ----------
    where : str
        File and line, for errors.
    channel : int, optional
        Counted from 0.
    track : int, optional
        Counted from 1.
    section : int, optional
        Number of people who play it.
    gain_db : float
        Over what it would be without this entry.
    """

    where: str
    name: str | None = None
    channel: int | None = None
    track: int | None = None
    preset: str | None = None
    mapping: str | None = None
    instrument: Path | None = None
    section: int | None = None
    seed: int | None = None
    pan: float | None = None
    distance: float | None = None
    gain_db: float = 0.0
    settings: Values = ()


@dataclass(frozen=True)
class EnsembleFile:
    """What an ensemble file says: its parts, and its room, by values or the name of a preset."""

    path: Path
    parts: tuple[PartEntry, ...]
    room: Values = ()
    room_name: str | None = None
    room_where: str = ""  # file and line, for errors


def read_ensemble(path: Path) -> EnsembleFile:
    """Read an ensemble file.

    Raises
    ------
    EnsembleError
        Naming file and line; its `more` are further errors.
    """
    try:
        text = read_text(path, MAX_SETTINGS_BYTES)
        data = parse_toml(text)
    except OSError as error:
        raise EnsembleError(f"{path}: {error.strerror}") from error
    except ValueError as error:  # not UTF-8, or not TOML
        found = _LINE.search(str(error))
        line = f":{found[1]}" if found else ""
        raise EnsembleError(f"{path}{line}: not an ensemble file ({error})") from error
    errors = FileErrors(path, text, EnsembleError)
    for name in data:
        if name not in ENTRIES:
            errors.add((name,), f"unknown entry {name!r} (known: {', '.join(ENTRIES)})")
    room = data.get("room", {})
    ensemble = EnsembleFile(
        path,
        parts=_parts(data.get("part"), path, errors),
        room=() if isinstance(room, str) else _room(room, errors),
        room_name=room if isinstance(room, str) else None,
        room_where=errors.where(("room",)),
    )
    errors.raise_all()
    return ensemble


def _room(table: Any, errors: FileErrors) -> Values:
    if not isinstance(table, dict):
        errors.add(("room",), "room: expected a table, or the name of a preset")
        return ()
    values = []
    for name, value in table.items():
        if name not in ROOM_ENTRIES:
            known = ", ".join(ROOM_ENTRIES)
            errors.add(("room", name), f"room: unknown entry {name!r} (known: {known})")
            continue
        try:
            values.append((f"/room/{name}", entries.start(f"/room/{name}", value)))
        except ParameterError as error:
            errors.add(("room", name), f"room: {error}")
    if table and "size" not in table:
        errors.add(("room",), "room: needs a size in metres")
    return tuple(values)


def _parts(tables: Any, path: Path, errors: FileErrors) -> tuple[PartEntry, ...]:
    if not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        errors.add(("part",), "write each part as [[part]]")
        return ()
    if not 1 <= len(tables) <= MOST_PARTS:
        key = ("part", MOST_PARTS)
        errors.add(key, f"{len(tables)} parts: a stage has room for 1 to {MOST_PARTS}")
        return ()
    return tuple(_part(table, index, path, errors) for index, table in enumerate(tables))


def _part(table: dict[str, Any], index: int, path: Path, errors: FileErrors) -> PartEntry:
    def add(name: str, reason: str) -> None:
        errors.add(("part", index, name), f"part {index + 1}: {reason}")

    def read(name: str, reader: Callable[[Any], T], default: T) -> T:
        if name not in table:
            return default
        try:
            return reader(table[name])
        except ParameterError as error:
            add(name, str(error))
            return default

    for name in table:
        if name not in PART_ENTRIES:
            add(name, f"unknown entry {name!r} (known: {', '.join(PART_ENTRIES)})")
    if "channel" not in table and "track" not in table:
        add("", "needs a channel or a track")
    instrument = read("instrument", entries.line_of_text("instrument"), None)
    mapping = read("mapping", entries.line_of_text("mapping"), None)
    preset = read("preset", entries.line_of_text("preset"), None)
    channel = read("channel", _whole("channel", 1, CHANNELS), None)
    return PartEntry(
        errors.where(("part", index)),
        name=read("name", entries.line_of_text("name"), None),
        channel=None if channel is None else channel - 1,
        track=read("track", _whole("track", 1, 65535), None),
        preset=_beside(path, preset),
        mapping=_beside(path, mapping),
        instrument=None if instrument is None else path.parent / instrument,
        section=read("section", _whole("section", 1, MOST_PARTS), None),
        seed=read("seed", _whole("seed", 0, 65535), None),
        pan=read("pan", lambda value: entries.start("/room/pan", value), None),
        distance=read("distance", lambda value: entries.start("/room/distance", value), None),
        gain_db=read("gain", lambda value: entries.start("/output/gain", value), 0.0),
        settings=_settings(table.get("set", {}), add),
    )


def _settings(table: Any, add: Callable[[str, str], None]) -> Values:
    if not isinstance(table, dict):
        add("set", "set: expected a table of addresses and values")
        return ()
    values = []
    for address, value in table.items():
        try:
            values.append((address, entries.start(address, value)))
        except ParameterError as error:
            add("set", f"set: {error}")
    return tuple(values)


def _whole(name: str, lo: int, hi: int) -> Callable[[Any], Any]:
    def read(value: Any) -> int:
        if type(value) is not int or not lo <= value <= hi:
            raise ParameterError(f"{name}: expected {lo} to {hi}, got {value!r:.40}")
        return value

    return read


def _beside(path: Path, name: str | None) -> str | None:
    """A name as it is; a file's path as from the folder of the ensemble file."""
    if name is None or not name.endswith((".toml", ".json")):
        return name
    return str(path.parent / name)
