"""Collects the facts that the page shares with the server, so that no table is written twice."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from yehu_server.ahead.build import RATES
from yehu_server.ahead.layout import interpreter_layout, look_layout, look_length
from yehu_server.ahead.sources import sources_hash
from yehu_server.analysis.pitch import NOTE_NAMES
from yehu_server.files import write_text
from yehu_server.midi import messages, tables
from yehu_server.panel.examples import examples
from yehu_server.panel.parameters import events, kinds, parameters
from yehu_server.panel.styles import mappings, presets, tunings
from yehu_server.player import fingering
from yehu_server.player.calibration import OPEN_NOTES
from yehu_server.playing import learner, sources, tuning
from yehu_server.playing.live import ELSEWHERE
from yehu_server.playing.mapping import DEFAULT
from yehu_server.playing.tables import CURVES, WORDS

HEAD = "// Written by `python -m yehu_server.panel`; changes are lost.\n"


def facts() -> dict[str, Any]:
    """All facts, of JSON's types; the same for the same sources."""
    return {
        "kinds": kinds(),
        "events": events(),
        "parameters": parameters(),
        "notes": {
            "NAMES": list(NOTE_NAMES),
            "OPEN": list(map(float, OPEN_NOTES)),
            "LOWEST_NOTE": fingering.LOWEST_NOTE,
            "HIGHEST_NOTE": fingering.HIGHEST_NOTE,
            "OPEN_WITHIN": fingering.OPEN_WITHIN,
            "KEYS": tuning.KEYS[-1] + 1,
            "ELSEWHERE": ELSEWHERE,
        },
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
            "DATA_ENTRY": messages.DATA_ENTRY,
            "NRPN": [messages.NRPN_COARSE, messages.NRPN_FINE],
            "RPN": [messages.RPN_COARSE, messages.RPN_FINE],
        },
        "codes": {**WORDS, "PAIR": tables.PAIR, "NRPN": tables.NRPN},
        "curves": {curve.value: code for curve, code in CURVES.items()},
        "learner": {"DISTANCE": learner.DISTANCE, "AT_REST": dict(learner.AT_REST)},
        "interpreter": interpreter_layout(),
        "mappings": mappings(),
        "defaultMapping": DEFAULT,
        "presets": presets(),
        "tunings": tunings(),
        "look": look_layout(),
        "lookLength": look_length(),
        "rates": list(RATES),
        "builtFrom": sources_hash(),
    }


def module(values: Mapping[str, Any]) -> str:
    """The text of a JavaScript module that exports values of JSON's types, a line for each."""
    lines = [
        f"  {json.dumps(name)}: {json.dumps(value, separators=(',', ':'), allow_nan=False)},\n"
        for name, value in values.items()
    ]
    return f"{HEAD}export default {{\n{''.join(lines)}}};\n"


def write(folder: Path) -> None:
    """Write ``facts.js`` and ``examples.js``.

    Raises
    ------
    OutputError
        Where one cannot be written.
    """
    write_text(folder / "facts.js", module(facts()))
    write_text(folder / "examples.js", module(examples()))
