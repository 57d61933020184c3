"""Read and write captures of sessions: every event that reached the instrument, with its frame.

docs/capture.md describes the format: one JSON value a line, so that a capture that was cut short
by a crash can be read.
"""

from __future__ import annotations

import contextlib
import io
import json
import platform
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import llvmlite
import numpy as np
from llvmlite import binding

from yehu_server import __version__
from yehu_server.engine.controls import SILENCE
from yehu_server.engine.mailbox import EVENT
from yehu_server.errors import OutputError, ParameterError, ScoreError
from yehu_server.files import create, discard, read_lines, why, write_all
from yehu_server.jit import source_hash
from yehu_server.params.table import ENGINE, SLOT
from yehu_server.physics.grid import check_rate

FORMAT, VERSION = "yehu-server capture", 1
MOST_BYTES = 1 << 30
ROOM_BYTES = 1 << 16  # free space needed to begin a capture
MOST_EVENTS = 20_000_000  # each takes 32 bytes
MOST_RESTS = 1000
MOST_FRAMES = 1 << 53
CHUNK = 1 << 16  # events
SILENCED = "silence"
ADDRESSES = {slot: address for address, slot in SLOT.items()} | {SILENCE: SILENCED}
INDICES = {address: slot for slot, address in ADDRESSES.items()}


def build() -> dict[str, str]:
    """Versions and machine on which the samples depend: the same build gives the same bits."""
    return {
        "yehu-server": __version__,
        "sources": source_hash(),
        "numpy": np.__version__,
        "llvm": llvmlite.__version__,
        "machine": platform.machine(),
        "processor": str(binding.get_host_cpu_name()),
    }


class CaptureWriter:
    """Writes a capture; each line of the file is complete, however writing ends.

    Parameters
    ----------
    overwrite : bool
        Whether to replace an older file.

    Raises
    ------
    OutputError
        Where it cannot be written.
    """

    def __init__(
        self,
        target: Path,
        *,
        rate: float,
        seed: int,
        tensions: Sequence[float],
        overwrite: bool = False,
    ) -> None:
        self._target = target
        self._file = create(target, overwrite=overwrite, room_bytes=ROOM_BYTES)
        self._whole_bytes = 0
        values = {param.address: param.default for param in ENGINE}
        header: dict[str, Any] = {"format": FORMAT, "version": VERSION, "rate": rate, "seed": seed}
        header["tensions"] = list(tensions)
        self._write([{**header, "build": build(), "values": values}])

    def events(self, events: Any) -> None:
        """Add events [shape=(events,), dtype=EVENT] that were applied."""
        self._write(
            [int(e["frame"]), ADDRESSES[int(e["index"])], float(e["target"]), int(e["ramp"])]
            for e in events
        )

    def note(self, what: str, frame: int, **details: int) -> None:
        """Add a ``rest`` (after a gap `since` a frame), or ``lost`` `events`."""
        self._write([{what: frame, **details}])

    def close(self, frame: int) -> None:
        """End the capture at the frame after the last one played."""
        self._write([{"end": frame}])
        self._file.close()

    def discard(self) -> None:
        """End the capture and remove its file."""
        discard(self._file, self._target)
        self._file.close()

    def _write(self, lines: Iterable[Any]) -> None:
        data = "".join(json.dumps(line) + "\n" for line in lines).encode()
        try:
            write_all(self._file, data)
            self._whole_bytes += len(data)
        except OSError as error:
            with contextlib.suppress(OSError):  # remove an incomplete line
                written = self._file.seek(0, io.SEEK_END) - self._whole_bytes
                self._file.truncate(self._whole_bytes + data.rfind(b"\n", 0, written) + 1)
            self._file.close()
            raise OutputError(f"{self._target}: cannot write: {why(error)}") from error


@dataclass
class Capture:
    """A captured session."""

    rate: float
    tensions: tuple[float, float]  # N, of the strings as tuned
    build: dict[str, str]
    events: Any = field(default_factory=lambda: np.zeros(0, EVENT))  # by frame
    rests: dict[int, int] = field(
        default_factory=dict
    )  # frame of each rest, and since when it was silent
    end: int | None = None  # number of frames
    lost: int = 0  # events that were not captured
    warnings: list[str] = field(default_factory=list)

    @property
    def frames(self) -> int:
        """Number of frames; where the end is missing, until a second after the last event."""
        last = int(self.events["frame"][-1]) + 1 if len(self.events) else 0
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
        events: list[tuple[int, int, float, int]] = []
        for number, line in enumerate(lines, start=2):
            try:
                if line.strip():
                    _take(json.loads(line), capture, events)
            except _WRONG as error:
                if not line.endswith("\n"):  # cut short by a crash
                    break
                raise ScoreError(
                    f"{path}: line {number}: not a line of a capture ({error})"
                ) from error
            if len(events) == CHUNK:
                chunks.append(np.array(events, EVENT))
                events.clear()
                if len(chunks) * CHUNK >= MOST_EVENTS:
                    raise ScoreError(f"{path}: has more than {MOST_EVENTS} events")
    except OSError as error:
        raise ScoreError(f"{path}: {error.strerror}") from error
    except ValueError as error:  # no UTF-8, or a NUL in the name
        raise ScoreError(f"{path}: not a capture ({error})") from error
    capture.events = np.concatenate([*chunks, np.array(events, EVENT)])
    if np.any(np.diff(capture.events["frame"]) < 0):
        raise ScoreError(f"{path}: events are not in order of frames")
    _warn(capture)
    return capture


_WRONG = (ValueError, TypeError, KeyError, OverflowError, RecursionError)


def _header(path: Path, line: str) -> Capture:
    try:
        header = json.loads(line)
        if header["format"] != FORMAT:
            raise ScoreError(f"{path}: not a capture")
        if header["version"] != VERSION:
            raise ScoreError(f"{path}: version {header['version']!r} of the format is not known")
        if dict(header["values"]) != {param.address: param.default for param in ENGINE}:
            raise ScoreError(f"{path}: begins with other values than this version has")
        first, second = map(float, header["tensions"])
        rate = float(header["rate"])
        check_rate(rate)
        return Capture(rate, (first, second), dict(header["build"]))
    except ParameterError as error:
        raise ScoreError(f"{path}: {error}") from error
    except _WRONG as error:
        raise ScoreError(f"{path}: not a capture") from error


def _take(entry: Any, capture: Capture, events: list[tuple[int, int, float, int]]) -> None:
    if isinstance(entry, list):
        frame, address, target, ramp = entry
        index = INDICES[address]
        events.append((_frames(frame), index, _target(index, target), _frames(ramp)))
    elif "end" in entry:
        capture.end = _frames(entry["end"])
    elif "rest" in entry:
        rest, since = _frames(entry["rest"]), _frames(entry["since"])
        capture.rests[rest] = since
        if since > rest or len(capture.rests) > MOST_RESTS:
            raise ValueError("a rest before its beginning, or too many of them")
    elif "lost" in entry:
        capture.lost += _frames(entry["events"])


def _frames(value: Any) -> int:
    """A number of frames, or another count; raises ValueError."""
    if type(value) is not int or not 0 <= value <= MOST_FRAMES:
        raise ValueError("expected a whole number of frames")
    return value


def _target(index: int, value: Any) -> float:
    """The target of a parameter within its range; raises ValueError or TypeError."""
    target = float(value)
    lo, hi = (0.0, 0.0) if index == SILENCE else (ENGINE[index].lo, ENGINE[index].hi)
    if not lo <= target <= hi:  # also refuses NaN
        raise ValueError(f"{target} is not within {lo:g} to {hi:g}")
    return target


def _warn(capture: Capture) -> None:
    if capture.end is None:
        capture.warnings.append("the session did not end properly; a second is added")
    if capture.lost:
        capture.warnings.append(f"{capture.lost} events were not captured: the sound differs")
    differing = [name for name, value in build().items() if capture.build.get(name) != value]
    if differing:
        names = ", ".join(differing)
        capture.warnings.append(f"captured by another build ({names}): the sound may differ")
