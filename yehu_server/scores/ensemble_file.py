"""Read an ensemble file: players of a score's parts and their places (docs/ensemble.md)."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from yehu_server.core.engine.rig import MAX_PARTS
from yehu_server.errors import EnsembleError
from yehu_server.params.table import find
from yehu_server.playing.mapping_file import read_settings
from yehu_server.playing.sources import CHANNELS
from yehu_server.util.documents import MAX_ERRORS, Document, Fields
from yehu_server.util.values import line, whole

ROOM_ENTRIES = ("size", "decay", "damping", "level")

Values = tuple[tuple[str, float], ...]  # addresses and values


@dataclass(frozen=True)
class PartEntry:
    """One ``[[part]]``; what it leaves out is None."""

    where: str  # file and line, for errors
    name: str | None = None
    channel: int | None = None  # counted from 0
    track: int | None = None  # counted from 1
    preset: str | None = None
    mapping: str | None = None
    instrument: Path | None = None
    section: int | None = None  # number of its players
    seed: int | None = None
    pan: float | None = None
    distance: float | None = None
    gain_db: float = 0.0  # over what it would be without this entry
    settings: Values = ()


@dataclass(frozen=True)
class EnsembleFile:
    """An ensemble file: its parts, and its room, by values or the name of a preset."""

    path: Path
    parts: tuple[PartEntry, ...]
    room: Values = ()
    room_name: str | None = None
    room_where: str = ""  # file and line, for errors


def read_ensemble(path: Path) -> EnsembleFile:
    """Read an ensemble file. Raises EnsembleError, all errors with file and line."""
    document = Document(path, "an ensemble file", EnsembleError, most_errors=MAX_ERRORS)
    table = document.read(path).toml()
    table.read("about", str, "")
    room = table.data.get("room", {})
    ensemble = EnsembleFile(
        path,
        parts=tuple(_part(part, path.parent) for part in table.tables("part", 1, MAX_PARTS)),
        room=() if isinstance(room, str) else _room(table.table("room")),
        room_name=room if isinstance(room, str) else None,
        room_where=document.where(("room",)),
    )
    table.refuse_others("room")
    document.raise_errors()
    return ensemble


def _room(table: Fields) -> Values:
    values = [
        (f"/room/{name}", table.read(name, find(f"/room/{name}").within, 0.0))
        for name in ROOM_ENTRIES
        if name in table.data
    ]
    table.refuse_others(*ROOM_ENTRIES)
    if table.data and "size" not in table.data:
        table.add_error("", "needs a size in metres")
    return tuple(values)


def _part(table: Fields, folder: Path) -> PartEntry:
    if not {"channel", "track"} & table.data.keys():
        table.add_error("", "needs a channel or a track")
    channel = table.read("channel", whole, None, 1, CHANNELS)
    part = PartEntry(
        table.where(),
        name=table.read("name", line, None),
        channel=None if channel is None else channel - 1,
        track=table.read("track", whole, None, 1, 65535),
        preset=table.read("preset", _beside, None, folder),
        mapping=table.read("mapping", _beside, None, folder),
        instrument=table.read("instrument", lambda value: folder / line(value), None),
        section=table.read("section", whole, None, 1, MAX_PARTS),
        seed=table.read("seed", whole, None, 0, 65535),
        pan=table.read("pan", find("/room/pan").within, None),
        distance=table.read("distance", find("/room/distance").within, None),
        gain_db=table.read("gain", find("/output/gain").within, 0.0),
        settings=read_settings(table.table("set")),
    )
    table.refuse_others()
    return part


def _beside(value: Any, folder: Path) -> str:
    """A name as it is; a file's path as from the folder of the ensemble file."""
    name = line(value)
    return str(folder / name) if name.endswith((".toml", ".json")) else name
