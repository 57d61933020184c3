"""The example scores as events, and what a page's performances begin with."""

import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from yehu_server.ahead.build import RATES
from yehu_server.core.player.note_range import LOWEST_NOTE
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import DEFAULT, MPE
from yehu_server.playing.options import PlayingOptions
from yehu_server.scores.capture_header import SessionStart, header_of
from yehu_server.scores.events import ScoreEvent, Setting
from yehu_server.scores.reading import ReadOptions, is_written, read_any
from yehu_server.util.files import shipped_folder, write_text

LEVEL = {"level": "wasm32"}


def write_capture_headers(folder: Path) -> list[Path]:
    """Write a file for each rate, as `48000.json`; return them. Raises OutputError."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for rate in RATES:
        spec = PlayingOptions().spec(rate, calibration_for(rate))
        header = header_of(SessionStart((spec,), has_room=True))
        header["build"] |= LEVEL
        written.append(folder / f"{rate:.0f}.json")
        write_text(written[-1], json.dumps(header, separators=(",", ":")))
    return written


# The mappings that they were written for, as the README plays them.
MAPPING = {
    "bow_pressure": "keyboard-expressive",
    "mpe_phrase": MPE,
    "slow_air": "keyboard-expressive",
}
EASY = ("twinkle", "frere_jacques", "au_clair_de_la_lune")
# As one learns them; the others follow.
ORDER = (
    *EASY,
    "ode_to_joy",
    "song_bie",
    "amazing_grace",
    "auld_lang_syne",
    "silent_night",
    "arirang",
)
KEYS = {"mo_li_hua": "Bb"}  # of MIDI files that are not in F
_KEY = re.compile(r"^1=([A-G][#b]?)", re.MULTILINE)
_STEPS = {"C": 0, "D": 2, "E": 4, "F": 5, "G": 7, "A": 9, "B": 11, "#": 1, "b": -1}


def examples() -> dict[str, Any]:
    """Each example by its name: tunes, the easiest first, and then studies."""
    folder = shipped_folder("examples")
    found = [example(file) for file in (*folder.glob("*.mid"), *folder.glob("tunes/*.jianpu"))]
    return {one["name"]: one for one in sorted(found, key=_place)}


def _place(found: dict[str, Any]) -> tuple[bool, int, str]:
    name = found["name"]
    return name in MAPPING, ORDER.index(name) if name in ORDER else len(ORDER), name


def example(file: Path) -> dict[str, Any]:
    """The first player's part: its mapping, length, where do is, and events: [seconds, bytes]."""
    mapping = MAPPING.get(file.stem, DEFAULT)
    score = read_any(file, ReadOptions(is_mpe=mapping == MPE))
    events = score.events if mapping == MPE else _of_first_player(score.events)
    return {
        "name": score.name,
        "mapping": mapping,
        "isEasy": score.name in EASY,
        "seconds": score.duration_s,
        "tonic": _tonic(_key(file)),
        "events": [
            [round(event.time_s, 6), event.message.bytes()]
            for event in events
            if not isinstance(event.message, Setting)
        ],
    }


def _key(file: Path) -> str:
    """The name of do."""
    found = _KEY.search(file.read_text("utf-8")) if is_written(file) else None
    return found[1] if found else KEYS.get(file.stem, "F")


def _tonic(key: str) -> int:
    """The lowest do that the instrument has (MIDI)."""
    step = sum(_STEPS[letter] for letter in key)
    return LOWEST_NOTE + (step - LOWEST_NOTE) % 12


def _of_first_player(events: Sequence[ScoreEvent]) -> list[ScoreEvent]:
    """The events of the first channel that has notes."""
    first = min(event.message.channel for event in events if event.message.type == "note_on")
    return [event for event in events if getattr(event.message, "channel", first) == first]
