"""The shipped mappings, presets and tunings, read and in one normal form, as the page has them."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.files import shipped_folder
from yehu_server.midi.tables import MOST_BINDS, TABLES
from yehu_server.params.preset import SAVED, Preset
from yehu_server.playing.binds import Bind
from yehu_server.playing.mapping import Mapping, load, shipped_mappings
from yehu_server.playing.presets import read_preset
from yehu_server.playing.range_policy import RangePolicy
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, KEYS, STANDARD_A4, Tuning, read_tuning

# What a table has of each bind, but for what the page finds itself, as it learns binds over a
# mapping, and for what is of named controls: nothing moves those of a page.
FOUND = {"first", "target", "same", "input_lo", "input_hi"}
OF_BIND = [
    name for name in TABLES.names or () if TABLES[name].shape == (MOST_BINDS,) and name not in FOUND
]


def mappings() -> dict[str, Any]:
    """The shipped mappings by name, each merged with its bases."""
    return {name: mapping(load(name)) for name in shipped_mappings()}


def mapping(one: Mapping) -> dict[str, Any]:
    """A mapping, without the files it was read from; binds and points as tables have them."""
    t = make_tables(one, Controls(), tuning=EQUAL, a4=STANDARD_A4, policy=RangePolicy.TRANSPOSE)[0]
    points = int(t["points"].sum())
    return {
        "name": one.name,
        "about": one.about,
        "mpe": one.mpe,
        "start": dict(one.start),
        "x": t["x"][:points].tolist(),
        "y": t["y"][:points].tolist(),
        "binds": [bind(each, t, number) for number, each in enumerate(one.binds)],
    }


def bind(one: Bind, table: Any, number: int) -> dict[str, Any]:
    """A bind: whom it overrides, and its row of the table, without what is 0."""
    row = {name: plain(table[name][number]) for name in OF_BIND if table[name][number]}
    channels = {"channels": list(one.channels)} if one.channels else {}
    return {"source": one.source, "target": one.target, **channels, "row": row}


def plain(number: float) -> float | int:
    """A number as JSON has it, whole ones without a fraction."""
    return int(number) if number == int(number) else float(number)


def presets() -> dict[str, Any]:
    """The shipped presets by name, in the order of their names; and what a preset keeps."""
    files = sorted(shipped_folder("presets").glob("*.toml"))
    found = map(read_preset, files)
    return {"shipped": {each.name: preset(each) for each in found}, "saved": list(SAVED)}


def preset(one: Preset) -> dict[str, Any]:
    """A preset."""
    return {
        "name": one.name,
        "about": one.about,
        "program": one.program,
        "values": dict(one.values),
    }


def tunings() -> dict[str, Any]:
    """Equal temperament, and the shipped scales: each by itself and on each map that takes it."""
    folder = shipped_folder("tunings")
    scales, maps = (sorted(folder.glob(ending)) for ending in ("*.scl", "*.kbm"))
    found = {"equal": tuning(EQUAL)}
    for scale in scales:
        found[scale.stem] = tuning(read_tuning(scale))
        for keyboard in maps:
            with suppress(ParameterError):  # the scale is not one for this map
                found[_name(scale, keyboard)] = tuning(read_tuning(scale, keyboard))
    return found


def tuning(one: Tuning) -> dict[str, Any]:
    """A tuning: the pitch of each key at the usual A4, or None where each sounds its own number."""
    keys = None if one.keys is None else [one.pitch(float(key), STANDARD_A4) for key in KEYS]
    return {"name": one.name, "keys": keys}


def _name(scale: Path, keyboard: Path) -> str:
    return f"{scale.stem}, {keyboard.stem}"
