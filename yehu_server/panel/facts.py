"""Collects the facts that the page shares with the server, so that no table is written twice."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from yehu_server.ahead.build import RATES
from yehu_server.ahead.layout import look_layout, look_length
from yehu_server.ahead.sources import sources_hash
from yehu_server.files import write_text
from yehu_server.panel.constants import constants
from yehu_server.panel.examples import examples
from yehu_server.panel.parameters import kinds, parameters
from yehu_server.panel.styles import mappings, presets, tunings
from yehu_server.playing.mapping import DEFAULT, MPE

HEAD = "// Written by `python -m yehu_server.panel`; changes are lost.\n"


def facts() -> dict[str, Any]:
    """All facts, of JSON's types; the same for the same sources."""
    return {
        "kinds": kinds(),
        "parameters": parameters(),
        **constants(),
        "mappings": mappings(),
        "defaultMapping": DEFAULT,
        "mpeMapping": MPE,
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
