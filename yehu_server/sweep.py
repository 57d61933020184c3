"""Run one gesture with all combinations of some values, on all cores, to study the model.

docs/simulate.md describes the files.
"""

from __future__ import annotations

import copy
import itertools
import json
import math
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.analysis.pitch import pitch_hz
from yehu_server.errors import OutputError, ParameterError
from yehu_server.files import read_text, write_text
from yehu_server.score.gesture import CONTROLS, Gesture, gesture_from
from yehu_server.simulate import Simulation, simulate

MOST_RUNS = 100_000
INDEX = "index.json"
_RESULT = re.compile(r"[0-9]+\.npz")


@dataclass(frozen=True)
class Axis:
    """An entry of a gesture file that is varied, by its path, and its values."""

    path: tuple[str, ...]
    values: tuple[float, ...]

    @property
    def name(self) -> str:
        """The path as it is written on the command line."""
        return ".".join(self.path[1:] if self.path[0] == "controls" else self.path)

    def vary(self, data: Any, value: float) -> None:
        """Set the entry in the data of a gesture file, in place.

        A curve is scaled so that its largest point becomes the value.

        Raises
        ------
        ParameterError
            Where there is no such entry.
        """
        *tables, last = self.path
        for name in tables:
            data = data.setdefault(name, {}) if isinstance(data, dict) else None
        if not isinstance(data, dict):
            raise ParameterError(f"{self.name}: no such entry")
        present = data.get(last)
        data[last] = _scaled(present, value) if isinstance(present, list) else value


def axis_of(text: str) -> Axis:
    """Read ``NAME=V1,V2,...`` or ``NAME=FROM:TO:STEPS``.

    Raises
    ------
    ParameterError
        Where the text has another form.
    """
    name, equals, values = text.partition("=")
    path = tuple(name.strip().split("."))
    if not equals or not all(path):
        raise ParameterError(f"{text!r}: expected NAME=V1,V2,... or NAME=FROM:TO:STEPS")
    if path[0] in CONTROLS:
        path = ("controls", *path)
    try:
        if values.count(":") == 2:
            first, last, steps = values.split(":")
            spread = np.linspace(float(first), float(last), _steps(steps))
            return Axis(path, tuple(float(value) for value in spread))
        return Axis(path, tuple(float(value) for value in values.split(",")))
    except ValueError:
        raise ParameterError(f"{text!r}: expected numbers after {name}=") from None


def variations(
    source: Mapping[str, Any], axes: Sequence[Axis], folder: Path = Path()
) -> list[tuple[dict[str, float], Gesture]]:
    """All combinations of the axes' values, the last axis changing fastest.

    Parameters
    ----------
    source : mapping
        The data of a gesture file in `folder`.

    Returns
    -------
    list of tuple
        The values by name, and the gesture with them.

    Raises
    ------
    ParameterError
        Where there are more than MOST_RUNS, or a gesture is wrong.
    """
    count = math.prod(len(axis.values) for axis in axes)
    if count > MOST_RUNS:
        raise ParameterError(f"{count} runs are more than {MOST_RUNS}")
    found = []
    for values in itertools.product(*(axis.values for axis in axes)):
        data = copy.deepcopy(dict(source))
        for axis, value in zip(axes, values, strict=True):
            axis.vary(data, value)
        named = {axis.name: value for axis, value in zip(axes, values, strict=True)}
        found.append((named, gesture_from(data, folder)))
    return found


def sweep(
    runs: Sequence[tuple[dict[str, float], Gesture]],
    folder: Path,
    *,
    energy: bool = False,
    strings_every: int = 0,
    keep: bool = True,
    workers: int | None = None,
    overwrite: bool = False,
    progress: Callable[[float, float], None] | None = None,
) -> list[dict[str, Any]]:
    """Run gestures on several cores; write their arrays and an index to a folder.

    Where a run fails, or the sweep is interrupted, the finished runs are kept and indexed; the
    KeyboardInterrupt then has the number of them.

    Parameters
    ----------
    energy, strings_every
        As of `simulate`.
    keep : bool
        Whether to write the arrays, beside the index.
    workers : int
        Number of runs at a time; by default one per core.
    overwrite : bool
        Whether to remove the results of an earlier sweep from the folder.
    progress : callable
        Called with the number of runs done and of all runs.

    Returns
    -------
    list of dict
        The rows of the index: varied values, file, and findings.

    Raises
    ------
    OutputError
        Where the folder has other results, or writing fails.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error
    make_room(folder, overwrite=overwrite)
    width = len(str(len(runs) - 1))
    rows: dict[int, dict[str, Any]] = {}

    def run(number: int) -> dict[str, Any]:
        varied, gesture = runs[number]
        result = simulate(gesture, energy=energy, strings_every=strings_every)
        row: dict[str, Any] = {"varied": varied} | findings(result)
        if keep:
            row["file"] = f"{number:0{width}}.npz"
            result.save(folder / row["file"])
        rows[number] = row
        return row

    try:
        # The model runs without the GIL, so threads are enough.
        with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
            for done, _ in enumerate(_in_order(pool, run, len(runs)), start=1):
                if progress is not None:
                    progress(done, len(runs))
    except KeyboardInterrupt:
        kept = f"{len(rows)} of {len(runs)} runs are in {folder}" if rows else ""
        raise KeyboardInterrupt(kept) from None
    finally:
        index = [rows[number] for number in sorted(rows)]
        if index:
            write_text(folder / INDEX, json.dumps(index, indent=1) + "\n")
    return index


def make_room(folder: Path, *, overwrite: bool = False) -> None:
    """Remove the results of an earlier sweep from a folder: its index and the files in that.

    Raises
    ------
    OutputError
        Where there are results and `overwrite` is false, files like results that are in no
        index, as a killed sweep leaves them, or files that cannot be removed.
    """
    index = folder / INDEX
    try:
        files = [folder / name for name in _indexed(index)]
        strays = sorted({*folder.glob("*.npz")} - {*files})
        strays = [file for file in strays if _RESULT.fullmatch(file.name)]
        if strays:
            raise OutputError(f"{strays[0]}: is in no index of a sweep; remove it")
        if not index.exists():
            return
        if not overwrite:
            raise OutputError(f"{index}: there are results of another sweep; --overwrite them")
        for file in (*files, index):
            file.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error


def _indexed(index: Path) -> list[str]:
    """Names of the files in an index."""
    try:
        rows = json.loads(read_text(index))
    except FileNotFoundError:
        return []
    except (ValueError, RecursionError):
        raise OutputError(f"{index}: is not the index of a sweep; remove it") from None
    names = [row.get("file") for row in rows if isinstance(row, dict)]
    return [name for name in names if isinstance(name, str) and _RESULT.fullmatch(name)]


def findings(result: Simulation) -> dict[str, Any]:
    """Pitch and level of the second half of a run, and counts of numerical failures."""
    pressure = result.arrays["pressure"]
    half = pressure[len(pressure) // 2 :]
    swing = half - half.mean() if len(half) else half
    pitch = pitch_hz(swing, float(result.meta["sample_rate"]))
    return {
        "pitch_hz": pitch if math.isfinite(pitch) else None,
        "pressure_rms": float(np.sqrt(np.mean(np.square(swing)))) if len(swing) else 0.0,
        "unconverged_solves": result.meta["unconverged_solves"],
        "lost_states": result.meta["lost_states"],
    }


def _in_order(
    pool: ThreadPoolExecutor, run: Callable[[int], dict[str, Any]], count: int
) -> Iterator[dict[str, Any]]:
    try:
        yield from pool.map(run, range(count))
    except BaseException:  # an interrupt or a failed run: the others need not run
        pool.shutdown(cancel_futures=True)
        raise


def _steps(text: str) -> int:
    steps = int(text)
    if not 2 <= steps <= MOST_RUNS:
        raise ParameterError(f"{text} steps: 2 to {MOST_RUNS} are possible")
    return steps


def _scaled(curve: list[Any], value: float) -> list[Any]:
    try:
        largest = max((level for _, level in curve), key=abs)
        return [[time, level * value / largest] for time, level in curve]
    except (TypeError, ValueError, ZeroDivisionError):
        raise ParameterError("a curve that is varied needs a point that is not 0") from None
