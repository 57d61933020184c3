"""Writes what a page's performances begin with: the first line of a capture, for each rate."""

from __future__ import annotations

import json
from pathlib import Path

from yehu_server.ahead.build import RATES
from yehu_server.files import write_text
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.style import Style
from yehu_server.score.capture_beginning import Beginning, header_of

PROCESSOR = {"machine": "wasm32", "processor": "any"}


def write_beginnings(folder: Path) -> list[Path]:
    """Write a file for each rate, as `48000.json`; return them.

    Raises
    ------
    OutputError
        Where one cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    return [_write(folder / f"{rate:.0f}.json", rate) for rate in RATES]


def _write(path: Path, rate: float) -> Path:
    spec = Style().spec(rate, calibration_for(rate))
    header = header_of(Beginning((spec,), has_room=True))
    header["build"] |= PROCESSOR
    write_text(path, json.dumps(header, separators=(",", ":")))
    return path
