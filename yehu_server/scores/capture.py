"""Read captures of sessions; docs/capture.md describes the format.

Version 1 held what moved bow and fingers, not what the player was asked for. Versions 1 and 2 have
one player.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.core.player.commands import COMMAND
from yehu_server.errors import ScoreError
from yehu_server.scores.capture_format import (
    FORMAT,
    MAX_FRAMES,
    VERSION,
    WRONG,
    CommandRow,
    build,
    from_line,
    ramp_of,
)
from yehu_server.scores.capture_header import SessionStart, read_header
from yehu_server.util.documents import Document, Fields
from yehu_server.util.files import error_reason, read_lines
from yehu_server.util.values import whole

MAX_BYTES = 1 << 30
MAX_COMMANDS = 20_000_000  # each takes 48 bytes
MAX_RESTS = 1000
ROW = np.dtype([("command", COMMAND), ("player", np.int64)])


@dataclass
class Capture:
    """A captured session."""

    beginning: SessionStart
    build: dict[str, str]
    version: int = VERSION
    commands: Any = field(default_factory=lambda: np.zeros(0, COMMAND))  # by frame
    players: Any = field(default_factory=lambda: np.zeros(0, np.int64))  # of each command, from 0
    gaps: dict[int, int] = field(default_factory=dict)  # frame of each rest: since when silent
    end: int | None = None  # number of frames
    lost: int = 0  # commands that were not captured
    warnings: list[str] = field(default_factory=list)

    @property
    def rate(self) -> float:
        """Sample rate (Hz)."""
        return self.beginning.rate

    @property
    def frames(self) -> int:
        """Number of frames; where the end is missing, until a second after the last command."""
        last = int(self.commands["frame"][-1]) + 1 if len(self.commands) else 0
        last = max([last, *self.gaps])
        return max(last, last + round(self.rate) if self.end is None else self.end)


def read_capture(path: Path) -> Capture:
    """Read a capture, also one that a crash has cut short. Raises ScoreError where it is none."""
    lines = read_lines(path, MAX_BYTES)
    try:
        capture = _header(path, next(lines, ""))
        rows = np.fromiter(_rows(path, lines, capture), ROW)
    except OSError as error:
        raise ScoreError(f"{path}: {error_reason(error)}") from error
    except ValueError as error:  # no UTF-8, or a NUL in the name
        why = "a capture is text, .jsonl" if isinstance(error, UnicodeDecodeError) else error
        raise ScoreError(f"{path}: not a capture ({why})") from error
    for player in range(len(capture.beginning.players)):
        if np.any(np.diff(rows["command"]["frame"][rows["player"] == player]) < 0):
            raise ScoreError(f"{path}: events are not in order of frames")
    rows = rows[np.argsort(rows["command"]["frame"], kind="stable")]
    capture.commands, capture.players = rows["command"].copy(), rows["player"].copy()
    _warn(capture)
    return capture


def _rows(path: Path, lines: Iterator[str], capture: Capture) -> Iterator[tuple[CommandRow, int]]:
    """The commands of all lines, with their players; other entries go into the capture."""
    count = 0
    for number, line in enumerate(lines, start=2):
        try:
            row = _row(json.loads(line), capture) if line.strip() else None
        except WRONG as error:
            if not line.endswith("\n"):  # cut short by a crash
                return
            raise ScoreError(f"{path}: line {number}: not a line of a capture ({error})") from error
        if row is not None:
            yield row
            count += 1
            if count > MAX_COMMANDS:
                raise ScoreError(f"{path}: has more than {MAX_COMMANDS} events")


def _header(path: Path, line: str) -> Capture:
    table = Document(path, "a capture", ScoreError, text=line).json()
    if table.data.get("format") != FORMAT:
        raise ScoreError(f"{path}: not a capture")
    version = table.data.get("version")
    if version not in range(1, VERSION + 1) or type(version) is not int:
        raise ScoreError(f"{path}: version {version!r} of the format is not known")
    with table.at():
        beginning = read_header(table, version)
        built = dict(table.need("build", Fields).data)
    return Capture(beginning, built, version)


def _row(entry: Any, capture: Capture) -> tuple[CommandRow, int] | None:
    if isinstance(entry, list):
        if capture.version == 1:
            frame, *ramp = entry
            return (whole(frame, 0, MAX_FRAMES), *ramp_of(*ramp)), 0
        if capture.version == 2:
            return from_line(entry), 0
        player = whole(entry[1], 1, len(capture.beginning.players))
        return from_line([entry[0], *entry[2:]]), player - 1
    if "end" in entry:
        capture.end = whole(entry["end"], 0, MAX_FRAMES)
    elif "rest" in entry:
        rest, since = (whole(entry[name], 0, MAX_FRAMES) for name in ("rest", "since"))
        capture.gaps[rest] = since
        if since > rest or len(capture.gaps) > MAX_RESTS:
            raise ValueError("a rest before its beginning, or too many of them")
    elif "lost" in entry:
        capture.lost += whole(entry["events"], 0, MAX_FRAMES)
    return None


def _warn(capture: Capture) -> None:
    if capture.end is None:
        capture.warnings.append("the session did not end properly; a second is added")
    if capture.lost:
        capture.warnings.append(f"{capture.lost} events were not captured: the sound differs")
    differing = [name for name, value in build().items() if capture.build.get(name) != value]
    if differing:
        names = ", ".join(differing)
        capture.warnings.append(f"captured by another build ({names}): the sound may differ")
