"""The shipped mappings, presets and tunings, read and in one normal form, as the page has them."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import fields
from pathlib import Path
from typing import Any

from yehu_server.errors import ParameterError
from yehu_server.files import shipped_folder
from yehu_server.panel.parameters import camel
from yehu_server.params.preset import SAVED, Preset
from yehu_server.playing.binds import Bind
from yehu_server.playing.mapping import Mapping, load, shipped_mappings
from yehu_server.playing.presets import read_preset
from yehu_server.playing.tuning import EQUAL, Tuning, read_tuning


def mappings() -> dict[str, Any]:
    """The shipped mappings by name, each merged with its bases."""
    return {name: mapping(load(name)) for name in shipped_mappings()}


def mapping(one: Mapping) -> dict[str, Any]:
    """A mapping, without the files it was read from."""
    return {
        "name": one.name,
        "about": one.about,
        "mpe": one.mpe,
        "start": dict(one.start),
        "binds": [bind(each) for each in one.binds],
    }


def bind(one: Bind) -> dict[str, Any]:
    """A bind with all its settings; its curve is a name, or a list of points."""
    values = {camel(field.name): getattr(one, field.name) for field in fields(one)}
    return values | {
        "curve": one.curve.value,
        "span": None if one.span is None else list(one.span),
        "channels": list(one.channels),
        "inputRange": list(one.input_range),
    }


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
    """A tuning: the pitch of each key, as `Tuning` has them."""
    keys = None if one.keys is None else list(one.keys)
    return {"name": one.name, "keys": keys, "fixed": one.fixed}


def _name(scale: Path, keyboard: Path) -> str:
    return f"{scale.stem}, {keyboard.stem}"
