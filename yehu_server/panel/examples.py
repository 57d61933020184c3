"""The example scores as events, for the page to play."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from yehu_server.files import shipped_folder
from yehu_server.playing.mapping import DEFAULT, MPE
from yehu_server.score.smf import read_score

# The mappings that they were written for, as the README plays them.
MAPPING = {
    "bow_pressure": "keyboard-expressive",
    "mpe_phrase": MPE,
    "slow_air": "keyboard-expressive",
}


def examples() -> dict[str, Any]:
    """Each example by its name."""
    files = sorted(shipped_folder("examples").glob("*.mid"))
    return {file.stem: example(file) for file in files}


def example(file: Path) -> dict[str, Any]:
    """An example: its mapping, its length, and its events: [seconds, bytes]."""
    score = read_score(file)
    return {
        "name": score.name,
        "mapping": MAPPING.get(score.name, DEFAULT),
        "seconds": score.duration_s,
        "events": [[round(event.time_s, 6), event.message.bytes()] for event in score.events],
    }
