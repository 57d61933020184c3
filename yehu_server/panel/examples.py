"""The example scores as events, for the page to play."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from yehu_server.files import shipped_folder
from yehu_server.playing.mapping import DEFAULT, MPE
from yehu_server.score.score import ScoreEvent
from yehu_server.score.smf.reader import read_score

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
    """An example: its mapping, its length, and its events: [seconds, bytes].

    Of several players the first plays: a page has one instrument.
    """
    score = read_score(file)
    mapping = MAPPING.get(score.name, DEFAULT)
    events = score.events if mapping == MPE else _of_first_player(score.events)
    return {
        "name": score.name,
        "mapping": mapping,
        "seconds": score.duration_s,
        "events": [[round(event.time_s, 6), event.message.bytes()] for event in events],
    }


def _of_first_player(events: Sequence[ScoreEvent]) -> list[ScoreEvent]:
    """The events of the first channel that has notes."""
    first = min(event.message.channel for event in events if event.message.type == "note_on")
    return [event for event in events if getattr(event.message, "channel", first) == first]
