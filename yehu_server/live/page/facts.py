"""The constants and tables that the page needs, generated from those of the server."""

import json
from collections.abc import Mapping
from dataclasses import fields
from enum import Enum
from pathlib import Path
from typing import Any

from yehu_server.ahead.build import RATES
from yehu_server.ahead.build_hash import build_hash
from yehu_server.ahead.interpreter import interpreter_layout, snapshot_layout, snapshot_length
from yehu_server.core.midi import registered_parameters, tables
from yehu_server.core.midi.events import EVENTS
from yehu_server.core.midi.tables import MAX_BINDS, TABLES
from yehu_server.core.player import fingering, gestures, harmonics, vibrato
from yehu_server.core.player.commands import KINDS
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.live.page.examples import examples
from yehu_server.live.page.guests import is_owner_only
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.preset_file import SAVED, Preset
from yehu_server.params.spec import Param
from yehu_server.params.table import SLOT, TABLE
from yehu_server.playing import learner, sources
from yehu_server.playing.bind import CURVES, Bind
from yehu_server.playing.mapping import DEFAULT, load, shipped_mappings
from yehu_server.playing.mapping import Mapping as ControllerMapping
from yehu_server.playing.options import AS_IT_SINGS
from yehu_server.playing.part_state import ELSEWHERE
from yehu_server.playing.pitch_and_level import NOTE_NAMES
from yehu_server.playing.preset_folders import read_preset
from yehu_server.playing.tables import WORDS, Controls, make_tables
from yehu_server.playing.tuning import (
    EQUAL,
    KEYS,
    STANDARD_A4,
    RangePolicy,
    Tuning,
    shipped_tunings,
)
from yehu_server.util.files import shipped_folder, write_text


def parameter(param: Param) -> dict[str, Any]:
    """One row: its fields, and its numbers in the player (`index`) and in the engine (`slot`)."""
    own = {field.name: getattr(param, field.name) for field in fields(param)}
    own = {camel(name): v.value if isinstance(v, Enum) else v for name, v in own.items()}
    group, *words = param.address.split("/")[1:]
    return own | {
        "group": group,
        "label": " ".join(words).replace("_", " "),
        "index": INDEX[param.address],
        "slot": SLOT.get(param.address),
        "isOwnerOnly": is_owner_only(param),
    }


def camel(name: str) -> str:
    """A name as JavaScript writes it: ``smooth_ms`` becomes ``smoothMs``."""
    first, *rest = name.split("_")
    return first + "".join(word.capitalize() for word in rest)


# What a table has of each bind, but for what the page finds itself, as it learns binds over a
# mapping, and for what is of named controls: nothing moves those of a page.
FOUND = {"first", "target", "same", "input_lo", "input_hi"}
OF_BIND = [
    name for name in TABLES.names or () if TABLES[name].shape == (MAX_BINDS,) and name not in FOUND
]


def mapping(one: ControllerMapping) -> dict[str, Any]:
    """A mapping, without the files it was read from; binds and points as tables have them."""
    t = make_tables(one, Controls(), tuning=EQUAL, a4=STANDARD_A4, policy=RangePolicy.TRANSPOSE)[0]
    points = int(t["points"].sum())
    return {
        "name": one.name,
        "about": one.about,
        "mpe": one.mpe,
        "keySwitches": one.key_switches,
        "start": dict(one.start),
        "x": t["x"][:points].tolist(),
        "y": t["y"][:points].tolist(),
        "binds": [bind(each, t, number) for number, each in enumerate(one.binds)],
    }


def bind(one: Bind, table: Any, number: int) -> dict[str, Any]:
    """A bind: whom it overrides, and its row of the table, without what is 0."""
    found = {name: float(table[name][number]) for name in OF_BIND if table[name][number]}
    row = {name: int(v) if v.is_integer() else v for name, v in found.items()}
    channels = {"channels": list(one.channels)} if one.channels else {}
    return {"source": one.source, "target": one.target, **channels, "row": row}


def preset(one: Preset) -> dict[str, Any]:
    """What the page has of a preset."""
    names = ("name", "about", "program")
    return {**{name: getattr(one, name) for name in names}, "values": dict(one.values)}


def tuning(one: Tuning) -> dict[str, Any]:
    """A tuning: the pitch of each key at the usual A4, or None where each sounds its own number."""
    keys = None if one.keys is None else [one.pitch(float(key), STANDARD_A4) for key in KEYS]
    return {"name": one.name, "keys": keys}


HEAD = "// Written by `python -m yehu_server.live.page`; changes are lost.\n"


def facts(notes: NoteRange = YEHU) -> dict[str, Any]:
    """All facts, of JSON's types; the same for the same sources.

    `notes` are those of the server's instrument, if there is one.
    """
    shipped = map(read_preset, sorted(shipped_folder("presets").glob("*.toml")))
    return {
        "kinds": {name.upper(): number for number, name in enumerate(KINDS)},
        "events": {name.upper(): number for number, name in enumerate(EVENTS, len(KINDS))},
        "parameters": [parameter(param) for param in TABLE],
        "notes": {
            "NAMES": list(NOTE_NAMES),
            "OPEN": list(map(float, notes.open_notes)),
            "LOWEST_NOTE": notes.lowest,
            "HIGHEST_NOTE": notes.highest,
            "OPEN_WITHIN": fingering.OPEN_WITHIN,
            "HIGHEST": list(map(float, notes.highest_notes)),
            "SLOW_FROM_S": vibrato.SLOW_FROM_S,
            "LEAST_PRESS": vibrato.LEAST_PRESS,
            "NODES": harmonics.NODES[:, : harmonics.PARTS].tolist(),
            "KEYS": KEYS[-1] + 1,
            "ELSEWHERE": ELSEWHERE,
        },
        # Whether a page that sounds by itself, as a yehu, has the server's notes.
        "isYehu": (notes.open_notes, notes.highest) == (YEHU.open_notes, YEHU.highest),
        "sources": {
            "BEND": sources.BEND,
            "OF_ONE_NOTE": sorted(sources.OF_ONE_NOTE),
            "COARSE": [sources.COARSE[0], sources.COARSE[-1]],
            "FINE_ABOVE": sources.FINE_ABOVE,
            "STEPS": sources.STEPS,
            "FINEST": sources.FINEST,
            "CHANNELS": sources.CHANNELS,
            "RESERVED": sorted(sources.RESERVED),
            "NO_NRPN": sources.NO_NRPN,
            "DATA_ENTRY": registered_parameters.DATA_ENTRY,
            "NRPN": [registered_parameters.NRPN_COARSE, registered_parameters.NRPN_FINE],
            "RPN": [registered_parameters.RPN_COARSE, registered_parameters.RPN_FINE],
        },
        "codes": {**WORDS, "PAIR": tables.PAIR, "NRPN": tables.NRPN},
        "curves": {curve.value: code for curve, code in CURVES.items()},
        "learner": {"DISTANCE": learner.DISTANCE, "AT_REST": dict(learner.AT_REST)},
        "interpreter": interpreter_layout(),
        "mappings": {name: mapping(load(name)) for name in shipped_mappings()},
        "defaultMapping": DEFAULT,
        "articulations": [
            {
                "name": row.name,
                "chinese": row.chinese,
                "shakes": row.vibrato and row.vibrato.cents > 0.0,
                "isPlucked": row.is_plucked,
                "beats": bool(gestures.BEATS[number]),
                "reach": gestures.REACH[number].tolist(),
                "touches": row.touches,
            }
            for number, row in enumerate(ARTICULATIONS)
        ],
        "asItSings": AS_IT_SINGS,
        "presets": {"shipped": {one.name: preset(one) for one in shipped}, "saved": list(SAVED)},
        "tunings": {name: tuning(one) for name, one in shipped_tunings().items()},
        "snapshot": snapshot_layout(),
        "snapshotLength": snapshot_length(),
        "rates": list(RATES),
        "builtFrom": build_hash(),
    }


def module(values: Mapping[str, Any]) -> str:
    """The text of a JavaScript module that exports values of JSON's types, a line for each."""
    lines = [
        f"  {json.dumps(name)}: {json.dumps(value, separators=(',', ':'), allow_nan=False)},\n"
        for name, value in values.items()
    ]
    return f"{HEAD}export default {{\n{''.join(lines)}}};\n"


def write(folder: Path) -> None:
    """Write ``facts.js`` and ``examples.js``; raises OutputError where one cannot be written."""
    write_text(folder / "facts.js", module(facts()))
    write_text(folder / "examples.js", module(examples()))
