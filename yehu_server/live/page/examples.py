"""The example scores as events, and what a page's performances begin with."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from yehu_server.ahead.build import RATES
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import DEFAULT, MPE
from yehu_server.playing.options import PlayingOptions
from yehu_server.scores.capture_header import SessionStart, header_of
from yehu_server.scores.score import ScoreEvent
from yehu_server.scores.smf.reader import read_score
from yehu_server.util.files import shipped_folder, write_text

PROCESSOR = {"machine": "wasm32", "processor": "any"}


def write_capture_headers(folder: Path) -> list[Path]:
    """Write a file for each rate, as `48000.json`; return them.

    Raises
    ------
    OutputError
        Where one cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for rate in RATES:
        spec = PlayingOptions().spec(rate, calibration_for(rate))
        header = header_of(SessionStart((spec,), has_room=True))
        header["build"] |= PROCESSOR
        written.append(folder / f"{rate:.0f}.json")
        write_text(written[-1], json.dumps(header, separators=(",", ":")))
    return written


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
