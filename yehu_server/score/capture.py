"""Read captures of sessions; docs/capture.md describes the format.

Version 1 held what moved bow and fingers, not what was wished of the player.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.engine.instrument import Instrument
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.files import read_lines
from yehu_server.params.table import find
from yehu_server.physics.grid import check_rate
from yehu_server.physics.layout import STRINGS
from yehu_server.physics.quantities import Quantities, override
from yehu_server.player.bowing import ordinary_table
from yehu_server.player.calibration import Calibration
from yehu_server.player.fingering import OpenStrings
from yehu_server.player.wishes import WISH
from yehu_server.playing.calibrations import read_calibration
from yehu_server.score.capture_format import (
    FORMAT,
    VERSION,
    Fields,
    build,
    frames_of,
    from_line,
    ramp_of,
)

MOST_BYTES = 1 << 30
MOST_WISHES = 20_000_000  # each takes 40 bytes
MOST_RESTS = 1000
LOWEST_A4, HIGHEST_A4 = 1.0, 20000.0  # Hz
CHUNK = 1 << 16  # wishes


@dataclass(frozen=True)
class Beginning:
    """All that a session starts from."""

    rate: float
    tensions: tuple[float, float]  # N, of the strings as tuned
    seed: int = 0
    open_strings: OpenStrings = OpenStrings.ALWAYS
    calibration: Calibration | None = None
    bowing: Any = field(default_factory=ordinary_table)
    values: Mapping[str, float] = field(default_factory=dict)  # of parameters; others: default

    def instrument(self) -> Instrument:
        """An instrument that starts so."""
        first, second = self.tensions
        changes = {"string_1": {"T": first}, "string_2": {"T": second}}
        return Instrument(
            self.rate,
            override(Quantities(), changes),
            calibration=self.calibration,
            bowing=self.bowing,
            open_strings=self.open_strings,
            seed=self.seed,
            start_values=self.values,
        )


@dataclass
class Capture:
    """A captured session."""

    beginning: Beginning
    build: dict[str, str]
    version: int = VERSION
    wishes: Any = field(default_factory=lambda: np.zeros(0, WISH))  # by frame
    rests: dict[int, int] = field(
        default_factory=dict
    )  # frame of each rest, and since when it was silent
    end: int | None = None  # number of frames
    lost: int = 0  # wishes that were not captured
    warnings: list[str] = field(default_factory=list)

    @property
    def rate(self) -> float:
        """Sample rate (Hz)."""
        return self.beginning.rate

    @property
    def frames(self) -> int:
        """Number of frames; where the end is missing, until a second after the last wish."""
        last = int(self.wishes["frame"][-1]) + 1 if len(self.wishes) else 0
        last = max([last, *self.rests])
        return max(last, last + round(self.rate) if self.end is None else self.end)


def read_capture(path: Path) -> Capture:
    """Read a capture, also one that a crash has cut short.

    Raises
    ------
    ScoreError
        Where it cannot be read or is no capture.
    """
    lines = read_lines(path, MOST_BYTES)
    try:
        capture = _header(path, next(lines, ""))
        chunks: list[Any] = []
        wishes: list[Fields] = []
        for number, line in enumerate(lines, start=2):
            try:
                if line.strip():
                    _take(json.loads(line), capture, wishes)
            except _WRONG as error:
                if not line.endswith("\n"):  # cut short by a crash
                    break
                raise ScoreError(
                    f"{path}: line {number}: not a line of a capture ({error})"
                ) from error
            if len(wishes) == CHUNK:
                chunks.append(np.array(wishes, WISH))
                wishes.clear()
                if len(chunks) * CHUNK >= MOST_WISHES:
                    raise ScoreError(f"{path}: has more than {MOST_WISHES} events")
    except OSError as error:
        raise ScoreError(f"{path}: {error.strerror}") from error
    except ValueError as error:  # no UTF-8, or a NUL in the name
        raise ScoreError(f"{path}: not a capture ({error})") from error
    capture.wishes = np.concatenate([*chunks, np.array(wishes, WISH)])
    if np.any(np.diff(capture.wishes["frame"]) < 0):
        raise ScoreError(f"{path}: events are not in order of frames")
    _warn(capture)
    return capture


_WRONG = (
    ValueError, TypeError, KeyError, IndexError, AttributeError, OverflowError, RecursionError,
)  # fmt: skip


def _header(path: Path, line: str) -> Capture:
    try:
        header = json.loads(line)
        if header["format"] != FORMAT:
            raise ScoreError(f"{path}: not a capture")
        version = header["version"]
        if version not in (1, VERSION) or type(version) is not int:
            raise ScoreError(f"{path}: version {version!r} of the format is not known")
        rate = float(header["rate"])
        check_rate(rate)
        first, second = map(float, header["tensions"])
        beginning = Beginning(rate, (first, second), values=_values(header["values"]))
        if version == VERSION:
            beginning = _players(beginning, header)
        return Capture(beginning, dict(header["build"]), version)
    except ParameterError as error:
        raise ScoreError(f"{path}: {error}") from error
    except _WRONG as error:
        raise ScoreError(f"{path}: not a capture") from error


def _values(values: Mapping[str, float]) -> dict[str, float]:
    """Values of parameters, by address; raises ParameterError where one is unknown or outside."""
    for address, value in values.items():
        param = find(address)
        if param.accept(value) != value:
            raise ParameterError(f"{address}: {value} is not within {param.range_text}")
    return dict(values)


def _players(beginning: Beginning, header: Any) -> Beginning:
    """The same with what the player starts from; raises as a JSON value of another form does."""
    bowing = np.array(header["bowing"], np.float64)
    if bowing.ndim == 3:  # of captures made when both strings were bowed by one table
        bowing = np.stack([bowing] * STRINGS)
    if bowing.shape != ordinary_table().shape or not np.all(np.isfinite(bowing)):
        raise ValueError("bowing")
    data = header["calibration"]
    calibration = None
    if data is not None:
        a4 = float(data["a4"])
        if not LOWEST_A4 <= a4 <= HIGHEST_A4:
            raise ValueError("a4")
        calibration = read_calibration(data, Quantities(), a4)
    return replace(
        beginning,
        seed=frames_of(header["seed"]),
        open_strings=OpenStrings(header["open_strings"]),
        calibration=calibration,
        bowing=bowing,
    )


def _take(entry: Any, capture: Capture, wishes: list[Fields]) -> None:
    if isinstance(entry, list) and capture.version == 1:
        frame, *ramp = entry
        wishes.append((frames_of(frame), *ramp_of(*ramp)))
    elif isinstance(entry, list):
        wishes.append(from_line(entry))
    elif "end" in entry:
        capture.end = frames_of(entry["end"])
    elif "rest" in entry:
        rest, since = frames_of(entry["rest"]), frames_of(entry["since"])
        capture.rests[rest] = since
        if since > rest or len(capture.rests) > MOST_RESTS:
            raise ValueError("a rest before its beginning, or too many of them")
    elif "lost" in entry:
        capture.lost += frames_of(entry["events"])


def _warn(capture: Capture) -> None:
    if capture.end is None:
        capture.warnings.append("the session did not end properly; a second is added")
    if capture.lost:
        capture.warnings.append(f"{capture.lost} events were not captured: the sound differs")
    differing = [name for name, value in build().items() if capture.build.get(name) != value]
    if differing:
        names = ", ".join(differing)
        capture.warnings.append(f"captured by another build ({names}): the sound may differ")
